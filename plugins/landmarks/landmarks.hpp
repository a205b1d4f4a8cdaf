/// Landmarks measured by range and bearing. EDGE_SE2_XY of types_se2 is for landmarks
/// measured by x and y.
#pragma once

#include <array>
#include <cmath>
#include <string_view>

#include <waymark/types_se2/edge_se2.hpp>

namespace waymark::plugins::landmarks {

/// A landmark at a distance and in a direction, seen from a sensor at a fixed place in
/// the body frame:
///   d = R^T (p_landmark - p) - sensor,  e = (|d| - range, wrap(atan2(d.y, d.x) - bearing)).
/// Metres and radians. The bearing counts counter-clockwise from the x axis of the body. If the
/// landmark is at the sensor, it has no direction. Both errors are then those of a landmark
/// straight ahead at distance 0, and their derivative is zero.
struct EdgeSe2XyRangeBearing {
  static constexpr std::string_view kTag = "EDGE_SE2_XY_RANGE_BEARING";
  static constexpr std::string_view kForm = "range, bearing";
  static constexpr int kErrorDimension = 2;
  using Vertices = VertexList<VertexSe2, VertexXy>;
  static constexpr bool kRelative = true;
  static constexpr auto fields() {
    return std::array{field<&EdgeSe2XyRangeBearing::measured>("measured"),
                      field<&EdgeSe2XyRangeBearing::sensor>("sensor")};
  }

  template <typename T>
  Vector2<T> error(const Pose2<T>& pose, const Vector2<T>& landmark) const {
    using std::atan2;
    const Vector2<T> seen = rotate_back(pose.heading, Vector2<T>(landmark - pose.position));
    const Vector2<T> d = seen - constant_vector<T>(sensor);
    const T range = length(d);
    const bool has_direction = range * range > T(0.0);
    const T bearing = has_direction ? T(atan2(d[1], d[0])) : T(0.0);
    return Vector2<T>(range - T(measured[0]), wrap_angle(T(bearing - T(measured[1]))));
  }

  [[nodiscard]] Sight sight() const { return Sight::of_range(measured[0], measured[1], sensor); }

  Eigen::Vector2d measured = Eigen::Vector2d::Zero();  ///< range, bearing
  Eigen::Vector2d sensor = Eigen::Vector2d::Zero();    ///< in the body frame: x forward, y left
};

}  // namespace waymark::plugins::landmarks
