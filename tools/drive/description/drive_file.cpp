#include <waymark/tools/drive/description/drive_file.hpp>

#include <filesystem>

#include <waymark/formats/text/text_file.hpp>
#include <waymark/tools/drive/description/description_yaml.hpp>
#include <waymark/tools/drive/description/settings_yaml.hpp>
#include <waymark/tools/drive/description/yaml_document.hpp>

namespace waymark::drive {

std::string Places::at(const std::string& key) const {
  const auto place = of.find(key);
  return place == of.end() ? file + ": " : place->second;
}

bool is_drive_file(std::string_view path) {
  return path.ends_with(".yaml") || path.ends_with(".yml");
}

bool is_drive_text(std::string_view path, std::string_view text) {
  if (std::filesystem::path(path).has_extension()) return is_drive_file(path);
  const auto has = [&](std::string_view line) {
    return text.starts_with(line.substr(1)) || text.find(line) != std::string_view::npos;
  };
  return has("\nodometry:") || has("\nsources:");
}

bool is_plugin_file(std::string_view plugin) {
  const std::filesystem::path path(plugin);
  return path.has_parent_path() || path.has_extension();
}

DriveFile parse_drive_file(const std::string& text, const std::string& path, const std::string& data_folder) {
  const YamlSection top(
      load_yaml_document(text, path), "", path,
      {"name", "environment", "folder", "time", "frame", "odometry", "gnss", "truth", "gate", "gap", "snap",
       "initial_guess", "modeling", "calibration", "noise", "sensors", "sources", "plugins", "first_pose"});
  DriveFile file;
  file.places.file = path;
  file.description = read_description(top, data_folder);
  read_settings(top, file.settings, file.places);
  file.settings.folder = file.description.folder;
  return file;
}

DriveFile load_drive_file(const std::string& path, const std::string& data_folder) {
  constexpr std::size_t kMost = std::size_t{16} << 20U;
  return parse_drive_file(formats::read_text_file(path, {kMost, "a drive.yaml"}), path, data_folder);
}

}  // namespace waymark::drive
