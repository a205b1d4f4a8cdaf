/// Reads and writes whole files. A file is written completely or not at all.
#pragma once

#include <cstddef>
#include <functional>
#include <limits>
#include <string>
#include <string_view>

#include <waymark/formats/text/text_sink.hpp>

namespace waymark::formats {

/// What a text may be while it is read. A pipe or a device may never end.
struct TextLimits {
  /// of a file, pipe or device
  std::size_t most_bytes = std::numeric_limits<std::size_t>::max();
  std::string_view longest{};  ///< what is at most so long, for the message: "a drive.yaml"
  /// Called with every further MiB of a pipe or device, which begins and ends anywhere. @throws InputError if
  /// nothing in it is of the format
  std::function<void(std::string_view piece)> check{};
};

/// Returns the whole content of a file, pipe or device. A pipe, a device and a file of more
/// than 64 MiB must begin as text: without a zero byte in the first MiB, and with the end of a line
/// within 64 MiB.
/// @throws InputError "gnss.csv: cannot read: No such file or directory" and the like, also
/// for a folder, and if a signal that the program handles ends the wait for a pipe
[[nodiscard]] std::string read_text_file(const std::string& path, const TextLimits& limits = {});

/// Returns the check for texts of numbers. @throws InputError for a piece without any digit
[[nodiscard]] std::function<void(std::string_view)> require_digits(const std::string& path);

/// Writes `content` to the file `path`. A reader sees either the old file or the whole new one,
/// never a part.
///
/// A regular or new file is written beside its final place ("out.graph.partial-NUMBER", which cannot be foreseen)
/// and then renamed. It is made new, no link is followed, and it never has more permissions than the
/// final file. A symbolic link is followed, and an existing file keeps its permissions. There is no
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

/// Makes a file of unforeseeable name in a folder, writes to it and removes it.
/// @throws OutputError with the folder's name if that is not possible
void try_to_write_in(const std::string& folder);

/// Creates a folder and its parents. @throws OutputError
void make_folder(const std::string& folder);

}  // namespace waymark::formats
