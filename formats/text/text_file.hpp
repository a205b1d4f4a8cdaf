/// Reads and writes whole files. A file is written completely or not at all.
#pragma once

#include <functional>
#include <string>
#include <string_view>

#include <waymark/formats/text/text_sink.hpp>

namespace waymark::formats {

/// Returns the whole content of a file, pipe or device.
/// @throws InputError "gnss.csv: cannot read: No such file or directory" and the like, also
/// for a folder.
[[nodiscard]] std::string read_text_file(const std::string& path);

/// Writes `content` to the file `path`. A reader sees either the old file or the whole new one,
/// never a part.
///
/// A regular or new file is written beside its final place ("out.graph.partial-PID-N") and then
/// renamed. A symbolic link is followed, and an existing file keeps its permissions. There is no
/// fsync: the promise holds if the program fails or is killed, but not for a power cut. Devices and
/// pipes are written directly; "-" and "/dev/stdout" mean the standard output. A file size limit
/// gives an error only if the program ignores SIGXFSZ, and a closed pipe only if it ignores
/// SIGPIPE. `waymark` ignores both.
/// @throws OutputError "out.graph: cannot write: No space left on device" and the like; no partial
/// file remains
void write_file_atomically(const std::string& path, std::string_view content);

/// Writes the text that `produce` gives piece by piece to its sink. If `produce` throws, a regular
/// file stays as it was, but a pipe or device already has the earlier pieces.
void write_file_atomically(const std::string& path, const std::function<void(const TextSink&)>& produce);

/// Creates a folder and its parents. @throws OutputError
void make_folder(const std::string& folder);

}  // namespace waymark::formats
