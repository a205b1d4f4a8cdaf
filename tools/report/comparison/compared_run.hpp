/// The data of a run that a comparison needs, from memory or from the folder that `waymark
/// run -o` wrote.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <waymark/core/optimize/multi_start.hpp>
#include <waymark/tools/evaluation/output/report.hpp>
#include <waymark/tools/evaluation/output/summary_json.hpp>

namespace waymark::report {

struct ComparedRun {
  std::string label;  ///< name of the run in tables and figures
  std::string drive;  ///< name of the drive; errors of one drive are comparable
  evaluation::Evaluation evaluation;
  std::optional<evaluation::RunEnding> ending;
  /// Settings and inputs: key and text, each key once, ordered by key ("input gnss.csv",
  /// "modeling_option tails", "start").
  std::vector<std::pair<std::string, std::string>> provenance;
};

/// @param header header of the report that contains the evaluation; it gives the drive and the
/// provenance under "LABEL.KEY"
/// @param result result of its optimisation; null: not known
[[nodiscard]] ComparedRun compared_run(const evaluation::LabelledEvaluation& evaluation,
                                       const evaluation::ReportHeader& header,
                                       const MultiStartSummary* result = nullptr);

/// Reads the runs of folders that `waymark run` or `waymark evaluate -o` wrote: metrics.json, and
/// if present summary.json and LABEL.epochs.csv. The label of a run is made from the name of the
/// folder and the label of the evaluation, without the parts that all runs share. Equal labels are
/// made different.
/// @throws UsageError for a folder that is named twice; InputError for a folder without
/// metrics.json, and for files that cannot be read
[[nodiscard]] std::vector<ComparedRun> read_compared_runs(const std::vector<std::string>& folders);

}  // namespace waymark::report
