/// Types only for tests: a dense scalar calibration state, a ternary edge of mixed dimensions, and
/// a scalar problem on which full steps diverge.
#pragma once

#include <array>
#include <cmath>
#include <string_view>

#include <waymark/types_se2/edge_se2.hpp>

namespace waymark_test {

/// A scale factor near 1 with very many edges.
struct VertexScale {
  static constexpr std::string_view kTag = "VERTEX_SCALE";
  static constexpr int kValueSize = 1;
  static constexpr int kTangentSize = 1;
  static constexpr bool kDense = true;
  static constexpr bool kLinearChart = true;
  static constexpr std::array<std::string_view, 1> value_names() { return {"scale"}; }

  template <typename T>
  static T at(const double* value, const T* delta) {
    return delta[0] + T(value[0]);
  }
  static void retract(double* value, const double* delta) { value[0] += delta[0]; }
  static void local(const double* from, const double* to, double* delta) { delta[0] = to[0] - from[0]; }
};

/// Odometry whose length is scaled by a state: the (t, theta) error against (scale length, 0,
/// turn). The scale is the middle vertex, so blocks of 3 x 1, 1 x 1 and 3 x 3 all occur.
struct EdgeScaledOdometry {
  static constexpr std::string_view kTag = "EDGE_SCALED_ODOMETRY";
  static constexpr std::string_view kForm = "(t, theta)";
  static constexpr int kErrorDimension = 3;
  using Vertices = waymark::VertexList<waymark::VertexSe2, VertexScale, waymark::VertexSe2>;
  static constexpr auto fields() {
    return std::array{waymark::field<&EdgeScaledOdometry::length>("length"),
                      waymark::field<&EdgeScaledOdometry::turn>("turn")};
  }

  template <typename T>
  waymark::Vector3<T> error(const waymark::Pose2<T>& from, const T& scale,
                            const waymark::Pose2<T>& to) const {
    const waymark::Pose2<T> z(T(scale * T(length)), T(0.0), T(turn));
    const waymark::Pose2<T> d = between(z, between(from, to));
    return waymark::Vector3<T>(d.position[0], d.position[1], waymark::wrap_angle(d.heading));
  }

  double length = 0;
  double turn = 0;
};

/// e = x / sqrt(1 + x^2), a sigmoid. The Newton step from |x| > 1 overshoots, and chi2
/// climbs towards 1.
struct EdgeSigmoid {
  static constexpr std::string_view kTag = "EDGE_SIGMOID";
  static constexpr std::string_view kForm = "sigmoid";
  static constexpr int kErrorDimension = 1;
  using Vertices = waymark::VertexList<VertexScale>;
  static constexpr std::array<waymark::Field<EdgeSigmoid>, 0> fields() { return {}; }

  template <typename T>
  Eigen::Matrix<T, 1, 1> error(const T& x) const {
    using std::sqrt;
    return Eigen::Matrix<T, 1, 1>(x / sqrt(T(1.0) + x * x));
  }
};

/// e = sqrt(x): it is not finite for negative x.
struct EdgeRoot {
  static constexpr std::string_view kTag = "EDGE_ROOT";
  static constexpr std::string_view kForm = "root";
  static constexpr int kErrorDimension = 1;
  using Vertices = waymark::VertexList<VertexScale>;
  static constexpr auto fields() { return std::array{waymark::field<&EdgeRoot::measured>("measured")}; }

  template <typename T>
  Eigen::Matrix<T, 1, 1> error(const T& x) const {
    using std::sqrt;
    return Eigen::Matrix<T, 1, 1>(sqrt(x) - T(measured));
  }

  double measured = 0;
};

}  // namespace waymark_test
