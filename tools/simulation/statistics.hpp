/// What the logs of a drive are like, real or simulated: counts, errors of the fixes, drift of the odometry.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <Eigen/Core>

#include <waymark/core/drive/stamp.hpp>
#include <waymark/tools/drive/logs/prepare.hpp>
#include <waymark/tools/drive/nodes/gate.hpp>
#include <waymark/tools/evaluation/numbers/autocorrelation.hpp>
#include <waymark/tools/evaluation/numbers/metrics.hpp>

namespace waymark::simulation {

/// Drift of dead reckoning, over all pieces of `piece_m` of way: they start every `start_every_m`; each is
/// laid onto the truth by position and heading at its start, and drifts by the distance at its end over its
/// length.
struct DriftOptions {
  double piece_m = 1000;
  double start_every_m = 100;
};

struct DriveStatistics {
  double duration_s = 0;
  double distance_m = evaluation::kUndefined;  ///< of the truth
  std::size_t odometry_points = 0;
  std::size_t fixes = 0;
  std::size_t missing_epochs = 0;    ///< whole median intervals between fixes without one
  evaluation::PositionMetrics gnss;  ///< of the raw fixes against truth
  std::size_t rejected = 0;          ///< by the gate with the drive's options
  double rejected_percent = 0;
  std::vector<double> autocorrelation;  ///< of the fixes' error, at kAutocorrelationLags
  double drift_percent =
      evaluation::kUndefined;  ///< mean over the pieces, see DriftOptions; NaN below one piece
  double yaw_drift_deg_per_minute =
      evaluation::kUndefined;  ///< median size of what the odometry's heading gains on the
                               ///< truth's in a minute
};

/// Mean drift over the pieces (DriftOptions), 0.011 for 1.1 %; NaN where none fits.
/// @param odometry, truth poses (x, y, heading not wrapped or wrapped alike) at the same instants; grid
/// metres
[[nodiscard]] double mean_drift(std::span<const Eigen::Vector3d> odometry,
                                std::span<const Eigen::Vector3d> truth, const DriftOptions& options = {});

/// Without truth all that needs one is NaN.
[[nodiscard]] DriveStatistics drive_statistics(const drive::PreparedDrive& drive,
                                               const drive::GateOptions& gate);

}  // namespace waymark::simulation
