/// A pose with a retraction in its own body frame, X [+] d = X exp(d). This chart is not linear,
/// and a plugin may bring one.
#pragma once

#include <array>
#include <string_view>

#include <waymark/types_se2/se2.hpp>

namespace waymark_test {

struct VertexBodyPose {
  static constexpr std::string_view kTag = "VERTEX_BODY_POSE";
  static constexpr int kValueSize = 3;
  static constexpr int kTangentSize = 3;
  static constexpr std::array<std::string_view, 3> value_names() { return {"x", "y", "heading"}; }

  template <typename T>
  static waymark::Pose2<T> at(const double* value, const T* delta) {
    return waymark::compose(waymark::Pose2<T>(T(value[0]), T(value[1]), T(value[2])),
                            waymark::se2_exp(waymark::Vector3<T>(delta[0], delta[1], delta[2])));
  }
  static void retract(double* value, const double* delta) {
    const waymark::Pose2<double> moved = at<double>(value, delta);
    value[0] = moved.position[0];
    value[1] = moved.position[1];
    value[2] = waymark::wrap_angle(moved.heading);
  }
  static void local(const double* from, const double* to, double* delta) {
    Eigen::Map<Eigen::Vector3d>{delta} = waymark::se2_log(waymark::between(
        waymark::Pose2<double>(from[0], from[1], from[2]), waymark::Pose2<double>(to[0], to[1], to[2])));
  }
};

}  // namespace waymark_test
