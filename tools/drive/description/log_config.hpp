/// The part of a drive.yaml that says how one log is read (see drive_description.hpp).
#pragma once

#include <array>
#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

#include <waymark/tools/drive/description/drive_description.hpp>
#include <waymark/tools/drive/description/yaml_section.hpp>

namespace waymark::drive {

/// The words for a time scale, in a drive and in a log.
inline constexpr std::array<std::string_view, 3> kTimeScaleWords{"gps", "utc", "unix"};

/// The keys that say how a log is read, and a section's own.
[[nodiscard]] std::vector<std::string_view> log_keys(std::initializer_list<std::string_view> own = {});

/// Reads file, format, separator, columns, time, accuracy and companions of a stream's section.
/// @param request      what is known of it: stream, channels, source
/// @param folder       where relative names are looked up
/// @param drive_scale  scale of a log that does not state its own
[[nodiscard]] LogConfig read_log_config(const YamlSection& section, LogRequest request,
                                        const std::string& folder, TimeScale drive_scale);

}  // namespace waymark::drive
