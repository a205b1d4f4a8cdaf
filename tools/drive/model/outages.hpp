/// What else could be said of withheld fixes than the fused poses say: odometry alone, and the past alone.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include <waymark/formats/graph/graph_document.hpp>
#include <waymark/tools/drive/logs/prepare.hpp>

namespace waymark::drive {

/// Poses (x, y [m, frame], heading [rad]) at the withheld fixes of a drive.
struct PosesAtWithheld {
  std::vector<std::optional<Eigen::Vector3d>> poses;  ///< one per fix; empty at fixes that are not withheld
  /// Of their positions, m^2, frame axes; one per fix, or empty where none are known.
  std::vector<std::optional<Eigen::Matrix2d>> position_covariances;
};

/// Odometry alone: the pose that the graph's odometry, uncalibrated (its calibration states at zero), leads
/// to from the optimised pose of the last accepted fix before. Empty before the first accepted fix, and where
/// no chain of odometry edges leads on.
///
/// An odometry edge is a relative one of form "log" from a pose to the next in time; its error where all
/// states are zero is the negative of its measured motion. Fixes must be in order of time, as a drive's are.
[[nodiscard]] PosesAtWithheld dead_reckoned_at_withheld(const formats::GraphDocument& document);

/// Fixes [begin, end) of a drive, all withheld, with none withheld beside them.
struct WithheldRun {
  std::size_t begin = 0;
  std::size_t end = 0;
};

/// The runs of withheld fixes, in order.
[[nodiscard]] std::vector<WithheldRun> withheld_runs(std::span<const Fix> fixes);

/// The drive as it was known at its fix number end - 1: no later fix, the odometry to its first reading at or
/// after that fix, other sensors up to it, no truth. What is withheld stays so.
[[nodiscard]] PreparedDrive known_until(const PreparedDrive& drive, std::size_t end);

/// Builds the graph of a drive and optimises it; nothing where that cannot be done. Document fixes are those
/// of the drive, in their order; covariances of poses are used where it has them.
using FuseDrive = std::function<std::optional<formats::GraphDocument>(const PreparedDrive& known)>;

/// What a vehicle would have known on its way: for each run of withheld fixes the drive is fused from nothing
/// but known_until its end. One call of `fuse` per run, none for a run with no fix before it; empty where it
/// gave nothing.
/// @throws UsageError for a document with other fixes; what `fuse` throws.
[[nodiscard]] PosesAtWithheld causal_at_withheld(const PreparedDrive& drive, const FuseDrive& fuse);

}  // namespace waymark::drive
