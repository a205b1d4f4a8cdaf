/// What is kept of the poses of a run for its report. It takes no more memory the longer the run is.
#pragma once

#include <cmath>
#include <vector>

#include <Eigen/Core>

#include <waymark/tools/live/estimator/reports.hpp>

namespace waymark::live {

class Track {
 public:
  struct Point {
    Stamp stamp;
    Eigen::Vector2d place{0, 0};  ///< m of the frame
    double radius95_m = 0;
    State state = State::waiting;
  };

  /// Keeps a pose if the last one that was kept is older by the interval.
  void add(const LivePose& pose) {
    constexpr std::size_t kMost = 4000;
    if (!points_.empty() && std::abs(seconds_between(points_.back().stamp, pose.stamp)) < interval_s_) return;
    points_.push_back({pose.stamp, pose.pose.head<2>(), pose.radius95_m, pose.state});
    if (points_.size() < kMost) return;
    interval_s_ *= 2;
    std::size_t kept = 0;
    for (std::size_t i = 0; i < points_.size(); i += 2) points_[kept++] = points_[i];
    points_.resize(kept);
  }
  [[nodiscard]] const std::vector<Point>& points() const { return points_; }
  /// Returns how far apart the points are, s.
  [[nodiscard]] double interval_s() const { return interval_s_; }

 private:
  std::vector<Point> points_;
  double interval_s_ = 1;
};

}  // namespace waymark::live
