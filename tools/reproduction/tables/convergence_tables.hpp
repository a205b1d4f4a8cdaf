/// Tables of where the runs ended, and why.
#pragma once

#include <vector>

#include <waymark/tools/reproduction/experiment/drive_result.hpp>
#include <waymark/tools/text/table.hpp>

namespace waymark::reproduction {

/// Returns the literal settings of the paper, and each cause of their failures removed alone. A
/// cell says in how many steps the minimum of the objective was reached, or else how far from it
/// the run stopped.
[[nodiscard]] text::Table cause_table(const std::vector<DriveResult>& drives);

/// Returns our settings from both starts with every algorithm: the number of drives in which the
/// common minimum was reached.
[[nodiscard]] text::Table common_minimum_table(const std::vector<DriveResult>& drives);

/// Returns every run of every drive in one line: steps, chi2, the lowest chi2 of its objective, the
/// distance from there, and how it ended.
[[nodiscard]] text::Table run_table(const std::vector<DriveResult>& drives);

/// The number of drives in which it succeeded, and the number in which it ran.
struct Reached {
  int reached = 0;
  int of = 0;
};
/// Counts where the setting ended near the minimum of its objective (near_minimum).
[[nodiscard]] Reached count_reached(const std::vector<DriveResult>& drives, const std::string& setting);
/// Counts where it ended at the minimum (at_minimum) and was declared converged.
[[nodiscard]] Reached count_common_minimum(const std::vector<DriveResult>& drives,
                                           const std::string& setting);

}  // namespace waymark::reproduction
