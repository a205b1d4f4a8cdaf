/// What a drive report says first: what went in, what was assumed, what was rejected, what came out.
#pragma once

#include <waymark/tools/report/drive_report.hpp>
#include <waymark/tools/report/page.hpp>

namespace waymark {

/// The sentences at the top of the page, and whether the fused positions are better or worse than raw GNSS.
void summarise(const ReportedDrive& drive, Page& page);

/// Metrics, errors at withheld fixes, and the account of the drive.
[[nodiscard]] Section summary_section(const ReportedDrive& drive);

/// Errors along and across the direction of travel, and of the heading.
[[nodiscard]] PageTable track_table(const TruthEvaluation& truth);

}  // namespace waymark
