/// Geodetic to metric: one fixed UTM zone with a local origin, grid scale and meridian convergence applied.
#pragma once

#include <optional>

#include <Eigen/Core>

#include <waymark/core/drive/frame.hpp>
#include <waymark/core/drive/sample.hpp>

namespace waymark::drive {

/// WGS84, degrees.
struct GeodeticPoint {
  double latitude_deg = 0;
  double longitude_deg = 0;
};

/// A point in the frame and how the grid lies there.
struct GridPoint {
  Eigen::Vector2d position = Eigen::Vector2d::Zero();  ///< frame coordinates, m
  double convergence_rad = 0;  ///< meridian convergence: bearing of grid north, clockwise from true north
  double scale = 1;            ///< grid metres per metre on the ellipsoid
};

/// The frame of a drive: the zone of its first fix (with the exceptions at Norway and Svalbard) unless
/// stated, the origin that fix's easting and northing rounded to multiples of 100 m unless stated.
/// @param zone    signed: negative is the southern hemisphere (northings from 10,000 km); 1 <= |zone| <= 60
/// @param origin  easting, northing, m
/// @throws InputError where the point is no place or lies 30 degrees of longitude or more from the zone's
/// meridian.
[[nodiscard]] Frame choose_frame(const GeodeticPoint& first_fix, std::optional<int> zone,
                                 const std::optional<Eigen::Vector2d>& origin);

/// Projects into and out of one frame, by GeographicLib's transverse Mercator (5 nm). A drive that crosses
/// the border of its zone or the equator stays in it.
///
/// Sense of angles: a direction with bearing b (clockwise from true north) has the heading pi/2 - b + gamma
/// on the grid, gamma the convergence: grid north itself (b = gamma) comes out as pi/2. Heights are not
/// reduced to the ellipsoid (a length at 500 m height comes out 8e-5 shorter).
class Projection {
 public:
  /// @throws InputError where `frame` has no zone.
  explicit Projection(const Frame& frame);

  [[nodiscard]] const Frame& frame() const { return frame_; }

  /// @throws InputError as choose_frame.
  [[nodiscard]] GridPoint to_grid(const GeodeticPoint& point) const;
  /// Inverse of to_grid. @throws InputError far outside the zone.
  [[nodiscard]] GeodeticPoint to_geodetic(const Eigen::Vector2d& position) const;

  /// Position, covariance (turned from true into grid axes, times scale squared), course as heading, scale;
  /// time, height, speed and source are kept, the rest is left as it is by default.
  [[nodiscard]] Fix project(const GeodeticFix& fix) const;
  /// Position and heading.
  [[nodiscard]] TruthPose project(const GeodeticTruth& truth) const;

 private:
  Frame frame_;
};

/// Heading on the grid of a course (clockwise from true north), in (-pi, pi].
[[nodiscard]] double grid_heading_from_course(double course_rad, double convergence_rad);
/// Heading on the grid of a heading counter-clockwise from true east, in (-pi, pi].
[[nodiscard]] double grid_heading_from_true(double heading_rad, double convergence_rad);
/// Inverse of grid_heading_from_course; in [0, 2 pi).
[[nodiscard]] double course_from_grid_heading(double heading_rad, double convergence_rad);

}  // namespace waymark::drive
