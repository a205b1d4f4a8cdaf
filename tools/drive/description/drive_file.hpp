/// A drive.yaml: the description of the drive, the settings for its fusion, and their places
/// in the file.
#pragma once

#include <map>
#include <string>
#include <string_view>

#include <waymark/tools/drive/description/drive_description.hpp>
#include <waymark/tools/drive/description/fusion_settings.hpp>

namespace waymark::drive {

/// The places of entries that are checked after the file is read, against the types in the registry;
/// for messages.
struct Places {
  std::string file;
  /// "drive.yaml:12:5: " by key: "modeling.options.NAME", "modeling.loss", "odometry.model",
  /// "odometry.options.NAME", "calibration.NAME".
  std::map<std::string, std::string> of;

  /// Returns the place of a key, or the place of the file if the key is not stated.
  [[nodiscard]] std::string at(const std::string& key) const;
};

/// A drive.yaml, parsed. Every member that it does not state has its default.
struct DriveFile {
  DriveDescription description;
  FusionSettings settings;
  Places places;
};

/// Tells whether a file is a drive, by its name (.yaml or .yml). A graph or truth file never has
/// such a name, whatever its format.
[[nodiscard]] bool is_drive_file(std::string_view path);
/// Tells the same of a file that was read. A name without extension, such as that of a pipe, says
/// nothing; the text then is a drive if a line begins with `odometry:` or `sources:`: every drive states
/// one of them.
[[nodiscard]] bool is_drive_text(std::string_view path, std::string_view text);
/// Tells whether a plugin is named by its file. A word without folder and extension is looked up by
/// the caller that loads it.
[[nodiscard]] bool is_plugin_file(std::string_view plugin);

/// Reads and checks a drive.yaml (tools/drive/DRIVE_YAML.md lists the keys). Logs are not opened.
/// @param data_folder the folder for relative names of logs, in place of the file's own `folder`
/// (empty: use that)
/// @throws InputError "drive.yaml:12:5: unknown key 'colums'; did you mean 'columns'?" and the like
[[nodiscard]] DriveFile load_drive_file(const std::string& path, const std::string& data_folder = "");

/// Reads a drive.yaml from text. @param path name of the file, for messages and as the base of
/// relative folders
[[nodiscard]] DriveFile parse_drive_file(const std::string& text, const std::string& path,
                                         const std::string& data_folder = "");

}  // namespace waymark::drive
