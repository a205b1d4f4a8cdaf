/// The main job up to the graph, as the commands use it: drive.yaml to a modeled drive, told on
/// the console.
#pragma once

#include <string>
#include <vector>

#include <waymark/tools/drive/model/fuse.hpp>
#include <waymark/tools/program/jobs/drive_choice.hpp>
#include <waymark/tools/program/terminal/console.hpp>

namespace waymark::program {

/// A drive that was read, and how it is to be fused.
struct LoadedDrive {
  drive::PreparedDrive drive;
  std::vector<drive::FusionSettings> settings;  ///< of each modeling
  std::vector<std::string> files;               ///< that were read: drive.yaml and logs
};

/// Reads the logs of a drive; what was assumed or left out is told on the console.
[[nodiscard]] LoadedDrive load_drive_for(const drive::DriveFile& file, const DriveChoice& choice,
                                         const TypeRegistry& registry, const Console& console);

/// The drive under one modeling; what is odd about it is told on the console.
/// @param fusion  of the drive
[[nodiscard]] drive::ModeledDrive model_loaded(drive::Fusion& fusion, const drive::FusionSettings& settings,
                                               const TypeRegistry& registry, const Console& console);

}  // namespace waymark::program
