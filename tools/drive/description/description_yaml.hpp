/// The part of a drive.yaml that describes the drive (see drive_description.hpp).
#pragma once

#include <string>

#include <waymark/tools/drive/description/drive_description.hpp>
#include <waymark/tools/drive/description/yaml_section.hpp>

namespace waymark::drive {

/// Reads logs, clocks, frame and mounting.
/// @param top the whole file
/// @param data_folder the folder for relative names of logs; empty: the folder that the file states
/// @throws InputError with the place of the error
[[nodiscard]] DriveDescription read_description(const YamlSection& top, const std::string& data_folder);

}  // namespace waymark::drive
