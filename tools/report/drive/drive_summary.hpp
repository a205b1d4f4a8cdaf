/// The first part of a drive report: inputs, assumptions, rejected fixes and results.
#pragma once

#include <vector>

#include <waymark/tools/drawing/page/page.hpp>
#include <waymark/tools/report/drive/drive_report.hpp>

namespace waymark::report {

/// Returns the metrics against truth and at fixes that the fusion did not know.
[[nodiscard]] std::vector<drawing::PageBlock> metric_tables(const ReportedDrive& drive);

/// Returns the warnings, a sentence each; without blocks if there are none.
[[nodiscard]] drawing::Section warning_section(const ReportedDrive& drive);

/// Returns the account of the drive: inputs, error model, rejected fixes, result. Assumptions and
/// hashes are folded away.
[[nodiscard]] drawing::Section summary_section(const ReportedDrive& drive);

/// Returns the errors of the motion over 10, 100 and 1000 m; distances that the drive does not
/// reach are left out.
[[nodiscard]] text::Table relative_table(const evaluation::TruthEvaluation& truth);

/// Returns the errors along and across the direction of travel, and of the heading.
[[nodiscard]] text::Table track_table(const evaluation::TruthEvaluation& truth);

}  // namespace waymark::report
