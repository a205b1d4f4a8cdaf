/// What a drive report says first: what went in, what was assumed, what was rejected, what came out.
#pragma once

#include <waymark/tools/drawing/page/page.hpp>
#include <waymark/tools/report/drive/drive_report.hpp>

namespace waymark::report {

/// The sentences at the top of the page, and whether the fused positions are better or worse than raw GNSS.
void summarise(const ReportedDrive& drive, drawing::Page& page);

/// Metrics, errors at withheld fixes, and the account of the drive.
[[nodiscard]] drawing::Section summary_section(const ReportedDrive& drive);

/// Errors along and across the direction of travel, and of the heading.
[[nodiscard]] drawing::PageTable track_table(const evaluation::TruthEvaluation& truth);

}  // namespace waymark::report
