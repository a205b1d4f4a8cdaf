#include <waymark/tools/drive/description/drive_file.hpp>

#include <algorithm>
#include <filesystem>

#include <fmt/format.h>

#include <waymark/core/base/error.hpp>
#include <waymark/formats/text/text_file.hpp>
#include <waymark/tools/drive/description/description_yaml.hpp>
#include <waymark/tools/drive/description/settings_yaml.hpp>

namespace waymark::drive {
namespace {

/// An anchor may stand within what it names, or ten times within each of ten levels.
/// @throws InputError for a value without end, or of more values than a drive can need
void check_extent(const YAML::Node& node, const std::string& path, int depth, std::size_t& count) {
  constexpr int kDeepest = 50;
  constexpr std::size_t kMost = 100'000;
  if (depth > kDeepest || ++count > kMost)
    throw InputError(fmt::format("{}:{}:{}: {}", path, node.Mark().line + 1, node.Mark().column + 1,
                                 depth > kDeepest
                                     ? "the values are nested more than 50 deep"
                                     : "the file has more than 100,000 values with its aliases"));
  for (const auto& entry : node) {
    if (node.IsMap()) {
      check_extent(entry.first, path, depth + 1, count);
      check_extent(entry.second, path, depth + 1, count);
    } else {
      check_extent(entry, path, depth + 1, count);
    }
  }
}

YAML::Node load_yaml(const std::string& text, const std::string& path) {
  try {
    const std::vector<YAML::Node> documents = YAML::LoadAll(text);
    if (documents.empty()) return {};
    if (documents.size() > 1)
      throw InputError(
          fmt::format("{}:{}:1: a second YAML document begins; a drive is one, without '---' inside", path,
                      std::max(documents[1].Mark().line, 0) + 1));
    std::size_t count = 0;
    check_extent(documents.front(), path, 0, count);
    return documents.front();
  } catch (const YAML::Exception& error) {
    throw InputError(fmt::format("{}:{}:{}: no valid YAML: {}", path, error.mark.line + 1,
                                 error.mark.column + 1, error.msg));
  }
}

}  // namespace

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
      load_yaml(text, path), "", path,
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
