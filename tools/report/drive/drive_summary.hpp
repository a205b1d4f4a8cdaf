/// The first part of a drive report: inputs, assumptions, rejected fixes and results.
#pragma once

#include <waymark/tools/drawing/page/page.hpp>
#include <waymark/tools/report/drive/drive_report.hpp>

namespace waymark::report {

/// Writes the sentences at the top of the page. They say whether the fused positions are better or
/// worse than raw GNSS.
void summarise(const ReportedDrive& drive, drawing::Page& page);

/// Returns metrics, errors at withheld fixes, and the account of the drive.
[[nodiscard]] drawing::Section summary_section(const ReportedDrive& drive);

/// Returns the errors along and across the direction of travel, and of the heading.
[[nodiscard]] text::Table track_table(const evaluation::TruthEvaluation& truth);

}  // namespace waymark::report
