#include <waymark/tools/fleet/folder/fleet_plan.hpp>

#include <algorithm>
#include <array>
#include <filesystem>
#include <system_error>
#include <tuple>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <waymark/core/base/error.hpp>
#include <waymark/formats/text/text_file.hpp>
#include <waymark/tools/text/json_place.hpp>

namespace waymark::fleet {
namespace {

namespace fs = std::filesystem;

constexpr const char* kDriveFile = "drive.yaml";
constexpr std::array<std::pair<Keep, const char*>, 3> kKeepWords = {
    {{Keep::all, "all"}, {Keep::report, "report"}, {Keep::metrics, "metrics"}}};

fs::path absolute_path(const std::string& path) {
  const fs::path plain = fs::absolute(path).lexically_normal();
  return plain.has_filename() ? plain : plain.parent_path();
}

PlannedDrive drive_of_file(const fs::path& file) {
  const bool named_by_folder = file.filename() == kDriveFile && file.parent_path().has_filename();
  return {named_by_folder ? file.parent_path().filename().string() : file.stem().string(), file.string()};
}

std::vector<PlannedDrive> drives_below(const fs::path& folder) {
  std::vector<PlannedDrive> drives;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.path().filename() != kDriveFile || !entry.is_regular_file()) continue;
    const fs::path below = entry.path().parent_path().lexically_relative(folder);
    const bool is_itself = below == ".";
    drives.push_back({is_itself ? folder.filename().string() : below.string(),
                      (folder / below / kDriveFile).lexically_normal().string()});
  }
  if (drives.empty())
    throw InputError(fmt::format("{}: there is no {} in it or below", folder.string(), kDriveFile));
  return drives;
}

/// Results of "a" would lie around those of "a/b".
void require_separate_names(const std::vector<PlannedDrive>& drives) {
  for (std::size_t i = 1; i < drives.size(); ++i) {
    const PlannedDrive& before = drives[i - 1];
    const PlannedDrive& drive = drives[i];
    if (drive.name == before.name)
      throw InputError(fmt::format(
          "two drives are called '{}': {} and {}; name the folder above both, then each is called by its "
          "path in it",
          drive.name, before.path, drive.path));
  }
  for (const PlannedDrive& drive : drives) {
    for (fs::path above = fs::path(drive.name).parent_path(); above.has_filename();
         above = above.parent_path()) {
      const auto same = std::lower_bound(
          drives.begin(), drives.end(), above.string(),
          [](const PlannedDrive& other, const std::string& name) { return other.name < name; });
      if (same != drives.end() && same->name == above.string())
        throw InputError(fmt::format("drive '{}' lies in the folder of drive '{}' ({}); move it beside",
                                     drive.name, same->name, same->path));
    }
  }
}

}  // namespace

std::vector<PlannedDrive> find_drives(const std::vector<std::string>& paths) {
  std::vector<PlannedDrive> drives;
  for (const std::string& given : paths) {
    const fs::path path = absolute_path(given);
    std::error_code unknown;
    if (fs::is_directory(path, unknown)) {
      for (PlannedDrive& drive : drives_below(path)) drives.push_back(std::move(drive));
    } else if (fs::exists(path, unknown)) {
      drives.push_back(drive_of_file(path));
    } else {
      throw InputError(given + ": there is no such file or folder");
    }
  }
  std::sort(drives.begin(), drives.end(), [](const PlannedDrive& a, const PlannedDrive& b) {
    return std::tie(a.name, a.path) < std::tie(b.name, b.path);
  });
  const auto same = [](const PlannedDrive& a, const PlannedDrive& b) { return a.path == b.path; };
  drives.erase(std::unique(drives.begin(), drives.end(), same), drives.end());
  require_separate_names(drives);
  return drives;
}

std::string plan_json(const FleetPlan& plan) {
  nlohmann::ordered_json drives = nlohmann::ordered_json::array();
  for (const PlannedDrive& drive : plan.drives)
    drives.push_back({{"name", drive.name}, {"path", drive.path}});
  const nlohmann::ordered_json json = {{"schema", "waymark-fleet-plan"},
                                       {"version", 1},
                                       {"label", plan.label},
                                       {"options", plan.options},
                                       {"keep", to_string(plan.keep)},
                                       {"per_task", plan.per_task},
                                       {"drives", std::move(drives)}};
  return json.dump(1, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

FleetPlan read_plan(const FleetFolder& folder) {
  const std::string file = folder.plan();
  std::error_code unknown;
  if (!fs::is_regular_file(file, unknown))
    throw InputError(folder.path() + ": is no folder of a fleet; `waymark fleet DRIVES... -o DIR` makes one");
  const nlohmann::ordered_json document = text::parse_json(formats::read_text_file(file), file);
  const text::JsonPlace json(document, file);
  if (json.text("schema") != "waymark-fleet-plan") json.at("schema").expected("\"waymark-fleet-plan\"");
  if (json.number("version") != 1) json.at("version").expected("version 1");
  FleetPlan plan;
  plan.label = json.text("label");
  for (const text::JsonPlace& word : json.at("options").items()) plan.options.push_back(word.text());
  plan.keep = keep_from_string(json.text("keep"));
  plan.per_task = std::max<std::size_t>(1, json.count("per_task"));
  for (const text::JsonPlace& drive : json.at("drives").items())
    plan.drives.push_back({drive.text("name"), drive.text("path")});
  return plan;
}

std::string difference(const FleetPlan& before, const FleetPlan& now) {
  const auto words = [](const FleetPlan& plan) {
    return plan.options.empty() ? "none" : fmt::format("{}", fmt::join(plan.options, " "));
  };
  if (before.options != now.options)
    return fmt::format("its options are: {}; now: {}", words(before), words(now));
  if (before.label != now.label) return fmt::format("its label is '{}', now '{}'", before.label, now.label);
  if (before.keep != now.keep)
    return fmt::format("it keeps '{}', now '{}'", to_string(before.keep), to_string(now.keep));
  return {};
}

std::string to_string(Keep keep) {
  for (const auto& [value, word] : kKeepWords)
    if (value == keep) return word;
  return {};
}

Keep keep_from_string(const std::string& word) {
  for (const auto& [value, known] : kKeepWords)
    if (word == known) return value;
  throw UsageError("unknown word '" + word + "' for what to keep; there are: all, report, metrics");
}

}  // namespace waymark::fleet
