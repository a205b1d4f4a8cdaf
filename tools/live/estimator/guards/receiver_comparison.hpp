/// Whether receivers differ all the time by more than they claim: the poses lie between them then, and their
/// covariances do not tell.
#pragma once

#include <map>
#include <set>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include <waymark/core/drive/sample.hpp>
#include <waymark/tools/drive/comparison/constant_difference.hpp>

namespace waymark::live {

class ReceiverComparison {
 public:
  /// Takes a fix that is used. One a second of each receiver counts.
  /// @param reckoned pose of the vehicle at the fix by dead reckoning: x, y [m], heading [rad]
  /// @param turn of its axes to those of the frame, rad
  void take(const Fix& fix, const Eigen::Vector3d& reckoned, double turn);
  /// Judges the last ten minutes, once a minute. @returns what was not returned before
  [[nodiscard]] std::vector<drive::ConstantDifference> news();
  void clear();

 private:
  std::vector<Fix> fixes_;
  std::vector<Eigen::Vector3d> poses_;  // of them, in a chain: x, y, heading in the axes of the frame
  Eigen::Vector2d last_ = Eigen::Vector2d::Zero();  // the place of the last one by dead reckoning
  std::map<int, Stamp> newest_;
  Stamp judged_;
  std::set<std::pair<int, int>> told_;
};

}  // namespace waymark::live
