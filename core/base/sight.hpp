/// Sights: what the measurement of an edge says about the place of a point, without any values. An
/// edge type that joins a pose and a point gives one by its optional member
/// @code
///   Sight sight() const;
/// @endcode
/// Initial guesses place points by it (types_se2/start).
#pragma once

#include <cmath>

#include <Eigen/Core>

#include <waymark/core/base/export.hpp>

namespace WAYMARK_EXPORT waymark {

/// The second vertex of an edge as the first one sees it, in the axes of the first one: at sensor +
/// way, or, without a range, anywhere on the ray from the sensor in the direction of `way`, or, without a
/// bearing, anywhere on the circle about the sensor whose radius is the length of `way`. The error of the
/// edge is zero there, wherever the first vertex is (`waymark check --derivatives` tries it). Metres.
struct Sight {
  Eigen::Vector2d sensor = Eigen::Vector2d::Zero();
  Eigen::Vector2d way = Eigen::Vector2d::Zero();
  bool has_range = true;
  bool has_bearing = true;

  /// A point whose place in the axes of the first vertex was measured.
  [[nodiscard]] static Sight of_place(const Eigen::Vector2d& place) { return {.way = place}; }

  /// A point whose range and bearing were measured. @param bearing radians, counter-clockwise from the x axis
  [[nodiscard]] static Sight of_range(double range, double bearing,
                                      const Eigen::Vector2d& sensor = Eigen::Vector2d::Zero()) {
    return {.sensor = sensor, .way = range * Eigen::Vector2d(std::cos(bearing), std::sin(bearing))};
  }

  /// A point whose bearing alone was measured. @param bearing radians, counter-clockwise from the x axis
  [[nodiscard]] static Sight of_bearing(double bearing,
                                        const Eigen::Vector2d& sensor = Eigen::Vector2d::Zero()) {
    Sight sight = of_range(1, bearing, sensor);
    sight.has_range = false;
    return sight;
  }

  /// A point whose range alone was measured.
  [[nodiscard]] static Sight of_range_alone(double range,
                                            const Eigen::Vector2d& sensor = Eigen::Vector2d::Zero()) {
    Sight sight = of_range(range, 0, sensor);
    sight.has_bearing = false;
    return sight;
  }

  /// Tells whether one sight is enough to place the point.
  [[nodiscard]] bool has_place() const { return has_range && has_bearing; }
  /// Returns the measured place, or a point of the ray or circle.
  [[nodiscard]] Eigen::Vector2d place() const { return sensor + way; }
};

}  // namespace waymark
