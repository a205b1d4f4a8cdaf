/// Statistics of a drive, real or simulated: counts, errors of the fixes, drift of the odometry.
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

/// The drift of dead reckoning, over pieces of `piece_m` of distance. A piece starts every
/// `start_every_m`. Each is aligned with the truth by position and heading at its start. Its drift
/// is the distance at its end over its length.
struct DriftOptions {
  double piece_m = 1000;
  double start_every_m = 100;
};

struct DriveStatistics {
  double duration_s = 0;
  double distance_m = evaluation::kUndefined;  ///< of the truth
  std::size_t odometry_points = 0;
  std::size_t fixes = 0;
  std::size_t missing_epochs = 0;    ///< whole median intervals without a fix
  evaluation::PositionMetrics gnss;  ///< of the raw fixes against truth
  std::size_t rejected = 0;          ///< by the gate, with the options of the drive
  double rejected_percent = 0;
  std::vector<double> autocorrelation;  ///< of the errors of the fixes, at kAutocorrelationLags
  double drift_percent =
      evaluation::kUndefined;  ///< mean over the pieces, see DriftOptions; NaN if there is no piece
  /// median over one-minute windows of |heading change of odometry - of truth|
  double yaw_drift_deg_per_minute = evaluation::kUndefined;
};

/// Returns the mean drift over the pieces (DriftOptions), 0.011 for 1.1 %; NaN if no piece fits.
/// @param odometry, truth poses (x, y, heading) at the same instants, in grid metres; headings are
/// both wrapped or both not
[[nodiscard]] double mean_drift(std::span<const Eigen::Vector3d> odometry,
                                std::span<const Eigen::Vector3d> truth, const DriftOptions& options = {});

/// Without truth, all numbers that need it are NaN.
[[nodiscard]] DriveStatistics drive_statistics(const drive::PreparedDrive& drive,
                                               const drive::GateOptions& gate);

}  // namespace waymark::simulation
