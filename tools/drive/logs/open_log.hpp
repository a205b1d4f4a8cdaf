/// Opens a log for a decoder that is fed piece by piece.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include <waymark/core/drive/log_reader.hpp>
#include <waymark/core/registry/registry.hpp>
#include <waymark/tools/drive/description/drive_description.hpp>
#include <waymark/tools/drive/logs/prepare.hpp>

namespace waymark::drive {

/// The reader of a log and everything that it needs.
struct ChosenReader {
  LogReaderType type;
  LogRequest request;             ///< with the text of companion files
  std::vector<InputFile> inputs;  ///< the companions that the description names
  std::vector<std::string> notes;
};

/// Chooses the reader that a log states. For `format: auto` the log itself is looked at: it must be a file.
/// @throws InputError for an unknown format, an unreadable file, and content that no reader recognises
[[nodiscard]] ChosenReader choose_reader(const LogConfig& log, const TypeRegistry& registry);

}  // namespace waymark::drive
