/// Calibration of the odometry: gyro bias, speed scale, yaw rate per speed and yaw scale as states of the graph.
/// They are constant over a drive or wander slowly.
#pragma once

#include <array>
#include <string_view>

#include <waymark/core/graph/scalar_state.hpp>
#include <waymark/types_se2/edge_se2.hpp>

namespace waymark::plugins::odometry {

/// The reading of the gyro at rest: true yaw rate = reading - bias. rad/s, counter-clockwise.
struct VertexGyroBias : ScalarState {
  static constexpr std::string_view kTag = "VERTEX_GYRO_BIAS";
  static constexpr std::array<std::string_view, 1> value_names() { return {"gyro_bias"}; }
  static constexpr std::array<std::string_view, 1> value_units() { return {"rad/s"}; }
};

/// The relative error of the odometry's speed: true speed = (1 + scale) reading.
struct VertexSpeedScale : ScalarState {
  static constexpr std::string_view kTag = "VERTEX_SPEED_SCALE";
  static constexpr std::array<std::string_view, 1> value_names() { return {"speed_scale"}; }
  static constexpr std::array<std::string_view, 1> value_units() { return {"1"}; }
};

/// The error of a yaw rate that is made from wheels or steering: true yaw rate = reading - bias -
/// this * reading of the speed. A wrong radius of a wheel or a wrong zero of the steering give it. rad/m.
struct VertexYawPerSpeed : ScalarState {
  static constexpr std::string_view kTag = "VERTEX_YAW_PER_SPEED";
  static constexpr std::array<std::string_view, 1> value_names() { return {"yaw_per_speed"}; }
  static constexpr std::array<std::string_view, 1> value_units() { return {"rad/m"}; }
};

/// The relative error of the yaw rate, by the sensitivity of a gyro, a track width or a steering ratio:
/// true yaw rate = (1 + scale) (reading - bias - yaw_per_speed * speed).
struct VertexYawScale : ScalarState {
  static constexpr std::string_view kTag = "VERTEX_YAW_SCALE";
  static constexpr std::array<std::string_view, 1> value_names() { return {"yaw_scale"}; }
  static constexpr std::array<std::string_view, 1> value_units() { return {"1"}; }
};

/// EDGE_SE2_ODOMETRY with calibrated readings: Z = exp([(1 + s) speed dt, 0, (yaw_rate - b) dt]),
/// e = log(Z^-1 (X_from^-1 X_to)).
struct EdgeSe2OdometryCalibrated {
  static constexpr std::string_view kTag = "EDGE_SE2_ODOMETRY_CALIBRATED";
  static constexpr std::string_view kForm = "log";
  static constexpr int kErrorDimension = 3;
  using Vertices = VertexList<VertexSe2, VertexSe2, VertexSpeedScale, VertexGyroBias>;
  static constexpr bool kRelative = true;
  static constexpr auto fields() {
    return std::array{field<&EdgeSe2OdometryCalibrated::speed>("speed"),
                      field<&EdgeSe2OdometryCalibrated::yaw_rate>("yaw_rate"),
                      field<&EdgeSe2OdometryCalibrated::dt>("dt")};
  }

  template <typename T>
  Vector3<T> error(const Pose2<T>& from, const Pose2<T>& to, const T& scale, const T& bias) const {
    const Vector3<T> xi(T((T(1.0) + scale) * T(speed * dt)), T(0.0), T((T(yaw_rate) - bias) * T(dt)));
    return se2_log(between(se2_exp(xi), between(from, to)));
  }

  /// With E = exp(e), a change d of the twist xi changes e by -Jl(e)^-1 Jr(xi) d, where
  /// Jl(e) = Jr(-e).
  void linearize(const Pose2<double>& from, const Pose2<double>& to, double scale, double bias,
                 ErrorVector<3>& e, JacobianMatrix<3, 3>& by_from, JacobianMatrix<3, 3>& by_to,
                 JacobianMatrix<3, 1>& by_scale, JacobianMatrix<3, 1>& by_bias) const {
    const Eigen::Vector3d xi((1 + scale) * speed * dt, 0, (yaw_rate - bias) * dt);
    linearize_log_error(RelativeMeasurement(se2_exp(xi)), from, to, e, by_from, by_to);
    const Eigen::Matrix3d by_twist = -se2_right_jacobian_inverse(-e) * se2_right_jacobian(xi);
    by_scale = by_twist.col(0) * (speed * dt);
    by_bias = by_twist.col(2) * -dt;
  }

  double speed = 0;
  double yaw_rate = 0;
  double dt = 0;
};

/// The same with a yaw rate that errs in proportion to the speed: the yaw rate is w - b - k speed.
struct EdgeSe2OdometryYawCalibrated : EdgeSe2OdometryCalibrated {
  using Base = EdgeSe2OdometryCalibrated;
  static constexpr std::string_view kTag = "EDGE_SE2_ODOMETRY_YAW_CALIBRATED";
  using Vertices = VertexList<VertexSe2, VertexSe2, VertexSpeedScale, VertexGyroBias, VertexYawPerSpeed>;
  static constexpr auto fields() {
    return std::array{field<&Base::speed, EdgeSe2OdometryYawCalibrated>("speed"),
                      field<&Base::yaw_rate, EdgeSe2OdometryYawCalibrated>("yaw_rate"),
                      field<&Base::dt, EdgeSe2OdometryYawCalibrated>("dt")};
  }

  template <typename T>
  Vector3<T> error(const Pose2<T>& from, const Pose2<T>& to, const T& scale, const T& bias,
                   const T& per_speed) const {
    return Base::error(from, to, scale, T(bias + per_speed * T(speed)));
  }

