/// The part of a drive.yaml that defines how the drive is fused (see fusion_settings.hpp).
#pragma once

#include <waymark/tools/drive/description/drive_file.hpp>
#include <waymark/tools/drive/description/yaml_section.hpp>

namespace waymark::drive {

/// Reads the settings, and the places of names and options that the registry checks later
/// (core/registry/options.hpp).
/// @param top the whole file
/// @throws InputError with the place of the error
void read_settings(const YamlSection& top, FusionSettings& settings, Places& places);

}  // namespace waymark::drive
