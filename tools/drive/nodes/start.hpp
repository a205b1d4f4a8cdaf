/// The initial guess of the optimisation: the dead reckoning of the paper, or a start anchored to
/// the GNSS fixes.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <waymark/core/drive/sample.hpp>
#include <waymark/tools/drive/nodes/timeline.hpp>

namespace waymark::drive {

enum class StartMethod {
  anchored,       ///< fixes anchor place and heading, the odometry gives the winding (default)
  dead_reckoning  ///< the paper's: integrate from the first fix and the heading of the first chord
};

struct StartOptions {
  StartMethod method = StartMethod::anchored;
  /// Heading of the first pose. The initial guess is turned about that pose to have it.
  /// Empty: no turn.
  std::optional<double> first_heading_rad{};

  friend bool operator==(const StartOptions&, const StartOptions&) = default;
};

/// The initial poses, and facts about their computation.
struct Start {
  /// of all nodes: x, y [m, frame], heading [rad] in (-pi, pi]
  std::vector<Eigen::Vector3d> poses;
  /// bias that was subtracted from the yaw rate (0 for dead reckoning)
  double gyro_bias_radps = 0;
  /// alignments that the heading is based on (0: a fallback was used, see note)
  std::size_t windows = 0;
  bool follows_fixes = false;  ///< that of start_along_fixes(): the odometry may be worth nothing
  std::string note;            ///< facts that the data could not provide; empty if there are none
};

/// The initial guess of the paper: odometry integrated from the first accepted fix. The heading is
/// the course of that fix if it has one and the vehicle moves. Otherwise it is that of the first
/// chord between accepted fixes of at least 10 m.
/// @param timeline nodes; fix_node parallel to `fixes`
/// @param fixes accepted ones are used
/// @param standstill_mps at a lower speed an interval is the identity, as in the odometry edges
/// @throws InputError if no fix is accepted
[[nodiscard]] Start dead_reckoning_start(const Timeline& timeline, std::span<const Fix> fixes,
                                         double standstill_mps);

/// The default initial guess. It removes the gyro bias from dead reckoning, and bends it slowly so
/// that it lies on the fixes. For that, windows of it are aligned rigidly and robustly to the
/// accepted fixes. The heading offset between adjacent windows is taken as the small one, so
/// windings come from the odometry alone. Neither a wrong first heading nor a drift by many turns
/// matters. tools/drive/README.md, section "The start", describes the method. O(n log n);
/// deterministic. Parameters and errors are those of dead_reckoning_start.
[[nodiscard]] Start anchored_start(const Timeline& timeline, std::span<const Fix> fixes,
                                   double standstill_mps);

/// As anchored_start, for an odometry that may not turn as the vehicle does: windows of 8 s, so that headings
/// follow the fixes from one to the next, and the odometry only between them. With a sound odometry it is the
/// worse one, because each heading has the errors of a few fixes.
[[nodiscard]] Start start_along_fixes(const Timeline& timeline, std::span<const Fix> fixes,
                                      double standstill_mps);

/// Returns the initial guess that the options choose.
[[nodiscard]] Start make_start(const Timeline& timeline, std::span<const Fix> fixes, double standstill_mps,
                               const StartOptions& options);

}  // namespace waymark::drive
