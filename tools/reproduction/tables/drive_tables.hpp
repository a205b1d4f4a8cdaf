/// Tables of drives that are not in the paper.
#pragma once

#include <vector>

#include <waymark/tools/reproduction/experiment/drive_result.hpp>
#include <waymark/tools/reproduction/tables/report_table.hpp>

namespace waymark::reproduction {

/// Returns an overview of the drives: length, logs, rejected share, and what is imitated
/// or simulated.
[[nodiscard]] ReportTable overview_table(const std::vector<DriveResult>& drives);

/// Returns drive x {raw, the settings of the paper, ours} x {Max, Acc, Prec, RMSE, CEP95} for
/// drives with truth.
[[nodiscard]] ReportTable truth_table(const std::vector<DriveResult>& drives);

/// Returns errors at withheld fixes, for drives without truth.
[[nodiscard]] ReportTable withheld_table(const std::vector<DriveResult>& drives);

}  // namespace waymark::reproduction
