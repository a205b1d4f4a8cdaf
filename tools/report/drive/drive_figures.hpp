/// The figures of a drive report. Each says in its caption how it is formed; all over time are linked.
#pragma once

#include <optional>
#include <vector>

#include <waymark/tools/drawing/figure/figure.hpp>
#include <waymark/tools/drawing/figure/view.hpp>
#include <waymark/tools/report/drive/drive_report.hpp>

namespace waymark::report {

/// From the first fix to the last, seconds since the start: what all figures over time show.
[[nodiscard]] drawing::Range epochs_extent(const ReportedDrive& drive);

/// Accepted fixes that a loss leaves less than a third of their weight; 0 where the residuals are not known.
[[nodiscard]] std::size_t nearly_left_out(const ReportedDrive& drive);

/// Poses, raw fixes with what became of them, truth; east and north on the grid.
[[nodiscard]] drawing::Figure trajectory_figure(const ReportedDrive& drive);

/// The paper's tile: errors on a plane of 2 x 2 m about the truth with their mean and one-sigma ellipse;
/// wider where most errors lie outside. Raw and fused at one scale.
[[nodiscard]] drawing::FigureRow error_tiles(const ReportedDrive& drive);

/// Position error, along and across the direction of travel, heading error, speed; rejected spans.
[[nodiscard]] std::vector<drawing::Figure> errors_over_time(const ReportedDrive& drive);

/// Share of epochs with an error below x; CEP50 and CEP95.
[[nodiscard]] drawing::Figure error_distribution(const ReportedDrive& drive);

/// Autocorrelation of the errors, raw and fused, up to 2 min or a quarter of the drive.
[[nodiscard]] drawing::Figure autocorrelation_figure(const ReportedDrive& drive);

/// What was stated against what was: by sigma, over time, and as shares. Empty without covariances.
[[nodiscard]] std::vector<drawing::Figure> consistency_figures(const ReportedDrive& drive);

/// Fix minus fused antenna over time, east and north: all that a drive without truth can show of errors.
[[nodiscard]] drawing::Figure fix_residuals_over_time(const ReportedDrive& drive);

}  // namespace waymark::report
