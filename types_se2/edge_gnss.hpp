/// The edges of GNSS positions, and the time offset between GNSS and odometry as a state
/// of the graph.
#pragma once

#include <array>
#include <string_view>

#include <waymark/core/graph/detail/typed_batch.hpp>
#include <waymark/core/graph/scalar_state.hpp>
#include <waymark/types_se2/vertex_se2.hpp>

namespace waymark {

/// The position of an antenna, seen from a reference pose: e = R_from^T (p_to + R_to antenna -
/// p_from) - measured. Metres. For GNSS the reference is the fixed origin of the frame or a fixed
/// GNSS node. If it is the origin, e is the difference in the axes of the frame, and no heading
/// error enters it. This is the decoupled GNSS error.
struct EdgeGnssPosition {
  static constexpr std::string_view kTag = "EDGE_GNSS_POSITION";
  static constexpr std::string_view kForm = "position";
  static constexpr int kErrorDimension = 2;
  using Vertices = VertexList<VertexSe2, VertexSe2>;
  static constexpr bool kRelative = true;
  static constexpr auto fields() {
    return std::array{field<&EdgeGnssPosition::measured>("measured"),
                      field<&EdgeGnssPosition::antenna>("antenna")};
  }

  template <typename T>
  Vector2<T> error(const Pose2<T>& from, const Pose2<T>& to) const {
    const Vector2<T> place = to.position + rotate(to.heading, constant_vector<T>(antenna));
    const Vector2<T> seen = rotate_back(from.heading, Vector2<T>(place - from.position));
    return seen - constant_vector<T>(measured);
  }

  void linearize(const Pose2<double>& from, const Pose2<double>& to, ErrorVector<2>& e,
                 JacobianMatrix<2, 3>& by_from, JacobianMatrix<2, 3>& by_to) const;

  Eigen::Vector2d measured = Eigen::Vector2d::Zero();
  /// in the body frame of `to`: x forward, y left
  Eigen::Vector2d antenna = Eigen::Vector2d::Zero();
};

/// How late the stamps of a receiver are on the odometry's clock, in s. A fix with stamp t shows
/// the antenna as it was at t - offset. It is the same number as `delay` in a drive.yaml.
struct VertexTimeOffset : ScalarState {
  static constexpr std::string_view kTag = "VERTEX_TIME_OFFSET";
  static constexpr std::array<std::string_view, 1> value_names() { return {"time_offset"}; }
  static constexpr std::array<std::string_view, 1> value_units() { return {"s"}; }
};

/// EDGE_GNSS_POSITION of a fix that is late. The body was at X exp(-offset [speed, 0, yaw_rate])
/// when the antenna was measured, given the motion at the fix. e = R_from^T (p_then + R_then
/// antenna - p_from) - measured. Metres. The speed is in (grid) m/s and the yaw rate in rad/s,
/// both of `to`.
struct EdgeGnssPositionDelayed {
  static constexpr std::string_view kTag = "EDGE_GNSS_POSITION_DELAYED";
  static constexpr std::string_view kForm = "position";
  static constexpr int kErrorDimension = 2;
  using Vertices = VertexList<VertexSe2, VertexSe2, VertexTimeOffset>;
  static constexpr bool kRelative = true;
  static constexpr auto fields() {
    return std::array{field<&EdgeGnssPositionDelayed::measured>("measured"),
                      field<&EdgeGnssPositionDelayed::antenna>("antenna"),
                      field<&EdgeGnssPositionDelayed::velocity>("velocity"),
                      field<&EdgeGnssPositionDelayed::yaw_rate>("yaw_rate")};
  }

  template <typename T>
  Vector2<T> error(const Pose2<T>& from, const Pose2<T>& to, const T& offset) const {
    const Vector3<T> back(T(-offset * T(velocity[0])), T(-offset * T(velocity[1])), T(-offset * T(yaw_rate)));
    const Pose2<T> then = compose(to, se2_exp(back));
    const Vector2<T> place = then.position + rotate(then.heading, constant_vector<T>(antenna));
    const Vector2<T> seen = rotate_back(from.heading, Vector2<T>(place - from.position));
    return seen - constant_vector<T>(measured);
  }

  Eigen::Vector2d measured = Eigen::Vector2d::Zero();
  Eigen::Vector2d antenna = Eigen::Vector2d::Zero();  ///< in the body frame: x forward, y left
  Eigen::Vector2d velocity = Eigen::Vector2d::Zero();
  double yaw_rate = 0;
};

// This is compiled once, in edge_gnss.cpp.
extern template class EdgeBatch<EdgeGnssPosition>;
extern template class EdgeBatch<EdgeGnssPositionDelayed>;

}  // namespace waymark
