/// Edges of a source of twists, and the calibration of the source: a scale of its velocities and a
/// bias of its yaw rates.
#pragma once

#include <array>
#include <string_view>

#include <waymark/core/graph/scalar_state.hpp>
#include <waymark/types_se2/edge_se2.hpp>

namespace waymark::plugins::twist {

/// The relative error of the velocities: true velocity = (1 + scale) reading.
struct VertexTwistScale : ScalarState {
  static constexpr std::string_view kTag = "VERTEX_TWIST_SCALE";
  static constexpr std::array<std::string_view, 1> value_names() { return {"twist_scale"}; }
  static constexpr std::array<std::string_view, 1> value_units() { return {"1"}; }
};

/// The bias of the yaw rates: true yaw rate = reading - bias. rad/s, counter-clockwise.
struct VertexTwistBias : ScalarState {
  static constexpr std::string_view kTag = "VERTEX_TWIST_BIAS";
  static constexpr std::array<std::string_view, 1> value_names() { return {"twist_bias"}; }
  static constexpr std::array<std::string_view, 1> value_units() { return {"rad/s"}; }
};

/// The motion of a sensor, between two poses of the body. With scale s and bias b the sensor moves
/// by S = exp([(1 + s) way.x, (1 + s) way.y, way.turn - b dt]), and its place by (1 + s) b bend
/// besides. The body moves by Z = M S M^-1, and e = log(Z^-1 (X_from^-1 X_to)).
struct EdgeSe2Twist {
  static constexpr std::string_view kTag = "EDGE_SE2_TWIST";
  static constexpr std::string_view kForm = "log";
  static constexpr int kErrorDimension = 3;
  using Vertices = VertexList<VertexSe2, VertexSe2, VertexTwistScale, VertexTwistBias>;
  static constexpr bool kRelative = true;
  static constexpr auto fields() {
    return std::array{field<&EdgeSe2Twist::way>("way"), field<&EdgeSe2Twist::bend>("bend"),
                      field<&EdgeSe2Twist::dt>("dt"), field<&EdgeSe2Twist::mount>("mount")};
  }

  template <typename T>
  Vector3<T> error(const Pose2<T>& from, const Pose2<T>& to, const T& scale, const T& bias) const {
    const Pose2<T> m = constant_pose<T>(mount);
    const Pose2<T> z = compose(compose(m, sensor_motion(scale, bias)), inverse(m));
    return se2_log(between(z, between(from, to)));
  }

  /// A change d of S on its right side is a change Ad(M) d of Z. With E = exp(e) it changes e by
  /// -Jl(e)^-1 Ad(M) d, where Jl(e) = Jr(-e).
  void linearize(const Pose2<double>& from, const Pose2<double>& to, double scale, double bias,
                 ErrorVector<3>& e, JacobianMatrix<3, 3>& by_from, JacobianMatrix<3, 3>& by_to,
                 JacobianMatrix<3, 1>& by_scale, JacobianMatrix<3, 1>& by_bias) const {
    const Pose2<double> m = constant_pose<double>(mount);
    const Pose2<double> s = sensor_motion(scale, bias);
    linearize_log_error(RelativeMeasurement(compose(compose(m, s), inverse(m))), from, to, e, by_from, by_to);
    const Eigen::Matrix3d by_motion = -se2_right_jacobian_inverse(-e) * se2_adjoint(m);
    const Eigen::Matrix3d by_twist = by_motion * se2_right_jacobian(calibrated_way(scale, bias));
    const Eigen::Vector2d turned_bend = rotate_back(s.heading, bend);
    by_scale = by_twist.leftCols<2>() * way.head<2>() + by_motion.leftCols<2>() * (bias * turned_bend);
    by_bias = by_twist.col(2) * -dt + by_motion.leftCols<2>() * ((1 + scale) * turned_bend);
  }

  /// The mean twist of the sensor times dt, in its own axes: forward [m], left [m], turn [rad].
  Eigen::Vector3d way = Eigen::Vector3d::Zero();
  /// If the twist changes along the way, a bias moves the end otherwise than with the mean twist:
  /// the difference, m per rad/s, in the sensor's axes at the beginning.
  Eigen::Vector2d bend = Eigen::Vector2d::Zero();
  double dt = 0;                                    ///< s
  Eigen::Vector3d mount = Eigen::Vector3d::Zero();  ///< M, the sensor in the body frame: m, m, rad

 private:
  template <typename T>
  Vector3<T> calibrated_way(const T& scale, const T& bias) const {
    const T factor = T(1.0) + scale;
    return Vector3<T>(T(factor * T(way[0])), T(factor * T(way[1])), T(T(way[2]) - bias * T(dt)));
  }

  template <typename T>
  Pose2<T> sensor_motion(const T& scale, const T& bias) const {
    const Pose2<T> moved = se2_exp(calibrated_way(scale, bias));
    const T factor = (T(1.0) + scale) * bias;
    return Pose2<T>(T(moved.position[0] + factor * T(bend[0])), T(moved.position[1] + factor * T(bend[1])),
                    moved.heading);
  }
};

/// One step of a random walk of the scale: e = s_to - s_from - change.
struct EdgeTwistScaleWalk {
  static constexpr std::string_view kTag = "EDGE_TWIST_SCALE_WALK";
  static constexpr std::string_view kForm = "difference";
  static constexpr int kErrorDimension = 1;
  using Vertices = VertexList<VertexTwistScale, VertexTwistScale>;
  static constexpr auto fields() { return std::array{field<&EdgeTwistScaleWalk::change>("change")}; }

  template <typename T>
  Eigen::Matrix<T, 1, 1> error(const T& from, const T& to) const {
    return Eigen::Matrix<T, 1, 1>(to - from - T(change));
  }

  double change = 0;  ///< the expected change, usually 0
};

/// The same step for the bias, rad/s.
struct EdgeTwistBiasWalk : EdgeTwistScaleWalk {
  static constexpr std::string_view kTag = "EDGE_TWIST_BIAS_WALK";
  using Vertices = VertexList<VertexTwistBias, VertexTwistBias>;
  static constexpr auto fields() {
    return std::array{field<&EdgeTwistScaleWalk::change, EdgeTwistBiasWalk>("change")};
  }
};

}  // namespace waymark::plugins::twist
