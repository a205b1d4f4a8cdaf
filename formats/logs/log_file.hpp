/// Logs as files: read piece by piece, compressed ones too, and known by their content.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>

#include <waymark/core/drive/log_reader.hpp>

namespace waymark::formats {

/// Called while a file is read. @param done, size  bytes of the file as it lies on the disk; size 0: not
/// known
using ReadProgress = std::function<void(std::uint64_t done, std::uint64_t size)>;

/// Gives a file's content in pieces of at most 1 MiB; that of a .gz file (known by its first bytes, not by
/// its name) uncompressed. Memory does not grow with the file.
/// @return what broke off the reading of a compressed file that is cut or damaged; empty where all of it was
/// read
/// @throws InputError "gnss.log: cannot read: No such file or directory" and the like
[[nodiscard]] std::string read_in_pieces(const std::string& path,
                                         const std::function<void(std::string_view)>& take,
                                         const ReadProgress& progress = {});

/// A log file through a reader.
/// A compressed file that is cut or damaged gives what came before, with a corrupt record that says so.
/// @throws InputError what the reader throws, and where nothing in the log was usable
[[nodiscard]] LogData read_log_file(const LogReader& reader, const std::string& path,
                                    const LogRequest& request, const ReadProgress& progress = {});

/// A reader that knows a log for its own.
struct Recognised {
  LogReaderType reader;
  Recognition why;
};

/// The reader that is surest of a log, from its first 64 KiB.
/// @throws InputError for a file that cannot be read or is empty, for one that no reader knows (a known
/// foreign format is named with the program that converts it), and where two readers are equally sure
[[nodiscard]] Recognised recognise_log(const std::string& path, std::span<const LogReaderType> readers);

}  // namespace waymark::formats
