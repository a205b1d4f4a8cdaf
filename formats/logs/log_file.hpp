/// Logs as files. They are read piece by piece, may be compressed, and are recognised by
/// their content.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>

#include <waymark/core/drive/log_reader.hpp>

namespace waymark::formats {

/// Called while a file is read. @param done, size bytes of the file on the disk; size 0: not known
using ReadProgress = std::function<void(std::uint64_t done, std::uint64_t size)>;

/// Gives the content of a file in pieces of at most 1 MiB. The content of a file that gzip, xz or
/// zstd compressed (recognised by its first bytes, not by its name) is uncompressed. Memory does not grow with the file.
/// @return the error that stopped the reading of a compressed file that is cut or damaged; empty if
/// all of it was read
/// @throws InputError "gnss.log: cannot read: No such file or directory" and the like
[[nodiscard]] std::string read_in_pieces(const std::string& path,
                                         const std::function<void(std::string_view)>& take,
                                         const ReadProgress& progress = {});

/// Reads a file that belongs to a log as a whole. @throws InputError if it cannot be read or is damaged
[[nodiscard]] CompanionFile read_companion(const std::string& path);

/// Reads a log file with a reader. If a compressed file is cut or damaged, the content before the
/// error is used, and a corrupt record states the error.
/// @param seen called with every piece of the uncompressed content before it is decoded, for
/// a fingerprint
/// @throws InputError from the reader, and if nothing in the log was usable
[[nodiscard]] LogData read_log_file(const LogReader& reader, const std::string& path,
                                    const LogRequest& request, const ReadProgress& progress = {},
                                    const std::function<void(std::string_view)>& seen = {});

/// Returns the first 64 KiB of a log, uncompressed. @throws InputError if it cannot be read or is empty
[[nodiscard]] std::string read_head(const std::string& path);

/// A reader that recognises a log.
struct Recognised {
  LogReaderType reader;
  Recognition why;
};

/// Returns the reader with the highest confidence for the first 64 KiB of a log.
/// @throws InputError if the file cannot be read or is empty, if no reader recognises it (for a
/// known foreign format the message names the program that converts it), and if two readers have
/// the same confidence
[[nodiscard]] Recognised recognise_log(const std::string& path, std::span<const LogReaderType> readers);

}  // namespace waymark::formats
