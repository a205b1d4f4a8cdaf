/// What else could be said of withheld fixes than the fused poses say: odometry alone, and the past alone.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include <waymark/formats/graph_document.hpp>
#include <waymark/tools/drive/prepare.hpp>

namespace waymark {

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
[[nodiscard]] PosesAtWithheld dead_reckoned_at_withheld(const GraphDocument& document);

/// A drive cut off at the end of an outage.
struct KnownDrive {
  PreparedDrive drive;    ///< no fix later than the outage, odometry to its end, no truth
  std::size_t begin = 0;  ///< fixes [begin, end) of `drive` are those of the outage, withheld
  std::size_t end = 0;    ///< number of fixes
};

/// The drive as it was known at the end of each run of withheld fixes. Fixes withheld before stay withheld;
/// the odometry and other sensors end with the first reading at or after the last withheld fix. Runs before
/// which every fix was withheld are left out.
[[nodiscard]] std::vector<KnownDrive> known_at_outages(const PreparedDrive& drive);

/// Builds the graph of a drive and optimises it; nothing where that cannot be done. Document fixes are those
/// of the drive, in their order; covariances of poses are used where it has them.
using FuseDrive = std::function<std::optional<GraphDocument>(const PreparedDrive& known)>;

/// What a vehicle would have known on its way: for each run of withheld fixes the drive is fused from nothing
/// but what came before the run's end, and no fix of the run. One call of `fuse` per run; empty where it gave
/// nothing.
/// @throws UsageError for a document with other fixes; what `fuse` throws.
[[nodiscard]] PosesAtWithheld causal_at_withheld(const PreparedDrive& drive, const FuseDrive& fuse);

}  // namespace waymark
