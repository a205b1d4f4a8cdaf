/// The paper's six tables with its figures beside ours, and what lies beyond.
#pragma once

#include <vector>

#include <waymark/tools/reproduction/experiment/drive_result.hpp>
#include <waymark/tools/reproduction/tables/report_table.hpp>

namespace waymark::reproduction {

/// Dataset overview; GNSS; G1; G2; G3; G2 without rejection; and one that the paper does not have: the
/// default model beside G2, with what the covariances are worth. The results have three triples of columns:
/// the paper's figures, the paper's settings on these drives, our settings on these drives; below them
/// averages and improvements as the paper forms them. Drives that are not the paper's are left out.
[[nodiscard]] std::vector<ReportTable> paper_tables(const std::vector<DriveResult>& drives);

}  // namespace waymark::reproduction
