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
/// Returns the groups in the order of their first runs.
[[nodiscard]] std::vector<DriveGroup> groups_by_drive(const std::vector<ComparedRun>& runs);

/// The errors of one system (the raw fixes, or a run) on a drive.
struct SystemRow {
  std::string label;
  const ComparedRun* run = nullptr;  ///< null: raw fixes
  evaluation::SystemMetrics metrics;
};
/// Returns a row for the raw fixes and one for each run. If the raw fixes differ between runs
/// (other epochs), there is a row for each version. Empty without truth.
[[nodiscard]] std::vector<SystemRow> rows_against_truth(const DriveGroup& group);
/// Returns the runs at their withheld fixes, one row for each prediction ("fused", "dead
/// reckoning").
[[nodiscard]] std::vector<SystemRow> rows_at_withheld(const DriveGroup& group);

[[nodiscard]] text::Table error_table(const std::vector<DriveGroup>& groups);
[[nodiscard]] text::Table improvement_table(const std::vector<DriveGroup>& groups);
[[nodiscard]] text::Table track_table(const std::vector<DriveGroup>& groups);
[[nodiscard]] text::Table withheld_error_table(const std::vector<DriveGroup>& groups);
[[nodiscard]] text::Table stated_error_table(const std::vector<DriveGroup>& groups);
[[nodiscard]] text::Table fixes_table(const std::vector<DriveGroup>& groups);
[[nodiscard]] text::Table ending_table(const std::vector<ComparedRun>& runs);

/// Returns a bar figure for each metric, with a row for each system.
[[nodiscard]] std::vector<drawing::Figure> error_bars(const std::vector<DriveGroup>& groups);
/// Returns the same figures at withheld fixes.
[[nodiscard]] std::vector<drawing::Figure> withheld_bars(const std::vector<DriveGroup>& groups);
/// Returns the distribution of the errors, one figure per drive and seven runs.
[[nodiscard]] std::vector<drawing::Figure> distribution_figures(const std::vector<DriveGroup>& groups);
/// Returns the errors over time, one figure per drive and seven runs.
[[nodiscard]] std::vector<drawing::Figure> course_figures(const std::vector<DriveGroup>& groups);
/// Returns the fused trajectories over each other, one figure per drive and seven runs. Runs whose
/// places on Earth are not known are left out.
[[nodiscard]] std::vector<drawing::Figure> run_trajectories(const std::vector<DriveGroup>& groups);
/// Returns chi2 over the accepted steps, seven runs per figure.
[[nodiscard]] std::vector<drawing::Figure> chi2_figures(const std::vector<ComparedRun>& runs);
/// Returns iterations and seconds.
[[nodiscard]] std::vector<drawing::Figure> ending_figures(const std::vector<ComparedRun>& runs);

/// Returns the name of a row. The drive precedes it if there are several drives.
[[nodiscard]] std::string row_name(const std::vector<DriveGroup>& groups, const DriveGroup& group,
                                   const std::string& label);

}  // namespace waymark::report
