/// What a window was given in the last minutes, so that it can be built again with other noise.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include <waymark/core/drive/modeling.hpp>
#include <waymark/core/drive/sample.hpp>
#include <waymark/tools/drive/logs/prepare.hpp>
#include <waymark/tools/live/estimator/intake.hpp>
#include <waymark/tools/live/estimator/odometries.hpp>

namespace waymark::live {

/// A stretch of a drive that is placed in the frame: what a window begins with.
struct PlacedStretch {
  std::vector<Stamp> stamps;
  std::vector<Eigen::Vector3d> poses;
  std::vector<Interval> intervals;
  std::vector<std::size_t> givers;  ///< the odometry of each interval
  std::vector<Fix> fixes;           ///< accepted ones, in order of time
  std::vector<MeasuredWay> ways{};  ///< of odometries beside those, in order of their ends
};

/// What is known of states before the first measurement, from a former run.
struct KnownState {
  std::string tag;  ///< of the vertex type
  std::vector<double> value;
  Eigen::MatrixXd covariance;  ///< of its tangent
};

/// What is known before the first node.
struct KnownBefore {
  std::optional<drive::FirstPose> first_pose{};
  std::vector<KnownState> states{};
};

/// A fix, and what its receiver had claimed when it came.
struct ClaimedFix {
  Fix fix;
  ClaimedAccuracies claimed;
};

/// A node, and the motion to it from the one before.
struct NodeInput {
  Stamp stamp;
  Eigen::Vector3d pose = Eigen::Vector3d::Zero();  ///< where it is, by the last estimate
  Interval interval{};                             ///< of the first node: none
  std::size_t giver = 0;                           ///< the odometry of the interval
};

[[nodiscard]] inline Stamp stamp_of(const NodeInput& node) {
  return node.stamp;
}
[[nodiscard]] inline Stamp stamp_of(const ClaimedFix& fix) {
  return fix.fix.stamp;
}
[[nodiscard]] inline Stamp stamp_of(const SensorReading& reading) {
  return reading.stamp;
}
[[nodiscard]] inline Stamp stamp_of(const MeasuredWay& way) {
  return way.to;
}

/// Sources whose samples are not used, by their indices.
struct UnusedSources {
  std::set<std::size_t> odometries;
  std::set<int> receivers;
};

class WindowInputs {
 public:
  /// Inputs of one kind, each with its number among all.
  template <typename Input>
  struct Numbered {
    std::uint64_t number = 0;
    Input input;
  };
  template <typename Input>
  using Inputs = std::deque<Numbered<Input>>;

  void add(const NodeInput& node) { nodes_.push_back({count_++, node}); }
  void add(const ClaimedFix& fix) { fixes_.push_back({count_++, fix}); }
  void add(const SensorReading& reading) { readings_.push_back({count_++, reading}); }
  void add(const MeasuredWay& way) { ways_.push_back({count_++, way}); }

  /// Returns how many there were, with those that are forgotten.
  [[nodiscard]] std::uint64_t count() const { return count_; }
  /// What was known before the first node; nothing if that node is forgotten.
  [[nodiscard]] const KnownBefore& before() const { return before_; }
  void set_before(KnownBefore before) { before_ = std::move(before); }
  [[nodiscard]] const Inputs<NodeInput>& nodes() const { return nodes_; }
  [[nodiscard]] const Inputs<ClaimedFix>& fixes() const { return fixes_; }
  [[nodiscard]] const Inputs<SensorReading>& readings() const { return readings_; }
  [[nodiscard]] const Inputs<MeasuredWay>& ways() const { return ways_; }

  /// Takes better estimates of the poses of nodes. @param poses in order of time
  void correct(std::span<const StampedPose> poses);
  /// Forgets what came before a moment. Two nodes stay.
  void forget_before(Stamp moment);
  /// Removes fixes and ways of these sources. Nodes stay.
  void remove(const UnusedSources& unused);
  /// Tells whether the motion between any two nodes is that of one of these.
  [[nodiscard]] bool has_nodes_of(const UnusedSources& unused) const;
  /// Returns nodes, fixes and ways as the begin of another window.
  [[nodiscard]] PlacedStretch stretch() const;

 private:
  std::uint64_t count_ = 0;
  KnownBefore before_;
  Inputs<NodeInput> nodes_;   // in order of time
  Inputs<ClaimedFix> fixes_;  // in order of arrival, as the others
  Inputs<SensorReading> readings_;
  Inputs<MeasuredWay> ways_;
};

}  // namespace waymark::live
