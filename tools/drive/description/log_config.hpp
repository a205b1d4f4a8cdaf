/// The part of a drive.yaml that defines how one log is read (see drive_description.hpp).
#pragma once

#include <array>
#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

#include <waymark/tools/drive/description/drive_description.hpp>
#include <waymark/tools/drive/description/yaml_section.hpp>

namespace waymark::drive {

/// The words for a time scale, for drives and logs.
inline constexpr std::array<std::string_view, 3> kTimeScaleWords{"gps", "utc", "unix"};

/// Tells whether a log is an address of a live source ("gpsd://localhost", "-"), not a file of a folder.
[[nodiscard]] bool is_address(const std::string& file);

/// Returns the keys that define how a log is read, and those of the section.
[[nodiscard]] std::vector<std::string_view> log_keys(std::initializer_list<std::string_view> own = {});

/// Reads file, format, separator, columns, time, accuracy and companions from the section
/// of a stream.
/// @param request known members: stream, channels, source, metric_frame
/// @param folder the folder for relative names
/// @param drive_scale scale of a log that does not state its own
[[nodiscard]] LogConfig read_log_config(const YamlSection& section, LogRequest request,
                                        const std::string& folder, TimeScale drive_scale);

}  // namespace waymark::drive