  void linearize(const Pose2<double>& from, const Pose2<double>& to, double scale, double bias,
                 double per_speed, ErrorVector<3>& e, JacobianMatrix<3, 3>& by_from,
                 JacobianMatrix<3, 3>& by_to, JacobianMatrix<3, 1>& by_scale, JacobianMatrix<3, 1>& by_bias,
                 JacobianMatrix<3, 1>& by_per_speed) const {
    Base::linearize(from, to, scale, bias + per_speed * speed, e, by_from, by_to, by_scale, by_bias);
    by_per_speed = by_bias * speed;
  }
};

/// The same with a yaw rate whose scale is not known either: the yaw rate is (1 + k) (w - b - k' speed).
struct EdgeSe2OdometryYawScaled : EdgeSe2OdometryCalibrated {
  using Base = EdgeSe2OdometryCalibrated;
  static constexpr std::string_view kTag = "EDGE_SE2_ODOMETRY_YAW_SCALED";
  using Vertices =
      VertexList<VertexSe2, VertexSe2, VertexSpeedScale, VertexGyroBias, VertexYawPerSpeed, VertexYawScale>;
  static constexpr auto fields() {
    return std::array{field<&Base::speed, EdgeSe2OdometryYawScaled>("speed"),
                      field<&Base::yaw_rate, EdgeSe2OdometryYawScaled>("yaw_rate"),
                      field<&Base::dt, EdgeSe2OdometryYawScaled>("dt")};
  }

  template <typename T>
  Vector3<T> error(const Pose2<T>& from, const Pose2<T>& to, const T& scale, const T& bias,
                   const T& per_speed, const T& yaw_scale) const {
    return Base::error(from, to, scale, equivalent_bias(T(bias + per_speed * T(speed)), yaw_scale));
  }

  void linearize(const Pose2<double>& from, const Pose2<double>& to, double scale, double bias,
                 double per_speed, double yaw_scale, ErrorVector<3>& e, JacobianMatrix<3, 3>& by_from,
                 JacobianMatrix<3, 3>& by_to, JacobianMatrix<3, 1>& by_scale, JacobianMatrix<3, 1>& by_bias,
                 JacobianMatrix<3, 1>& by_per_speed, JacobianMatrix<3, 1>& by_yaw_scale) const {
    const double unscaled = bias + per_speed * speed;
    Base::linearize(from, to, scale, equivalent_bias(unscaled, yaw_scale), e, by_from, by_to, by_scale,
                    by_bias);
    by_yaw_scale = by_bias * (unscaled - yaw_rate);
    by_bias *= 1 + yaw_scale;
    by_per_speed = by_bias * speed;
  }

 private:
  /// The bias b with w - b = (1 + k) (w - bias).
  template <typename T>
  T equivalent_bias(const T& bias, const T& yaw_scale) const {
    return T(bias + yaw_scale * (bias - T(yaw_rate)));
  }
};

/// The gyro reads its bias while the vehicle stands: e = yaw_rate - b. rad/s.
struct EdgeGyroAtRest {
  static constexpr std::string_view kTag = "EDGE_GYRO_AT_REST";
  static constexpr std::string_view kForm = "difference";
  static constexpr int kErrorDimension = 1;
  using Vertices = VertexList<VertexGyroBias>;
  static constexpr auto fields() { return std::array{field<&EdgeGyroAtRest::yaw_rate>("yaw_rate")}; }

  template <typename T>
  Eigen::Matrix<T, 1, 1> error(const T& bias) const {
    return Eigen::Matrix<T, 1, 1>(T(yaw_rate) - bias);
  }

  double yaw_rate = 0;
};

/// One step of a random walk: e = b_to - b_from - change.
struct EdgeGyroBiasWalk {
  static constexpr std::string_view kTag = "EDGE_GYRO_BIAS_WALK";
  static constexpr std::string_view kForm = "difference";
  static constexpr int kErrorDimension = 1;
  using Vertices = VertexList<VertexGyroBias, VertexGyroBias>;
  static constexpr auto fields() { return std::array{field<&EdgeGyroBiasWalk::change>("change")}; }

  template <typename T>
  Eigen::Matrix<T, 1, 1> error(const T& from, const T& to) const {
    return Eigen::Matrix<T, 1, 1>(to - from - T(change));
  }

  double change = 0;  ///< the expected change, usually 0
};

/// The same step for the yaw rate per speed.
struct EdgeYawPerSpeedWalk : EdgeGyroBiasWalk {
  static constexpr std::string_view kTag = "EDGE_YAW_PER_SPEED_WALK";
  using Vertices = VertexList<VertexYawPerSpeed, VertexYawPerSpeed>;
  static constexpr auto fields() {
    return std::array{field<&EdgeGyroBiasWalk::change, EdgeYawPerSpeedWalk>("change")};
  }
};

/// The same step for the yaw scale.
struct EdgeYawScaleWalk : EdgeGyroBiasWalk {
  static constexpr std::string_view kTag = "EDGE_YAW_SCALE_WALK";
  using Vertices = VertexList<VertexYawScale, VertexYawScale>;
  static constexpr auto fields() {
    return std::array{field<&EdgeGyroBiasWalk::change, EdgeYawScaleWalk>("change")};
  }
};

/// The same step for the speed scale.
struct EdgeSpeedScaleWalk : EdgeGyroBiasWalk {
  static constexpr std::string_view kTag = "EDGE_SPEED_SCALE_WALK";
  using Vertices = VertexList<VertexSpeedScale, VertexSpeedScale>;
  static constexpr auto fields() {
    return std::array{field<&EdgeGyroBiasWalk::change, EdgeSpeedScaleWalk>("change")};
  }
};

}  // namespace waymark::plugins::odometry
