/// Tables and figures of a comparison page.
#pragma once

#include <string>
#include <vector>

#include <waymark/tools/drawing/page/page.hpp>
#include <waymark/tools/report/comparison/compared_run.hpp>
#include <waymark/tools/report/metric_columns.hpp>

namespace waymark::report {

/// The runs of one drive.
struct DriveGroup {
  std::string drive;
  std::vector<const ComparedRun*> runs;
};
/// In order of their first runs.
[[nodiscard]] std::vector<DriveGroup> groups_by_drive(const std::vector<ComparedRun>& runs);

/// What one system achieved on a drive against truth: the raw fixes, or a run.
struct SystemRow {
  std::string label;
  const ComparedRun* run = nullptr;  ///< null: raw fixes
  evaluation::SystemMetrics metrics;
};
/// Raw fixes, again where they differ between the runs (other epochs), and the runs. Empty without truth.
[[nodiscard]] std::vector<SystemRow> rows_against_truth(const DriveGroup& group);
/// The runs at their withheld fixes, by what was predicted there ("fused", "dead reckoning").
[[nodiscard]] std::vector<SystemRow> rows_at_withheld(const DriveGroup& group);

[[nodiscard]] drawing::PageTable error_table(const std::vector<DriveGroup>& groups);
[[nodiscard]] drawing::PageTable improvement_table(const std::vector<DriveGroup>& groups);
[[nodiscard]] drawing::PageTable track_table(const std::vector<DriveGroup>& groups);
[[nodiscard]] drawing::PageTable withheld_error_table(const std::vector<DriveGroup>& groups);
[[nodiscard]] drawing::PageTable stated_error_table(const std::vector<DriveGroup>& groups);
[[nodiscard]] drawing::PageTable fixes_table(const std::vector<DriveGroup>& groups);
[[nodiscard]] drawing::PageTable ending_table(const std::vector<ComparedRun>& runs);

/// A figure of bars for each metric, a row for each system.
[[nodiscard]] std::vector<drawing::Figure> error_bars(const std::vector<DriveGroup>& groups);
/// The same at withheld fixes.
[[nodiscard]] std::vector<drawing::Figure> withheld_bars(const std::vector<DriveGroup>& groups);
/// Distribution of the errors, a figure for each drive and seven runs.
[[nodiscard]] std::vector<drawing::Figure> distribution_figures(const std::vector<DriveGroup>& groups);
/// Errors over time, likewise.
[[nodiscard]] std::vector<drawing::Figure> course_figures(const std::vector<DriveGroup>& groups);
/// chi2 over the accepted steps, seven runs a figure.
[[nodiscard]] std::vector<drawing::Figure> chi2_figures(const std::vector<ComparedRun>& runs);
/// Iterations and seconds.
[[nodiscard]] std::vector<drawing::Figure> ending_figures(const std::vector<ComparedRun>& runs);

/// With the drive before it where there are several.
[[nodiscard]] std::string row_name(const std::vector<DriveGroup>& groups, const DriveGroup& group,
                                   const std::string& label);

}  // namespace waymark::report
