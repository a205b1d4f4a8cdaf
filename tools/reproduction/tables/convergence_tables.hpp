/// Where the runs ended, and why.
#pragma once

#include <vector>

#include <waymark/tools/reproduction/experiment/drive_result.hpp>
#include <waymark/tools/reproduction/tables/report_table.hpp>

namespace waymark::reproduction {

/// The paper's literal settings, and each cause of their failures switched off alone: whether the minimum of
/// the objective was reached, in how many steps, else how far from it the run stopped.
[[nodiscard]] ReportTable cause_table(const std::vector<DriveResult>& drives);

/// Our settings from both starts with every algorithm: in how many drives the common minimum was reached.
[[nodiscard]] ReportTable common_minimum_table(const std::vector<DriveResult>& drives);

/// Every run of every drive, a line each: steps, chi2, the lowest chi2 of its objective, the distance from
/// there, how it ended.
[[nodiscard]] ReportTable run_table(const std::vector<DriveResult>& drives);

/// In how many of the drives, and in how many it was run.
struct Reached {
  int reached = 0;
  int of = 0;
};
/// The setting ended near the minimum of its objective (near_minimum).
[[nodiscard]] Reached count_reached(const std::vector<DriveResult>& drives, const std::string& setting);
/// It ended at it (at_minimum) and was declared converged.
[[nodiscard]] Reached count_common_minimum(const std::vector<DriveResult>& drives,
                                           const std::string& setting);

}  // namespace waymark::reproduction
