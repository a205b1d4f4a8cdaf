// Reads runs from the folders that `waymark run` and `waymark evaluate` wrote.
#include <algorithm>
#include <filesystem>
#include <map>

#include <fmt/format.h>

#include <waymark/core/base/error.hpp>
#include <waymark/formats/text/text_file.hpp>
#include <waymark/tools/evaluation/output/metrics_reader.hpp>
#include <waymark/tools/evaluation/output/result_folder.hpp>
#include <waymark/tools/report/comparison/compared_run.hpp>
#include <waymark/tools/report/comparison/epochs_table.hpp>

namespace waymark::report {
namespace {

namespace fs = std::filesystem;

bool is_file(const std::string& path) {
  std::error_code unknown;
  return fs::is_regular_file(path, unknown);
}

void add_endings(const evaluation::ResultFolder& folder, std::vector<ComparedRun>& runs) {
  const std::string file = folder.summary();
  if (!is_file(file)) return;
  const auto endings = evaluation::read_run_summary(formats::read_text_file(file), file);
  for (ComparedRun& run : runs) {
    if (const auto ending = endings.find(run.label); ending != endings.end()) run.ending = ending->second;
  }
}

void add_epochs(const evaluation::ResultFolder& folder, std::vector<ComparedRun>& runs) {
  for (ComparedRun& run : runs) {
    const std::string file = folder.epochs(run.label);
    if (is_file(file)) run.evaluation.epochs = read_epochs_table(formats::read_text_file(file), file);
  }
}

std::vector<ComparedRun> read_folder(const std::string& path) {
  const evaluation::ResultFolder folder(path);
  const std::string file = folder.metrics();
  if (!is_file(file)) {
    std::error_code unknown;
    const bool there = fs::is_directory(path, unknown);
    throw InputError(fmt::format(
        "{}: {}; name a folder that `waymark run DRIVE -o DIR` or `waymark evaluate GRAPH -o DIR` wrote",
        path, there ? "has no metrics.json" : "is no folder"));
  }
  const evaluation::MetricsDocument document =
      evaluation::read_metrics_json(formats::read_text_file(file), file);
  if (document.evaluations.empty()) throw InputError(file + ": has no evaluation in it");
  std::vector<ComparedRun> runs;
  for (const evaluation::LabelledEvaluation& evaluation : document.evaluations)
    runs.push_back(compared_run(evaluation, document.header));
  add_endings(folder, runs);
  add_epochs(folder, runs);
  return runs;
}

/// Returns the absolute path, without "." and without a slash at its end.
fs::path plain_path(const std::string& folder) {
  std::error_code unknown;
  const fs::path path = fs::absolute(folder, unknown).lexically_normal();
  return path.has_filename() ? path : path.parent_path();
}

/// Returns the last `parts` names of a path: "results/a" of "/home/me/results/a/" with two.
std::string tail_of(const std::string& folder, std::size_t parts) {
  fs::path path = plain_path(folder);
  fs::path tail;
  for (std::size_t i = 0; i < parts && path.has_filename(); ++i, path = path.parent_path())
    tail = tail.empty() ? path.filename() : path.filename() / tail;
  return tail.string();
}

bool all_differ(std::vector<std::string> names) {
  std::sort(names.begin(), names.end());
  return std::adjacent_find(names.begin(), names.end()) == names.end();
}

/// Returns as few names of each path as distinguish the folders.
std::vector<std::string> short_names(const std::vector<std::string>& folders) {
  constexpr std::size_t kMostParts = 4;
  std::vector<std::string> names;
  for (std::size_t parts = 1; parts <= kMostParts; ++parts) {
    names.clear();
    for (const std::string& folder : folders) names.push_back(tail_of(folder, parts));
    if (all_differ(names)) break;
  }
  return names;
}

void make_labels_differ(std::vector<ComparedRun>& runs) {
  std::vector<std::string> taken;
  for (ComparedRun& run : runs) {
    std::string label = run.label;
    for (int n = 2; std::find(taken.begin(), taken.end(), label) != taken.end(); ++n)
      label = fmt::format("{} {}", run.label, n);
    run.label = label;
    taken.push_back(label);
  }
}

}  // namespace

std::vector<ComparedRun> read_compared_runs(const std::vector<std::string>& folders) {
  for (std::size_t f = 1; f < folders.size(); ++f) {
    const auto same = [&](const std::string& other) { return plain_path(other) == plain_path(folders[f]); };
    if (std::any_of(folders.begin(), folders.begin() + static_cast<std::ptrdiff_t>(f), same))
      throw UsageError(folders[f] + ": is named twice");
  }
  const std::vector<std::string> names = short_names(folders);
  std::vector<std::vector<ComparedRun>> of_folder;
  bool one_each = true;
  for (const std::string& folder : folders) {
    of_folder.push_back(read_folder(folder));
    one_each = one_each && of_folder.back().size() == 1;
  }
  std::vector<ComparedRun> all;
  const std::string first_label = of_folder.front().front().label;
  for (std::size_t f = 0; f < folders.size(); ++f) {
    for (ComparedRun& run : of_folder[f]) {
      if (folders.size() > 1) run.label = names[f] + " " + run.label;
      all.push_back(std::move(run));
    }
  }
  // If there is only one modeling, the folders alone distinguish the runs.
  const bool one_label = one_each && std::all_of(all.begin(), all.end(), [&](const ComparedRun& run) {
                           return run.label.ends_with(" " + first_label);
                         });
  if (one_label) {
    for (ComparedRun& run : all) run.label.resize(run.label.size() - first_label.size() - 1);
  }
  make_labels_differ(all);
  return all;
}

}  // namespace waymark::report
