/// The building blocks of anchored_start (tools/drive/README.md, section "The start"): rigid,
/// robust alignment of stretches of dead reckoning to fixes. They are internal to tools/drive, and
/// exposed so that each can be tested alone.
///
/// "Moving time" [s] counts only intervals in which the vehicle moves. At standstill the odometry
/// edge is the identity, so neither heading nor position can drift, and a stop of ten minutes is
/// no distance.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include <waymark/core/drive/sample.hpp>
#include <waymark/tools/drive/nodes/timeline.hpp>

namespace waymark::drive::start_detail {

/// A position of the antenna by GNSS. The fixes of one stop are one anchor (their componentwise
/// median), because their errors are strongly correlated and none of them adds information about
/// the heading.
struct Anchor {
  double moving_s = 0;
  std::size_t node = 0;
  Eigen::Vector2d gnss = Eigen::Vector2d::Zero();
  Eigen::Vector2d antenna_m = Eigen::Vector2d::Zero();  ///< body frame
};

/// The rotation that aligns points with others, and its quality.
struct Alignment {
  double rotation_rad = 0;
  double spread_m = 0;    ///< rms distance of the source points from their centroid
  double residual_m = 0;  ///< median distance after the alignment
};

/// Heading offset (frame minus dead reckoning) of one stretch of the drive.
struct HeadingWindow {
  double moving_s = 0;    ///< the middle of its anchors
  double offset_rad = 0;  ///< in (-pi, pi] before unwrap_offsets
  double weight = 0;      ///< inverse variance except for a factor
};

/// Which windows are aligned, and how they are joined.
struct Windows {
  double length_s = 40;  ///< of moving time; longer if fixes are rare
  double step_s = 10;    ///< of moving time, from one to the next
  double least_spread_m = 15;
  std::size_t before = 5;  ///< whole turns are those of so many windows before
  std::size_t beside = 2;  ///< so many on either side smooth an offset
  int bends = 2;           ///< a bend works on what the one before has straightened
};

/// A piecewise linear function with increasing abscissae; it is constant outside.
struct Knots {
  std::vector<double> at;
  std::vector<double> value;
};

/// Returns the moving time of every node.
[[nodiscard]] std::vector<double> moving_time(const Timeline& timeline, double standstill_mps);
/// Returns the anchors of the accepted fixes, strictly increasing in moving time.
[[nodiscard]] std::vector<Anchor> collect_anchors(const Timeline& timeline, std::span<const Fix> fixes,
                                                  std::span<const double> moving_s);
/// Returns the median yaw rate at standstill. Empty with less than 5 s of standstill.
[[nodiscard]] std::optional<double> standstill_bias(const Timeline& timeline, double standstill_mps);
/// Returns poses from (0, 0): exact arcs with the lengths of the intervals, along given (unwrapped)
/// headings of all nodes.
[[nodiscard]] std::vector<Eigen::Vector3d> integrate_along(const Timeline& timeline,
                                                           std::span<const double> headings,
                                                           double standstill_mps);
/// Minimises the sum of distances (iteratively reweighted), so less than half of wild points do not
/// matter. Empty for fewer than two points, or points without spread.
[[nodiscard]] std::optional<Alignment> align_robustly(std::span<const Eigen::Vector2d> from,
                                                      std::span<const Eigen::Vector2d> to);
/// Returns alignments in windows. A window is skipped if it has too few anchors or too small a spread, or
/// residuals that contradict a rigid motion.
[[nodiscard]] std::vector<HeadingWindow> align_windows(std::span<const Anchor> anchors,
                                                       std::span<const Eigen::Vector3d> poses,
                                                       const Windows& how = {});
/// Returns the weighted median of the slopes between windows at most `apart_s` apart, rad/s; 0 if
/// there are none.
[[nodiscard]] double median_slope(std::span<const HeadingWindow> windows, double apart_s);
/// Chooses the full turns of the offsets, from the window of greatest weight in both directions.
/// Each offset becomes the nearest to the median of those before it, so that one bad window cannot
/// change the winding of the rest.
void unwrap_offsets(std::span<HeadingWindow> windows, const Windows& how = {});
/// Returns weighted medians of windows beside each other, as knots over moving time.
[[nodiscard]] Knots smooth_offsets(std::span<const HeadingWindow> windows, const Windows& how = {});
/// Returns the value at each of the sorted `at`.
[[nodiscard]] std::vector<double> evaluate(const Knots& knots, std::span<const double> at);
/// Returns the median by weight. `items` are (value, weight) and are reordered. 0 if
/// there are none.
[[nodiscard]] double weighted_median(std::vector<std::pair<double, double>>& items);

}  // namespace waymark::drive::start_detail
