/// The sections of a drive report about measurements by group: by satellite, by anchor.
#pragma once

#include <vector>

#include <waymark/tools/drawing/page/page.hpp>
#include <waymark/tools/report/drive/drive_report.hpp>

namespace waymark::report {

/// Points of all groups together that the figures over time of one source draw: few enough for a page,
/// whatever the length of the drive.
inline constexpr std::size_t kMostGroupPoints = 20'000;

/// Returns a section for each source with groups: a table, the sky, residuals and signals over time.
[[nodiscard]] std::vector<drawing::Section> group_sections(const ReportedDrive& drive);

}  // namespace waymark::report
