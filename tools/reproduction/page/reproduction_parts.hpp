/// Figures of the pages of the paper's experiment, the ablation and the consistency study.
#pragma once

#include <vector>

#include <waymark/tools/drawing/figure/figure.hpp>
#include <waymark/tools/reproduction/experiment/drive_result.hpp>

namespace waymark::reproduction {

/// Max, Acc and Prec of every drive with truth: raw, g1, g2, g3 and the default model, with the paper's own
/// numbers where the drive is one of its.
[[nodiscard]] std::vector<drawing::Figure> paper_error_figures(const std::vector<DriveResult>& drives);
/// NEES and coverage of every drive and evaluated setting of ours.
[[nodiscard]] std::vector<drawing::Figure> stated_error_figures(const std::vector<DriveResult>& drives);
/// Errors at withheld fixes of drives without truth, a figure for each way of keeping fixes out.
[[nodiscard]] std::vector<drawing::Figure> withheld_figures(const std::vector<DriveResult>& drives);
/// RMS error and mean NEES of each setting of the ablation with the spread over the drives.
[[nodiscard]] std::vector<drawing::Figure> ablation_figures(const std::vector<DriveResult>& drives);
/// NEES and coverage of every drawn drive with what an honest covariance may show.
[[nodiscard]] std::vector<drawing::Figure> consistency_figures(const std::vector<DriveResult>& drives);

}  // namespace waymark::reproduction
