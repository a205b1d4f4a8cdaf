/// The main job up to the graph, for the commands. It turns a drive.yaml into a modeled drive, and
/// reports on the console.
#pragma once

#include <algorithm>
#include <set>
#include <string>
#include <vector>

#include <waymark/core/base/error.hpp>
#include <waymark/tools/drive/model/fuse.hpp>
#include <waymark/tools/program/jobs/drive_choice.hpp>
#include <waymark/tools/program/terminal/console.hpp>

namespace waymark::program {

/// A drive in memory, and the settings for its fusion.
struct LoadedDrive {
  drive::PreparedDrive drive;
  std::vector<drive::FusionSettings> settings;  ///< one for each modeling
  std::vector<std::string> files;               ///< that were read: drive.yaml and logs
  std::string path;                             ///< of the drive.yaml
};

/// Does a part of the job. The place of an error that names no file of the drive is the drive.yaml.
template <typename Work>
auto at_drive(const LoadedDrive& loaded, const Work& work) {
  try {
    return work();
  } catch (const InputError& error) {
    const std::string message = error.what();
    const bool placed = std::any_of(loaded.files.begin(), loaded.files.end(), [&](const std::string& file) {
      return message.find(file) != std::string::npos;
    });
    if (placed) throw;
    throw InputError(loaded.path + ": " + message);
  }
}

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
