/// The figures of a drive report. Each caption says how the figure is computed. All figures over
/// time are linked.
#pragma once

#include <optional>
#include <vector>

#include <waymark/tools/drawing/figure/figure.hpp>
#include <waymark/tools/drawing/figure/view.hpp>
#include <waymark/tools/report/drive/drive_report.hpp>
#include <waymark/tools/text/table.hpp>

namespace waymark::report {

/// Returns the extent of all figures over time: from the first fix to the last, in seconds
/// since the start.
[[nodiscard]] drawing::Range epochs_extent(const ReportedDrive& drive);

/// Counts accepted fixes to which a loss leaves less than a third of their weight; 0 if the
/// residuals are not known.
[[nodiscard]] std::size_t nearly_left_out(const ReportedDrive& drive);

/// Shows poses, raw fixes with their status, and truth, east and north on the grid.
[[nodiscard]] drawing::Figure trajectory_figure(const ReportedDrive& drive);

/// The tile of the paper: errors on a plane of 2 x 2 m about the truth, with their mean and
/// one-sigma ellipse. The plane is wider if most errors are outside. Raw and fused errors have
/// the same scale.
[[nodiscard]] drawing::FigureRow error_tiles(const ReportedDrive& drive);

/// Shows the position error: its length, east and north with the stated sigmas, along and across
/// the direction of travel; the heading error and the speed, with rejected spans.
[[nodiscard]] std::vector<drawing::Figure> errors_over_time(const ReportedDrive& drive);

/// Shows the share of epochs with an error below x, with CEP50 and CEP95.
[[nodiscard]] drawing::Figure error_distribution(const ReportedDrive& drive);

/// Shows the autocorrelation of raw and fused errors, up to 2 min or a quarter of the drive.
[[nodiscard]] drawing::Figure autocorrelation_figure(const ReportedDrive& drive);

/// Compares stated with actual errors: by sigma, over time, and as shares. Empty without
/// covariances.
[[nodiscard]] std::vector<drawing::Figure> consistency_figures(const ReportedDrive& drive);

/// Shows the stated sigmas of position and heading over time, and the NIS of the fixes. Figures
/// without data are left out.
[[nodiscard]] std::vector<drawing::Figure> sigmas_over_time(const ReportedDrive& drive);

/// Shows the distance of the fixes from the fused antenna over time. If fixes were kept out of a
/// second fusion, it shows their distance from that too.
[[nodiscard]] drawing::Figure fix_residuals_over_time(const ReportedDrive& drive);

/// Shows quality, satellites and HDOP of the fixes, as far as the receivers tell them.
[[nodiscard]] std::vector<drawing::Figure> receiver_figures(const ReportedDrive& drive);

/// Returns the ten worst stretches with times and reasons: by the error with truth, by the stated
/// sigma without.
[[nodiscard]] text::Table weak_table(const ReportedDrive& drive);

}  // namespace waymark::report
