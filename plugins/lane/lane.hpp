/// Lateral offset to a line of a map, for example a lane marking, a kerb or a tram rail.
#pragma once

#include <array>
#include <string_view>

#include <waymark/types_se2/edge_se2.hpp>

namespace waymark::plugins::lane {

/// The distance of a body point to the left of a straight line. The line passes through `point` in
/// the direction `heading`; both are in the frame. With n = (-sin heading, cos heading),
///   e = n^T (p + R lever - point) - offset.
/// Metres and radians. The edge does not measure the position along the line.
struct EdgeLateralOffset {
  static constexpr std::string_view kTag = "EDGE_LATERAL_OFFSET";
  static constexpr std::string_view kForm = "lateral";
  static constexpr int kErrorDimension = 1;
  using Vertices = VertexList<VertexSe2>;
  static constexpr auto fields() {
    return std::array{field<&EdgeLateralOffset::offset>("offset"), field<&EdgeLateralOffset::point>("point"),
                      field<&EdgeLateralOffset::heading>("heading"),
                      field<&EdgeLateralOffset::lever>("lever")};
  }

  template <typename T>
  Eigen::Matrix<T, 1, 1> error(const Pose2<T>& pose) const {
    const Vector2<T> place = pose.position + rotate(pose.heading, constant_vector<T>(lever));
    const Vector2<T> from_point = place - constant_vector<T>(point);
    const Eigen::Vector2d left = rotate(heading, Eigen::Vector2d(0, 1));
    return Eigen::Matrix<T, 1, 1>(T(left[0]) * from_point[0] + T(left[1]) * from_point[1] - T(offset));
  }

  double offset = 0;  ///< positive: the body point is to the left of the line
  Eigen::Vector2d point = Eigen::Vector2d::Zero();
  double heading = 0;
  Eigen::Vector2d lever = Eigen::Vector2d::Zero();  ///< the body point, in the body frame
};

}  // namespace waymark::plugins::lane
