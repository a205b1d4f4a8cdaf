/// Tables of drives that are not in the paper.
#pragma once

#include <vector>

#include <waymark/tools/reproduction/experiment/drive_result.hpp>
#include <waymark/tools/text/table.hpp>

namespace waymark::reproduction {

/// Returns an overview of the drives: length, logs, rejected share, and what is imitated
/// or simulated.
[[nodiscard]] text::Table overview_table(const std::vector<DriveResult>& drives);

/// Returns drive x {raw, the settings of the paper, ours} x {Max, Acc, Prec, RMSE, CEP95} for
/// drives with truth.
[[nodiscard]] text::Table truth_table(const std::vector<DriveResult>& drives);

/// Returns errors at withheld fixes, for drives without truth.
[[nodiscard]] text::Table withheld_table(const std::vector<DriveResult>& drives);

}  // namespace waymark::reproduction
