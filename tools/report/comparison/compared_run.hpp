/// A run as a comparison sees it: from memory, or from the folder that `waymark run -o` wrote.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <waymark/core/optimize/multi_start.hpp>
#include <waymark/tools/evaluation/output/report.hpp>

namespace waymark::report {

/// How the minimisation of a run ended.
struct ComparedEnding {
  bool converged = false;
  std::string message;
  std::size_t iterations = 0;
  double seconds = evaluation::kUndefined;
  double initial_chi2 = evaluation::kUndefined;
  double final_chi2 = evaluation::kUndefined;
  std::vector<double> chi2;  ///< at the start and after every accepted step; empty: not known
};

struct ComparedRun {
  std::string label;  ///< names the run in tables and figures
  std::string drive;  ///< its name; errors of one drive are comparable
  evaluation::Evaluation evaluation;
  std::optional<ComparedEnding> ending;
  /// What was done, and with what: key and text, each key once, in order of the keys ("input gnss.csv",
  /// "modeling_option tails", "start").
  std::vector<std::pair<std::string, std::string>> provenance;
};

/// @param header  of the report that the evaluation stands in; gives the drive, and the provenance under
///                "LABEL.KEY"
/// @param result  of its optimisation; null: not known
[[nodiscard]] ComparedRun compared_run(const evaluation::LabelledEvaluation& evaluation,
                                       const evaluation::ReportHeader& header,
                                       const MultiStartSummary* result = nullptr);

/// The runs of folders that `waymark run` or `waymark evaluate -o` wrote: metrics.json, and where they are
/// there summary.json and LABEL.epochs.csv. A label is the folder's name and the evaluation's own, without
/// what all of them share, and made different where two are equal.
/// @throws UsageError for a folder that is named twice;
///         InputError for a folder without metrics.json, and files that cannot be read
[[nodiscard]] std::vector<ComparedRun> read_compared_runs(const std::vector<std::string>& folders);

}  // namespace waymark::report
