/// Whole files in and out: read at once, written all or nothing.
#pragma once

#include <functional>
#include <string>
#include <string_view>

#include <waymark/formats/text/text_sink.hpp>

namespace waymark::formats {

/// The whole content of a file, pipe or device.
/// @throws InputError "gnss.csv: cannot read: No such file or directory" and the like, also for a folder.
[[nodiscard]] std::string read_text_file(const std::string& path);

/// Writes `content` as the file `path`, so that a reader sees the old file or the whole new one, never a
/// part.
///
/// A regular or new file is written under a name beside it ("out.graph.partial-PID-N") and renamed; a
/// symbolic link is followed, permissions of an existing file are kept. Content is not forced to the disk (no
/// fsync): the promise holds for a failing or killed program, not for a power cut. Devices and pipes are
/// written directly, "-" and
/// "/dev/stdout" to the standard output as it stands.
/// A file size limit gives an error only where the program ignores SIGXFSZ, a closed pipe only where it
/// ignores SIGPIPE; `waymark` ignores both.
/// @throws OutputError "out.graph: cannot write: No space left on device" and the like; nothing partial is
/// left.
void write_file_atomically(const std::string& path, std::string_view content);

/// The same for a text that `produce` gives piece by piece to the sink that it is called with. What it throws
/// leaves a regular file as it was; a pipe or device has the pieces that came before.
void write_file_atomically(const std::string& path, const std::function<void(const TextSink&)>& produce);

/// Makes a folder and those above it. @throws OutputError
void make_folder(const std::string& folder);

}  // namespace waymark::formats
