/// The building blocks of anchored_start (tools/drive/README.md, section "The start"): rigid, robust
/// alignment of stretches of dead reckoning to fixes. Internal to tools/drive; exposed so that each can be
/// tested alone.
///
/// "Moving time" [s] counts only intervals in which the vehicle moves: at standstill the odometry edge is the
/// identity, so neither heading nor position can go astray there, and a stop of ten minutes is no distance.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include <waymark/core/drive/sample.hpp>
#include <waymark/tools/drive/nodes/timeline.hpp>

namespace waymark::drive::start_detail {

/// Where GNSS says that the antenna was. The fixes of one stop are one anchor (their componentwise median):
/// their errors are strongly correlated, and none of them tells anything new about the heading.
struct Anchor {
  double moving_s = 0;
  std::size_t node = 0;
  Eigen::Vector2d gnss = Eigen::Vector2d::Zero();
};

/// The rotation that lays points on others, with what it is worth.
struct Alignment {
  double rotation_rad = 0;
  double spread_m = 0;    ///< rms distance of the source points from their centroid
  double residual_m = 0;  ///< median distance after the alignment
};

/// Heading offset (frame minus dead reckoning) of one stretch of the drive.
struct HeadingWindow {
  double moving_s = 0;    ///< middle
  double offset_rad = 0;  ///< in (-pi, pi] until unwrap_offsets
  double weight = 0;      ///< inverse variance up to a factor
};

/// Piecewise linear function with increasing abscissae, constant outside.
struct Knots {
  std::vector<double> at;
  std::vector<double> value;
};

/// Moving time of every node.
[[nodiscard]] std::vector<double> moving_time(const Timeline& timeline, double standstill_mps);
/// Anchors of the accepted fixes, strictly increasing in moving time.
[[nodiscard]] std::vector<Anchor> collect_anchors(const Timeline& timeline, std::span<const Fix> fixes,
                                                  std::span<const double> moving_s);
/// Median yaw rate at standstill; empty with less than 5 s of it.
[[nodiscard]] std::optional<double> standstill_bias(const Timeline& timeline, double standstill_mps);
/// Poses from (0, 0): the intervals' lengths along given (unwrapped) headings of all nodes, exact arcs.
[[nodiscard]] std::vector<Eigen::Vector3d> integrate_along(const Timeline& timeline,
                                                           std::span<const double> headings,
                                                           double standstill_mps);
/// Least sum of distances (iteratively reweighted), so that less than half of wild points do not matter.
/// Empty for fewer than two points or points without spread.
[[nodiscard]] std::optional<Alignment> align_robustly(std::span<const Eigen::Vector2d> from,
                                                      std::span<const Eigen::Vector2d> to);
/// Alignments in windows of 40 s moving time, step 10 s (longer where fixes are rare). Windows with too few
/// anchors, a spread under 15 m, or residuals that deny a rigid motion are skipped.
[[nodiscard]] std::vector<HeadingWindow> align_windows(std::span<const Anchor> anchors,
                                                       std::span<const Eigen::Vector3d> poses,
                                                       const Eigen::Vector2d& antenna_m);
/// Weighted median of the slopes between windows at most `apart_s` from each other, rad/s; 0 for none.
[[nodiscard]] double median_slope(std::span<const HeadingWindow> windows, double apart_s);
/// Chooses the turns of the offsets: from the window of greatest weight both ways, each the nearest to the
/// median of those before it, so that one bad window cannot change the winding of the rest.
void unwrap_offsets(std::span<HeadingWindow> windows);
/// Weighted median of five windows each, as knots over moving time.
[[nodiscard]] Knots smooth_offsets(std::span<const HeadingWindow> windows);
/// Value at each of the sorted `at`.
[[nodiscard]] std::vector<double> evaluate(const Knots& knots, std::span<const double> at);
/// Median by weight; `items` are (value, weight) and are reordered. 0 for none.
[[nodiscard]] double weighted_median(std::vector<std::pair<double, double>>& items);
/// Median (upper of the two middle ones); reorders. 0 for none.
[[nodiscard]] double median(std::vector<double>& values);

}  // namespace waymark::drive::start_detail
