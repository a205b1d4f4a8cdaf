/// The main job up to the graph, for the commands. It turns a drive.yaml into a modeled drive, and
/// reports on the console.
#pragma once

#include <set>
#include <string>
#include <vector>

#include <waymark/tools/drive/model/fuse.hpp>
#include <waymark/tools/program/jobs/drive_choice.hpp>
#include <waymark/tools/program/terminal/console.hpp>

namespace waymark::program {

/// A drive in memory, and the settings for its fusion.
struct LoadedDrive {
  drive::PreparedDrive drive;
  std::vector<drive::FusionSettings> settings;  ///< one for each modeling
  std::vector<std::string> files;               ///< that were read: drive.yaml and logs
};

/// Reads the logs of a drive. Assumptions and omissions are reported on the console.
[[nodiscard]] LoadedDrive load_drive_for(const drive::DriveFile& file, const DriveChoice& choice,
                                         const TypeRegistry& registry, const Console& console);

/// Returns the drive with one modeling. Oddities are reported on the console.
/// @param fusion of the drive
/// @param told sentences that another modeling of the drive has reported; those of this one are added
[[nodiscard]] drive::ModeledDrive model_loaded(drive::Fusion& fusion, const drive::FusionSettings& settings,
                                               const TypeRegistry& registry, const Console& console,
                                               std::set<std::string>& told);

}  // namespace waymark::program
