#include <waymark/tools/fleet/work/slurm.hpp>

#include <algorithm>
#include <atomic>

#include <fmt/format.h>

#include <waymark/core/base/error.hpp>
#include <waymark/formats/text/text_file.hpp>
#include <waymark/tools/fleet/work/fleet_work.hpp>
#include <waymark/tools/fleet/work/process_pool.hpp>

namespace waymark::fleet {
namespace {

/// Slurm replaces words that begin with '%' in names of files.
std::string without_patterns(const std::string& path) {
  std::string text;
  for (const char c : path) text += c == '%' ? "%%" : std::string(1, c);
  return text;
}

std::string without_line_end(std::string text) {
  while (text.ends_with('\n')) text.pop_back();
  return text;
}

}  // namespace

std::vector<std::size_t> tasks_due(const FleetPlan& plan, const FleetFolder& folder, bool retry_failed) {
  std::vector<std::size_t> tasks;
  for (std::size_t task = 0; task < plan.tasks(); ++task) {
    const std::vector<PlannedDrive> share = share_of(plan, task);
    if (std::any_of(share.begin(), share.end(), [&](const PlannedDrive& drive) {
          return due(drive, folder, retry_failed) != Due::ended;
        }))
      tasks.push_back(task);
  }
  return tasks;
}

std::string array_text(const std::vector<std::size_t>& tasks) {
  std::string text;
  for (std::size_t i = 0; i < tasks.size();) {
    std::size_t last = i;
    while (last + 1 < tasks.size() && tasks[last + 1] == tasks[last] + 1) ++last;
    text += (text.empty() ? "" : ",") + std::to_string(tasks[i]);
    if (last > i) text += "-" + std::to_string(tasks[last]);
    i = last + 1;
  }
  return text;
}

std::string quoted(const std::string& word) {
  std::string text = "'";
  for (const char c : word) text += c == '\'' ? "'\\''" : std::string(1, c);
  return text + "'";
}

std::string slurm_script(const FleetPlan& plan, const FleetFolder& folder,
                         const std::vector<std::size_t>& tasks, const SlurmSettings& settings) {
  std::string text = "#!/bin/sh\n";
  const auto option = [&](const std::string& words) { text += "#SBATCH " + words + "\n"; };
  option("--job-name=waymark-fleet");
  option("--array=" + array_text(tasks));
  option(fmt::format("--cpus-per-task={}", settings.processors));
  if (settings.memory_mb > 0) option(fmt::format("--mem={}M", settings.memory_mb));
  option("--requeue");
  option("--open-mode=append");
  option("--output=" + quoted(without_patterns(folder.slurm()) + "/task-%a.log"));
  for (const std::string& further : settings.options) option(further);
  text += fmt::format("# Written by `waymark fleet --slurm`: {} drives, {} of them in each task.\n",
                      plan.drives.size(), plan.per_task);
  text += fmt::format("exec {} fleet work {} --task \"$SLURM_ARRAY_TASK_ID\" --jobs {}",
                      quoted(settings.program), quoted(folder.path()), settings.processors);
  if (settings.memory_mb > 0) text += fmt::format(" --memory {}", settings.memory_mb);
  if (settings.time_limit_s > 0) text += fmt::format(" --time-limit {}", settings.time_limit_s);
  if (settings.retry_failed) text += " --retry-failed";
  return text + "\n";
}

std::string submit(const FleetFolder& folder) {
  const std::string answer = folder.slurm() + "/submitted.txt";
  const std::string messages = folder.slurm() + "/messages.txt";
  // a shell looks sbatch up in PATH
  Process sbatch{.words = {"/bin/sh", "-c", "exec sbatch --parsable \"$0\"", folder.slurm_script()},
                 .output_file = answer,
                 .messages_file = messages};
  ProcessEnd end;
  bool is_started = false;
  const std::atomic<bool> never{false};
  run_processes(
      [&]() -> std::optional<Process> {
        return std::exchange(is_started, true) ? std::nullopt : std::optional(sbatch);
      },
      1, never, [&](std::size_t, const ProcessEnd& of) { end = of; });
  if (end.exit_code != 0 || end.signal != 0)
    throw OutputError(fmt::format("the job was not submitted: {}; submit {} yourself: sbatch {}",
                                  without_line_end(formats::read_text_file(messages)), folder.slurm_script(),
                                  quoted(folder.slurm_script())));
  return without_line_end(formats::read_text_file(answer));
}

}  // namespace waymark::fleet
