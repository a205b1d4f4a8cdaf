/// What a GNSS receiver says of its antenna's velocity: course and Doppler speed.
#pragma once

#include <array>
#include <cmath>
#include <string_view>

#include <waymark/types_se2/edge_se2.hpp>

namespace waymark::plugins::gnss_velocity {

/// Course of the antenna against the heading of the body. With the odometry's speed v and yaw rate w the
/// antenna at a (body frame) moves at (v - w a_y, w a_x) in the body frame, so
///   e = wrap(heading + atan2(w a_x, v - w a_y) - course).
/// Radians; the course as a heading, counter-clockwise from grid east. The body point does not slip sideways.
/// Reversing is right by itself: v < 0 turns the velocity by half a turn.
struct EdgeGnssCourse {
  static constexpr std::string_view kTag = "EDGE_GNSS_COURSE";
  static constexpr std::string_view kForm = "angle";
  static constexpr int kErrorDimension = 1;
  using Vertices = VertexList<VertexSe2>;
  static constexpr auto fields() {
    return std::array{field<&EdgeGnssCourse::course>("course"), field<&EdgeGnssCourse::speed>("speed"),
                      field<&EdgeGnssCourse::yaw_rate>("yaw_rate"),
                      field<&EdgeGnssCourse::antenna>("antenna")};
  }

  /// Direction of the antenna's velocity in the body frame; 0 where it stands.
  [[nodiscard]] double slip() const {
    return std::atan2(yaw_rate * antenna[0], speed - yaw_rate * antenna[1]);
  }

  template <typename T>
  Eigen::Matrix<T, 1, 1> error(const Pose2<T>& pose) const {
    return Eigen::Matrix<T, 1, 1>(wrap_angle(T(pose.heading + T(slip()) - T(course))));
  }
  void linearize(const Pose2<double>& pose, ErrorVector<1>& e, JacobianMatrix<1, 3>& by_pose) const {
    e = error(pose);
    by_pose << 0, 0, 1;
  }

  double course = 0;
  double speed = 0;
  double yaw_rate = 0;
  Eigen::Vector2d antenna = Eigen::Vector2d::Zero();  ///< in the body frame: x forward, y left
};

/// Doppler speed as the way of the antenna from one pose to another dt later:
///   e = |A_to - A_from| - speed dt,  A = p + R antenna.
/// Metres. A chord instead of the arc: (w dt)^2 / 24 shorter, 1e-4 of it for 0.5 rad/s and 0.1 s.
struct EdgeGnssSpeed {
  static constexpr std::string_view kTag = "EDGE_GNSS_SPEED";
  static constexpr std::string_view kForm = "way";
  static constexpr int kErrorDimension = 1;
  using Vertices = VertexList<VertexSe2, VertexSe2>;
  static constexpr bool kRelative = true;
  static constexpr auto fields() {
    return std::array{field<&EdgeGnssSpeed::speed>("speed"), field<&EdgeGnssSpeed::dt>("dt"),
                      field<&EdgeGnssSpeed::antenna>("antenna")};
  }

  template <typename T>
  Eigen::Matrix<T, 1, 1> error(const Pose2<T>& from, const Pose2<T>& to) const {
    const Vector2<T> arm = constant_vector<T>(antenna);
    const Vector2<T> way = to.position + rotate(to.heading, arm) - from.position - rotate(from.heading, arm);
    return Eigen::Matrix<T, 1, 1>(length(way) - T(speed * dt));
  }

  double speed = 0;
  double dt = 0;
  Eigen::Vector2d antenna = Eigen::Vector2d::Zero();  ///< in the body frame: x forward, y left
};

}  // namespace waymark::plugins::gnss_velocity
