/// What a live run of a drive would have said, for windows of several lengths: the loss of accuracy over the
/// lag, as Merfels and Stachniss (IROS 2016) show it.
#pragma once

#include <functional>
#include <limits>
#include <span>
#include <vector>

#include <waymark/core/registry/registry.hpp>
#include <waymark/tools/drive/description/drive_file.hpp>
#include <waymark/tools/drive/logs/prepare.hpp>

namespace waymark::live {

/// Errors against the truth, m, in the place of its reference point.
struct LagErrors {
  std::size_t poses = 0;
  double rmse_m = 0;
  double max_m = 0;
  double inside95 = 0;  ///< share of the poses whose truth lies in their region of 95 %; live poses only
  /// in three dimensions, of the poses with a height and a height of the truth; live poses only; NaN: there are none
  double rmse_3d_m = std::numeric_limits<double>::quiet_NaN();
  double nees = 0;  ///< mean squared normalised error, 2 freedoms; live poses only
};

struct LagResult {
  double window_s = 0;
  LagErrors live;       ///< what was said at that time
  LagErrors settled;    ///< what was said when the pose left the window
  double cycle_us = 0;  ///< median time of a solution, with what belongs to it
};

/// Replays the logs of a drive through the estimator, once for each window.
/// @param settings as stated; the noise is that of the drive so far, unless it is stated
/// @param drive the prepared one: its frame and its truth
/// @param begun called before each window; it may throw to stop
/// @throws UsageError if the drive cannot be live
[[nodiscard]] std::vector<LagResult> study_lags(const drive::DriveFile& file,
                                                const drive::FusionSettings& settings,
                                                const drive::PreparedDrive& drive,
                                                std::span<const double> windows_s,
                                                const TypeRegistry& registry,
                                                const std::function<void(double window_s)>& begun = {});

}  // namespace waymark::live
