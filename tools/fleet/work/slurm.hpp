/// Runs a fleet on a cluster: a job array of Slurm, each task of which works through a share of the
/// drives.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <waymark/tools/fleet/folder/fleet_plan.hpp>

namespace waymark::fleet {

/// Slurm's own limit of tasks in an array is 1000, unless the cluster states another (MaxArraySize).
inline constexpr std::size_t kMostTasks = 1000;

struct SlurmSettings {
  std::string program;               ///< file of the program `waymark`, the same on every node
  std::size_t processors = 1;        ///< of a task; as many drives are run at once
  std::uint64_t memory_mb = 0;       ///< of a task; 0: the cluster's default
  std::vector<std::string> options;  ///< further ones of sbatch: "--partition=long"
  double time_limit_s = 0;           ///< of each drive; 0: none
  bool retry_failed = false;
};

/// Returns the tasks that have drives to run, ascending.
[[nodiscard]] std::vector<std::size_t> tasks_due(const FleetPlan& plan, const FleetFolder& folder,
                                                 bool retry_failed);

/// Returns an index list of Slurm: "0-3,7".
[[nodiscard]] std::string array_text(const std::vector<std::size_t>& tasks);

/// Returns the batch script. Slurm starts a task again if its node fails (--requeue); the task then goes
/// on with the drives that have no record.
[[nodiscard]] std::string slurm_script(const FleetPlan& plan, const FleetFolder& folder,
                                       const std::vector<std::size_t>& tasks, const SlurmSettings& settings);

/// Submits the script. Returns the number of the job.
/// @throws OutputError with the words of sbatch, or if there is no sbatch
[[nodiscard]] std::string submit(const FleetFolder& folder);

/// Returns the word as a POSIX shell takes it literally.
[[nodiscard]] std::string quoted(const std::string& word);

}  // namespace waymark::fleet
