/// The vertices of the plane: poses (VERTEX_SE2) and points (VERTEX_XY).
#pragma once

#include <array>
#include <string_view>

#include <waymark/core/graph/vertex.hpp>
#include <waymark/types_se2/se2.hpp>

namespace waymark {

/// A pose (x, y, heading). The retraction adds x and y in world axes; it adds the heading and wraps
/// it to (-pi, pi]. So covariances are in the axes of the frame.
struct VertexSe2 {
  static constexpr std::string_view kTag = "VERTEX_SE2";
  static constexpr int kValueSize = 3;
  static constexpr int kTangentSize = 3;
  static constexpr bool kLinearChart = true;
  static constexpr std::array<std::string_view, 3> value_names() { return {"x", "y", "heading"}; }

  template <typename T>
  static Pose2<T> at(const double* value, const T* delta) {
    return Pose2<T>(T(delta[0] + T(value[0])), T(delta[1] + T(value[1])), T(delta[2] + T(value[2])));
  }
  static void retract(double* value, const double* delta) {
    value[0] += delta[0];
    value[1] += delta[1];
    value[2] = wrap_angle(value[2] + delta[2]);
  }
  static void local(const double* from, const double* to, double* delta) {
    delta[0] = to[0] - from[0];
    delta[1] = to[1] - from[1];
    delta[2] = wrap_angle(to[2] - from[2]);
  }
  static Eigen::Vector2d position(const double* value) { return {value[0], value[1]}; }
  static void rigid_motion(const double* value, const Eigen::Vector2d& centre, double extent,
                           double* columns) {
    Eigen::Map<Eigen::Matrix3d>(columns) << 1, 0, -(value[1] - centre[1]) / extent,  //
        0, 1, (value[0] - centre[0]) / extent,                                       //
        0, 0, 1 / extent;
  }
  /// T = [1 0 -dy; 0 1 dx; 0 0 1], where (dx, dy) is the vector from one to the other: a turn of
  /// `from` swings `to`.
  template <int R>
  [[gnu::always_inline]] static void carry(const double* from, const double* to,
                                           Eigen::Matrix<double, R, 3>& m) {
    const double dx = to[0] - from[0];
    const double dy = to[1] - from[1];
    for (int r = 0; r < R; ++r) m(r, 2) += m(r, 1) * dx - m(r, 0) * dy;
  }
};

/// The common part of all vertices that are two plain numbers in the plane: points, and
/// offsets of points.
struct PlaneState {
  static constexpr int kValueSize = 2;
  static constexpr int kTangentSize = 2;
  static constexpr bool kLinearChart = true;

  template <typename T>
  static Vector2<T> at(const double* value, const T* delta) {
    return Vector2<T>(T(delta[0] + T(value[0])), T(delta[1] + T(value[1])));
  }
  static void retract(double* value, const double* delta) {
    value[0] += delta[0];
    value[1] += delta[1];
  }
  static void local(const double* from, const double* to, double* delta) {
    delta[0] = to[0] - from[0];
    delta[1] = to[1] - from[1];
  }
};

/// A point (x, y): a landmark.
struct VertexXy : PlaneState {
  static constexpr std::string_view kTag = "VERTEX_XY";
  static constexpr std::array<std::string_view, 2> value_names() { return {"x", "y"}; }

  static Eigen::Vector2d position(const double* value) { return {value[0], value[1]}; }
  static void rigid_motion(const double* value, const Eigen::Vector2d& centre, double extent,
                           double* columns) {
    Eigen::Map<Eigen::Matrix<double, 2, 3>>(columns) << 1, 0, -(value[1] - centre[1]) / extent,  //
        0, 1, (value[0] - centre[0]) / extent;
  }
};

}  // namespace waymark
