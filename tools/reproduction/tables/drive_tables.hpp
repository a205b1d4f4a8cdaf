/// Tables of drives that are not the paper's.
#pragma once

#include <vector>

#include <waymark/tools/reproduction/experiment/drive_result.hpp>
#include <waymark/tools/reproduction/tables/report_table.hpp>

namespace waymark::reproduction {

/// What the drives are: length, logs, rejected share, what is imitated or simulated.
[[nodiscard]] ReportTable overview_table(const std::vector<DriveResult>& drives);

/// Drive x {raw, the paper's settings, ours} x {Max, Acc, Prec, RMSE, CEP95}, for drives with truth.
[[nodiscard]] ReportTable truth_table(const std::vector<DriveResult>& drives);

/// Errors at withheld fixes, for drives without truth.
[[nodiscard]] ReportTable withheld_table(const std::vector<DriveResult>& drives);

}  // namespace waymark::reproduction
