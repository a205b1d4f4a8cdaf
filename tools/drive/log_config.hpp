/// The part of a drive.yaml that says how one log is read (see config.hpp).
#pragma once

#include <string>

#include <waymark/tools/drive/config.hpp>
#include <waymark/tools/drive/yaml_section.hpp>

namespace waymark {

/// Reads file, format, separator, columns, time and accuracy of a stream's section.
/// @param folder       where relative names are looked up
/// @param drive_scale  scale of a log that does not state its own
[[nodiscard]] LogConfig read_log_config(const YamlSection& section, StreamKind stream,
                                        const std::string& folder, TimeScale drive_scale);

}  // namespace waymark
