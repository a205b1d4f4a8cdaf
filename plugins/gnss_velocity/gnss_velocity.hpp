/// Edges for the velocity of an antenna as a GNSS receiver measures it: course and Doppler speed.
#pragma once

#include <array>
#include <cmath>
#include <string_view>

#include <waymark/types_se2/edge_se2.hpp>

namespace waymark::plugins::gnss_velocity {

/// Compares the course of the antenna with the heading of the body. If the odometry has speed v and
/// yaw rate w, an antenna at a moves at (v - w a_y, w a_x), all in the body frame. So
///   e = wrap(heading + atan2(w a_x, v - w a_y) - course).
/// Radians. The course is given as a heading, counter-clockwise from grid east. The model assumes
/// that the body point does not slip sideways. Reversing needs no special case: v < 0 turns the
/// velocity by half a turn.
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

  /// Returns the direction of the antenna's velocity in the body frame; 0 if the antenna stands.
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

/// Compares the Doppler speed with the distance of the antenna between two poses, dt apart:
///   e = |A_to - A_from| - speed dt,  A = p + R antenna.
/// Metres. The chord replaces the arc. It is shorter by the fraction (w dt)^2 / 24: 1e-4 for 0.5
/// rad/s and 0.1 s.
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
