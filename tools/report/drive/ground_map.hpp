/// A map beneath the trajectory: the ways near the drive, few enough for a page.
#pragma once

#include <cstdint>
#include <string>
#include <unordered_set>
#include <vector>

#include <Eigen/Core>

#include <waymark/tools/drawing/figure/figure.hpp>

namespace waymark::report {

/// Collects ways and keeps what is near a drive, so that a map of a whole country costs no more than
/// the way that was driven. O(points of the drive and of the ways).
class GroundMap {
 public:
  /// Ways are kept up to this distance from the drive, and up to 1.5 times as far.
  static constexpr double kNear_m = 400;
  /// Of all ways together; about 0.6 MB of a page.
  static constexpr std::size_t kMostPoints = 40'000;

  /// @param track positions along the drive, m
  explicit GroundMap(const std::vector<Eigen::Vector2d>& track);

  /// Adds a road. Parts of it that are not near are cut off. @param points m, at least two
  void add_road(const std::vector<Eigen::Vector2d>& points);
  /// Adds a building if a corner of it is near. @param ring m, at least three points
  void add_building(const std::vector<Eigen::Vector2d>& ring);
  [[nodiscard]] bool empty() const { return roads_.empty() && buildings_.empty(); }

  /// Returns the ways as series "roads" and "buildings" of a map, buildings first. Points less than
  /// a tolerance from the last one are left out; the tolerance is doubled from 0.25 m up to 16 m until
  /// at most kMostPoints remain. If there are still more, the largest ways are kept.
  [[nodiscard]] std::vector<drawing::Series> series() const;

 private:
  using Line = std::vector<Eigen::Vector2d>;

  [[nodiscard]] bool is_near(const Eigen::Vector2d& point) const;

  std::unordered_set<std::int64_t> cells_;  ///< squares of kNear_m about the drive
  std::vector<Line> roads_;
  std::vector<Line> buildings_;
};

}  // namespace waymark::report
