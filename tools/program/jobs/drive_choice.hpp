/// What the command line says of a drive, over its drive.yaml.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include <waymark/core/registry/registry.hpp>
#include <waymark/tools/drive/description/drive_file.hpp>

namespace waymark::program {

/// Changes what a drive.yaml says.
using DriveEdit = std::function<void(drive::DriveFile&)>;

struct DriveChoice {
  std::string data_folder;  ///< of the logs; empty: the drive.yaml's own
  /// empty: that of the drive.yaml; "all": every registered one
  std::vector<std::string> modelings;
  std::vector<std::string> modeling_options;  ///< NAME=VALUE; each modeling takes those that it has
  bool sync = false;                          ///< estimate the delay of the odometry's stamps, and correct it
  std::vector<DriveEdit> edits;               ///< of all else, to be made in this order
};

/// The drive.yaml with the edits made. @throws InputError for the file, UsageError for an edit
[[nodiscard]] drive::DriveFile read_drive_file(const std::string& path, const DriveChoice& choice);

/// The settings of every modeling that is chosen, each once; what is wrong with one of them shows here.
/// @throws UsageError, and InputError with the place if the drive.yaml states it
[[nodiscard]] std::vector<drive::FusionSettings> chosen_settings(const drive::DriveFile& file,
                                                                 const DriveChoice& choice,
                                                                 const TypeRegistry& registry);

/// Reads "60/240". @throws UsageError
[[nodiscard]] drive::OutagePattern parse_outage(const std::string& text);

/// Makes "on", "off", or NAME=VALUE pairs the states to estimate, pairs over those that the settings name.
/// @throws UsageError
void set_calibration(const std::vector<std::string>& words, drive::FusionSettings& settings);

}  // namespace waymark::program
