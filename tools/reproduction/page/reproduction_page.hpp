/// The pages of the paper's experiment, the ablation and the consistency study.
#pragma once

#include <string>
#include <vector>

#include <waymark/tools/drawing/page/page.hpp>
#include <waymark/tools/reproduction/tables/reproduction_report.hpp>

namespace waymark::reproduction {

/// Findings first, then figures of what the report is about, then all of its tables.
/// @param drives   the report was made of them
/// @param version  of the program, for the footer
[[nodiscard]] drawing::Page reproduction_page(const ReproductionReport& report,
                                              const std::vector<DriveResult>& drives,
                                              const std::string& version);

}  // namespace waymark::reproduction
