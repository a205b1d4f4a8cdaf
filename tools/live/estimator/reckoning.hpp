/// The odometry of the last minutes, and the dead reckoning along it from anywhere.
#pragma once

#include <cstddef>
#include <deque>

#include <Eigen/Core>

#include <waymark/core/drive/sample.hpp>
#include <waymark/types_se2/se2.hpp>

namespace waymark::live {

/// @param numbers x, y, heading
[[nodiscard]] inline Pose2<double> to_pose(const Eigen::Vector3d& numbers) {
  return {numbers[0], numbers[1], numbers[2]};
}

class Reckoning {
 public:
  /// A sample of the odometry and the dead reckoning up to it.
  struct Node {
    OdometrySample sample;
    std::size_t giver = 0;  ///< the odometry that measured it
    Eigen::Vector3d pose = Eigen::Vector3d::Zero();
    double way_m = 0;
  };

  /// @param gap_s a longer interval is bridged @param standstill_mps below it the vehicle stands
  Reckoning(double gap_s, double standstill_mps) : gap_s_(gap_s), standstill_mps_(standstill_mps) {}

  [[nodiscard]] const std::deque<Node>& nodes() const { return nodes_; }
  [[nodiscard]] bool empty() const { return nodes_.empty(); }
  [[nodiscard]] Stamp begin() const { return nodes_.front().sample.stamp; }
  [[nodiscard]] double standstill_mps() const { return standstill_mps_; }
  /// Grid metres per metre on the ground, where the vehicle is.
  [[nodiscard]] double grid_scale() const { return grid_scale_; }
  void set_grid_scale(double scale) { grid_scale_ = scale; }

  /// Begins with a sample. There must be none.
  void begin_with(const OdometrySample& sample, std::size_t giver);
  /// Returns the motion from the last node to a sample that follows it.
  [[nodiscard]] Interval motion_to(const OdometrySample& sample) const;
  /// Returns the motion to a node from the one before it. Later nodes do not change it.
  [[nodiscard]] Interval motion_to_node(std::size_t node) const;
  /// Adds a sample at the end of a motion.
  void add(const OdometrySample& sample, std::size_t giver, const Interval& motion);
  /// Returns where dead reckoning was; at its first or last node outside its time.
  [[nodiscard]] Node at(Stamp stamp) const;
  /// Removes what ended longer ago than this, by the last node. Two nodes stay.
  void keep_last(double seconds);
  void clear() { nodes_.clear(); }

 private:
  [[nodiscard]] Interval motion(std::size_t before, const OdometrySample& to) const;
  [[nodiscard]] Node moved(const Node& from, const Interval& motion) const;

  double gap_s_;
  double standstill_mps_;
  double grid_scale_ = 1;
  std::deque<Node> nodes_;
};

}  // namespace waymark::live
