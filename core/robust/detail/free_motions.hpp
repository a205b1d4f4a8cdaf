/// The rigid motions of a part of a graph that nothing stops.
#pragma once

#include <Eigen/Core>

#include <waymark/core/graph/edge_batch.hpp>

namespace waymark::detail {

/// All motions of a part that nothing anchors, some of one that is anchored in part, or none.
class FreeMotions {
 public:
  /// No motion: an anchored part.
  FreeMotions() = default;
  /// All of them. @param count 2 for a point, 3 for poses
  [[nodiscard]] static FreeMotions all(int count);
  /// @param motions 3 x k: along x, along y and about the place @param frame one place for all parts that are
  /// compared
  [[nodiscard]] static FreeMotions some(const Eigen::MatrixXd& motions, const RigidMotionView::Place& place,
                                        const RigidMotionView::Place& frame);

  /// Returns how many there are if nothing anchors the part, else 0.
  [[nodiscard]] int unanchored() const { return unanchored_; }
  /// Tells whether two parts that are anchored, wholly or in part, have all rigid motions between them.
  [[nodiscard]] bool make_all_with(const FreeMotions& other) const;
  /// Returns those that two parts share, both anchored wholly or in part.
  [[nodiscard]] FreeMotions shared_with(const FreeMotions& other) const;

 private:
  int unanchored_ = 0;
  Eigen::MatrixXd some_ = Eigen::MatrixXd(3, 0);  // orthonormal
};

}  // namespace waymark::detail
