/// The pages of the paper's experiment, the ablation and the consistency study.
#pragma once

#include <string>
#include <vector>

#include <waymark/tools/drawing/page/page.hpp>
#include <waymark/tools/reproduction/tables/reproduction_report.hpp>

namespace waymark::reproduction {

/// Returns the page: first the findings, then figures of the main results, then all tables.
/// @param drives the drives of the report
/// @param version version of the program, for the footer
[[nodiscard]] drawing::Page reproduction_page(const ReproductionReport& report,
                                              const std::vector<DriveResult>& drives,
                                              const std::string& version);

}  // namespace waymark::reproduction
