/// The report of one fused drive.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include <waymark/core/multi_start.hpp>
#include <waymark/core/sample.hpp>
#include <waymark/formats/graph_document.hpp>
#include <waymark/tools/evaluation/estimated_states.hpp>
#include <waymark/tools/evaluation/evaluation.hpp>
#include <waymark/tools/evaluation/residuals.hpp>
#include <waymark/tools/evaluation/sparsity.hpp>
#include <waymark/tools/report/page.hpp>

namespace waymark {

/// The first stamp of a document: of a vertex or a fix.
[[nodiscard]] Stamp start_of(const GraphDocument& document);

/// What a drive report is made of. All that is referred to must outlive it.
struct ReportedDrive {
  std::string name;               ///< of the drive
  std::string label;              ///< of the fusion: its modeling, or the file's name
  const GraphDocument& document;  ///< at its minimum
  const Evaluation& evaluation;
  const std::vector<TruthPose>& truth;                         ///< empty: none
  const MultiStartSummary* optimization = nullptr;             ///< null: the graph was optimised elsewhere
  const std::vector<StateReport>* states = nullptr;            ///< null: not looked at
  const GraphResiduals* residuals = nullptr;                   ///< null: not looked at
  const Sparsity* sparsity = nullptr;                          ///< null: not looked at
  std::vector<std::pair<std::string, std::string>> went_in{};  ///< heading, text
  std::vector<std::string> files{};                            ///< written beside the report, relative to it

  Stamp start = start_of(document);

  /// Seconds since the start.
  [[nodiscard]] double seconds(Stamp stamp) const { return seconds_between(start, stamp); }
};

/// Summary first, then trajectory, errors, stated against actual errors, residuals, optimisation and the
/// calibration; what there is no material for is left out.
[[nodiscard]] Page drive_page(const ReportedDrive& drive);

}  // namespace waymark
