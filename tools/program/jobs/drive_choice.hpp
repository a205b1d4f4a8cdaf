/// The choices of the command line for a drive. They override its drive.yaml.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include <waymark/core/registry/registry.hpp>
#include <waymark/tools/drive/description/drive_file.hpp>

namespace waymark::program {

/// Changes the content of a drive.yaml.
using DriveEdit = std::function<void(drive::DriveFile&)>;

struct DriveChoice {
  std::string data_folder;  ///< folder of the logs; empty: that of the drive.yaml
  /// empty: that of the drive.yaml; "all": every registered one
  std::vector<std::string> modelings;
  std::vector<std::string> modeling_options;  ///< NAME=VALUE; each modeling uses those that it has
  /// estimate the delay of the odometry's stamps, and correct it
  bool sync = false;
  std::vector<DriveEdit> edits;  ///< for all other choices, applied in this order
};

/// Returns the drive.yaml with the edits. @throws UsageError for an edit
[[nodiscard]] drive::DriveFile edited(drive::DriveFile file, const DriveChoice& choice);

/// Returns the edited drive.yaml. @throws InputError for the file, UsageError for an edit
[[nodiscard]] drive::DriveFile read_drive_file(const std::string& path, const DriveChoice& choice);

/// Returns the settings of every chosen modeling, each once. Errors in them are found here.
/// @throws UsageError, and InputError with the place if the drive.yaml states it
[[nodiscard]] std::vector<drive::FusionSettings> chosen_settings(const drive::DriveFile& file,
                                                                 const DriveChoice& choice,
                                                                 const TypeRegistry& registry);

/// Reads "60/240". @throws UsageError
[[nodiscard]] drive::OutagePattern parse_outage(const std::string& text);

/// Sets the way to the initial guess, "anchored" or "dead_reckoning".
void set_initial_guess(drive::DriveFile& file, const std::string& way);
/// Sets the loss of the fixes, "LOSS:SCALE" or "none".
void set_loss(drive::DriveFile& file, const std::string& loss);
/// Keeps the fixes of every n-th epoch out of the graph. @param every 0 (none) or at least 2
void set_withheld(drive::DriveFile& file, int every);

/// Sets the states to estimate from "on", "off", or NAME=VALUE pairs; pairs are added to those of
/// the settings.
/// @throws UsageError
void set_calibration(const std::vector<std::string>& words, drive::FusionSettings& settings);

}  // namespace waymark::program
