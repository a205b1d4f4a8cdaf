/// Where the optimisation starts: the paper's dead reckoning, or a start anchored to the GNSS fixes.
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
  anchored,       ///< fixes anchor place and heading, the winding comes from the odometry (default)
  dead_reckoning  ///< the paper's: integrate from the first fix and the heading of the first chord
};

struct StartOptions {
  StartMethod method = StartMethod::anchored;
  /// Heading of the first pose: the start is turned about that pose to have it. Empty: as it comes out.
  std::optional<double> first_heading_rad{};

  friend bool operator==(const StartOptions&, const StartOptions&) = default;
};

/// Initial poses and how they came about.
struct Start {
  std::vector<Eigen::Vector3d> poses;  ///< of all nodes: x, y [m, frame], heading [rad] in (-pi, pi]
  double gyro_bias_radps = 0;          ///< bias taken off the yaw rate (0 for dead reckoning)
  std::size_t windows = 0;             ///< alignments behind the heading (0: a fallback was used, see note)
  std::string note;                    ///< what could not be had from the data; empty where all was well
};

/// The paper's start: odometry integrated from the first accepted fix. The heading is that fix's course where
/// it has one and the vehicle moves, else that of the first chord between accepted fixes of at least 10 m.
/// @param timeline       nodes; fix_node parallel to `fixes`
/// @param fixes          accepted ones are used
/// @param antenna_m      antenna in the body frame (x forward, y left)
/// @param standstill_mps below it an interval is the identity, as in the odometry edges
/// @throws InputError where no fix is accepted.
[[nodiscard]] Start dead_reckoning_start(const Timeline& timeline, std::span<const Fix> fixes,
                                         const Eigen::Vector2d& antenna_m, double standstill_mps);

/// The default start. Dead reckoning, its gyro bias removed, is bent slowly so that it lies on the fixes:
/// windows of it are aligned rigidly and robustly to the accepted fixes, and the heading offset between
/// neighbouring windows is taken as the small one, so that windings come from the odometry alone. Neither a
/// wrong first heading nor drift by many turns matters. The method is described in tools/drive/README.md,
/// section "The start". O(n log n); deterministic. Parameters and errors as dead_reckoning_start.
[[nodiscard]] Start anchored_start(const Timeline& timeline, std::span<const Fix> fixes,
                                   const Eigen::Vector2d& antenna_m, double standstill_mps);

/// The start that the options ask for.
[[nodiscard]] Start make_start(const Timeline& timeline, std::span<const Fix> fixes,
                               const Eigen::Vector2d& antenna_m, double standstill_mps,
                               const StartOptions& options);

}  // namespace waymark::drive
