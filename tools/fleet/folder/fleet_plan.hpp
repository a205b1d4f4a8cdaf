/// The plan of a fleet: its drives, and how all of them are run. It is written once, before the
/// first drive, and read by every machine that works on the fleet.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <waymark/tools/fleet/folder/fleet_folder.hpp>

namespace waymark::fleet {

struct PlannedDrive {
  std::string name;  ///< in tables and file names; may have folders: "monday/7"
  std::string path;  ///< of its drive.yaml, absolute
};

/// The results of a drive that are kept.
enum class Keep {
  all,     ///< everything that `waymark run` writes
  report,  ///< the report, without files that can be made again from the graph; and these:
  metrics  ///< metrics.json, summary.json
};

struct FleetPlan {
  std::string label;                 ///< of the fleet in tables: a version, a commit, a setting
  std::vector<std::string> options;  ///< words for `waymark run`, for all drives
  Keep keep = Keep::report;
  std::size_t per_task = 1;          ///< drives of one task of a cluster
  std::vector<PlannedDrive> drives;  ///< ordered by name

  [[nodiscard]] std::size_t tasks() const { return (drives.size() + per_task - 1) / per_task; }
};

/// Finds the drives of a fleet. A file is a drive. A folder stands for every `drive.yaml` below it.
/// The name of a drive is that of the folder of its drive.yaml, below the folder that was given; a
/// file with another name than drive.yaml is called by it.
/// @throws InputError for a path that does not exist, a folder without drives, and two drives of one name
[[nodiscard]] std::vector<PlannedDrive> find_drives(const std::vector<std::string>& paths);

[[nodiscard]] std::string plan_json(const FleetPlan& plan);
/// @throws InputError if the folder has no plan, or another one than plan_json wrote
[[nodiscard]] FleetPlan read_plan(const FleetFolder& folder);

/// Returns how the results of one plan would differ from those of another; empty: not at all. The
/// drives themselves may differ.
[[nodiscard]] std::string difference(const FleetPlan& before, const FleetPlan& now);

[[nodiscard]] std::string to_string(Keep keep);
/// @throws UsageError
[[nodiscard]] Keep keep_from_string(const std::string& word);

}  // namespace waymark::fleet
