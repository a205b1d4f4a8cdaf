/// Odometry edges. They keep the sensor readings (speed, yaw rate, time), so that calibration
/// states can be connected.
#pragma once

#include <array>
#include <string_view>

#include <waymark/types_se2/edge_se2.hpp>

namespace waymark::plugins::odometry {

/// A constant twist over dt: Z = exp([speed dt, 0, yaw_rate dt]), e = log(Z^-1 (X_from^-1 X_to)).
/// Units: m/s (grid metres), rad/s, s.
struct EdgeSe2Odometry {
  static constexpr std::string_view kTag = "EDGE_SE2_ODOMETRY";
  static constexpr std::string_view kForm = "log";
  static constexpr int kErrorDimension = 3;
  using Vertices = VertexList<VertexSe2, VertexSe2>;
  static constexpr bool kRelative = true;
  static constexpr auto fields() {
    return std::array{field<&EdgeSe2Odometry::speed>("speed"), field<&EdgeSe2Odometry::yaw_rate>("yaw_rate"),
                      field<&EdgeSe2Odometry::dt>("dt")};
  }

  [[nodiscard]] Eigen::Vector3d twist() const { return {speed * dt, 0, yaw_rate * dt}; }

  template <typename T>
  Vector3<T> error(const Pose2<T>& from, const Pose2<T>& to) const {
    const Vector3<T> xi(T(speed * dt), T(0.0), T(yaw_rate * dt));
    return se2_log(between(se2_exp(xi), between(from, to)));
  }

  void linearize(const Pose2<double>& from, const Pose2<double>& to, ErrorVector<3>& e,
                 JacobianMatrix<3, 3>& by_from, JacobianMatrix<3, 3>& by_to) const {
    linearize_log_error(relative, from, to, e, by_from, by_to);
  }
  void prepare() { relative = RelativeMeasurement(se2_exp(twist())); }

  double speed = 0;
  double yaw_rate = 0;
  double dt = 0;
  RelativeMeasurement relative{};  ///< of exp([speed dt, 0, yaw_rate dt]), by prepare()
};

/// The vehicle stands. Z is the identity, whatever the sensors read: e = log(X_from^-1 X_to). The
/// readings are kept, because a gyro shows its bias at rest.
struct EdgeSe2Standstill {
  static constexpr std::string_view kTag = "EDGE_SE2_STANDSTILL";
  static constexpr std::string_view kForm = "log";
  static constexpr int kErrorDimension = 3;
  using Vertices = VertexList<VertexSe2, VertexSe2>;
  static constexpr bool kRelative = true;
  static constexpr auto fields() {
    return std::array{field<&EdgeSe2Standstill::speed>("speed"),
                      field<&EdgeSe2Standstill::yaw_rate>("yaw_rate"), field<&EdgeSe2Standstill::dt>("dt")};
  }

  template <typename T>
  Vector3<T> error(const Pose2<T>& from, const Pose2<T>& to) const {
    return se2_log(between(from, to));
  }

  void linearize(const Pose2<double>& from, const Pose2<double>& to, ErrorVector<3>& e,
                 JacobianMatrix<3, 3>& by_from, JacobianMatrix<3, 3>& by_to) const {
    linearize_log_error(RelativeMeasurement(), from, to, e, by_from, by_to);
  }

  double speed = 0;
  double yaw_rate = 0;
  double dt = 0;
};

}  // namespace waymark::plugins::odometry
