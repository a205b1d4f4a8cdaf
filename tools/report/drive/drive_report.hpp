/// The report of one fused drive.
#pragma once

#include <span>
#include <string>
#include <utility>
#include <vector>

#include <waymark/core/drive/sample.hpp>
#include <waymark/core/optimize/multi_start.hpp>
#include <waymark/formats/graph/graph_document.hpp>
#include <waymark/tools/drawing/page/page.hpp>
#include <waymark/tools/evaluation/document/estimated_states.hpp>
#include <waymark/tools/evaluation/document/residuals.hpp>
#include <waymark/tools/evaluation/document/sparsity.hpp>
#include <waymark/tools/evaluation/evaluation.hpp>

namespace waymark::report {

/// Returns the first stamp of a vertex or fix in a document.
[[nodiscard]] Stamp start_of(const formats::GraphDocument& document);

/// The input of a drive report. All references must outlive it.
struct ReportedDrive {
  std::string name;                        ///< of the drive
  std::string label;                       ///< of the fusion: its modeling, or the name of the file
  const formats::GraphDocument& document;  ///< at its minimum
  const evaluation::Evaluation& evaluation;
  const std::vector<TruthPose>& truth;  ///< empty: none
  /// null: the graph was optimised elsewhere
  const MultiStartSummary* optimization = nullptr;
  const std::vector<evaluation::StateReport>* states = nullptr;  ///< null: not computed
  const evaluation::GraphResiduals* residuals = nullptr;         ///< null: not computed
  const evaluation::Sparsity* sparsity = nullptr;                ///< null: not computed
  /// of the measurements, with each of them (group_residuals.hpp); empty: no sensor tells of groups
  std::span<const evaluation::GroupedResiduals> groups{};
  text::Table noise{};  ///< the estimated noise; without rows: as stated
  std::vector<std::pair<std::string, std::string>> went_in{};  ///< the inputs: heading, text
  std::vector<StampedPose> dead_reckoned{};  ///< the drive by odometry alone; empty: not known
  std::vector<drawing::Series> ground{};     ///< a map beneath the trajectory (ground_map.hpp)
  /// files beside the report, relative to it
  std::vector<std::string> files{};

  Stamp start = start_of(document);

  /// Returns seconds since the start.
  [[nodiscard]] double seconds(Stamp stamp) const { return seconds_between(start, stamp); }
};

/// Returns the page: first the summary, then trajectory, errors, stated against actual errors,
/// residuals, optimisation and calibration. Parts without data are left out.
[[nodiscard]] drawing::Page drive_page(const ReportedDrive& drive);

}  // namespace waymark::report
