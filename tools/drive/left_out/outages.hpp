/// Other predictions of withheld fixes than the fused poses: odometry alone, and the past alone.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include <waymark/core/drive/modeling.hpp>
#include <waymark/formats/graph/graph_document.hpp>
#include <waymark/tools/drive/logs/prepare.hpp>
#include <waymark/types_se2/stamped_pose.hpp>

namespace waymark::drive {

/// Poses (x, y [m, frame], heading [rad]) at the withheld fixes of a drive.
struct PosesAtWithheld {
  /// one per fix; empty at fixes that are not withheld
  std::vector<std::optional<Eigen::Vector3d>> poses;
  /// Covariances of the positions, m^2, frame axes; one per fix, or empty if none are known.
  std::vector<std::optional<Eigen::Matrix2d>> position_covariances;
};

/// Predicts with odometry alone. From the optimised pose of the last accepted fix it follows the
/// odometry of the graph, uncalibrated (its calibration states are zero). Empty before the first
/// accepted fix, and if the chain of odometry edges is interrupted.
///
/// An odometry edge is a relative edge of form "log" from a pose to the next one in time. If all
/// states are zero, its error is the negative of its measured motion. Fixes must be in order of
/// time, as those of a drive are.
[[nodiscard]] PosesAtWithheld dead_reckoned_at_withheld(const formats::GraphDocument& document);

/// Returns the drive by odometry alone, uncalibrated as above: from the fused pose at the first
/// accepted fix (without one: the first pose) as far as the chain of odometry edges reaches. Empty
/// without odometry.
[[nodiscard]] std::vector<StampedPose> dead_reckoned(const formats::GraphDocument& document);

/// Predicts what the receiver will say, not where the vehicle is: the poses of the minimum, moved by the
/// errors that the modeling expects of these fixes. Without poses if it expects none, as for white
/// noise.
/// @param document at its minimum
/// @param modelings that built its graph, one for each absolute source
[[nodiscard]] PosesAtWithheld with_lasting_errors(
    const formats::GraphDocument& document,
    const std::vector<std::shared_ptr<const GnssModeling>>& modelings);

/// Fixes [begin, end) of a drive, all withheld, between fixes that are not withheld.
struct WithheldRun {
  std::size_t begin = 0;
  std::size_t end = 0;
};

/// Returns the runs of withheld fixes, in order.
[[nodiscard]] std::vector<WithheldRun> withheld_runs(std::span<const Fix> fixes);

/// Returns the drive as it was known at its fix number end - 1: without later fixes, with the
/// odometry up to its first reading at or after that fix, with other sensors up to it, and without
/// truth. Withheld fixes stay withheld.
[[nodiscard]] PreparedDrive known_until(const PreparedDrive& drive, std::size_t end);

/// Builds the graph of a drive and optimises it. Returns nothing if that is impossible. The
/// fixes of the document are those of the drive, in their order. If it has covariances of poses,
/// they are used.
using FuseDrive = std::function<std::optional<formats::GraphDocument>(const PreparedDrive& known)>;

/// Predicts what a vehicle would have known on its way. For each run of withheld fixes the drive is
/// fused only from known_until its end. `fuse` is called once per run, but not for a run with no
/// fix before it. The prediction is empty if `fuse` returns nothing.
/// @throws UsageError for a document with other fixes; errors of `fuse`
[[nodiscard]] PosesAtWithheld causal_at_withheld(const PreparedDrive& drive, const FuseDrive& fuse);

}  // namespace waymark::drive
