/// Figures of the pages of the paper's experiment, the ablation and the consistency study.
#pragma once

#include <vector>

#include <waymark/tools/drawing/figure/figure.hpp>
#include <waymark/tools/reproduction/experiment/drive_result.hpp>

namespace waymark::reproduction {

/// Shows Max, Acc and Prec of every drive with truth: raw, g1, g2, g3 and the default model. On a
/// drive of the paper, its own numbers are added.
[[nodiscard]] std::vector<drawing::Figure> paper_error_figures(const std::vector<DriveResult>& drives);
/// Shows NEES and coverage for every drive and evaluated setting of ours.
[[nodiscard]] std::vector<drawing::Figure> stated_error_figures(const std::vector<DriveResult>& drives);
/// Shows errors at withheld fixes for drives without truth, one figure for each way of withholding.
[[nodiscard]] std::vector<drawing::Figure> withheld_figures(const std::vector<DriveResult>& drives);
/// Shows the RMS error and the mean NEES of each setting of the ablation, with the spread
/// over the drives.
[[nodiscard]] std::vector<drawing::Figure> ablation_figures(const std::vector<DriveResult>& drives);
/// Shows NEES and coverage of every drawn drive, with the range for consistent covariances.
[[nodiscard]] std::vector<drawing::Figure> consistency_figures(const std::vector<DriveResult>& drives);

}  // namespace waymark::reproduction
