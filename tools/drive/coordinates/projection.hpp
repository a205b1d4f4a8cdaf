/// Projects geodetic to metric coordinates: one fixed UTM zone with a local origin, grid scale and
/// meridian convergence applied.
#pragma once

#include <optional>

#include <Eigen/Core>

#include <waymark/core/drive/drive_context.hpp>
#include <waymark/core/drive/frame.hpp>
#include <waymark/core/drive/sample.hpp>

namespace waymark::drive {

/// Chooses the frame of a drive. Unless stated, the zone is that of the first fix (with the
/// exceptions at Norway and Svalbard), and the origin is that fix's easting and northing, rounded
/// to multiples of 100 m.
/// @param zone signed: negative is the southern hemisphere (northings from 10,000 km); 1 <=
/// |zone| <= 60
/// @param origin easting, northing, m
/// @throws InputError if the point is no place, or is 30 degrees of longitude or more from the
/// meridian of the zone
[[nodiscard]] Frame choose_frame(const GeodeticPoint& first_fix, std::optional<int> zone,
                                 const std::optional<Eigen::Vector2d>& origin);

/// Projects into and out of one frame, with GeographicLib's transverse Mercator (5 nm). A drive
/// that crosses the border of its zone or the equator stays in it.
///
/// Sense of angles: a direction with bearing b (clockwise from true north) has the heading pi/2
/// - b + gamma on the grid, where gamma is the convergence. So grid north (b = gamma) has
/// heading pi/2. Heights are not reduced to the ellipsoid (at a height of 500 m, lengths are
/// shorter by 8e-5).
class Projection final : public Geodesy {
 public:
  /// @throws InputError if `frame` has no zone
  explicit Projection(const Frame& frame);

  [[nodiscard]] const Frame& frame() const override { return frame_; }
  [[nodiscard]] GridPoint to_grid(const GeodeticPoint& point) const override;
  [[nodiscard]] GeodeticPoint to_geodetic(const Eigen::Vector2d& position) const override;
  [[nodiscard]] Eigen::Vector3d to_ecef(const PointWithHeight& point) const override;
  [[nodiscard]] PointWithHeight from_ecef(const Eigen::Vector3d& point) const override;

  /// Projects position, covariance (turned from true to grid axes, times scale squared), course
  /// (as heading) and scale. Time, height, speed and source are copied. Other members keep
  /// their defaults.
  [[nodiscard]] Fix project(const GeodeticFix& fix) const;
  /// Projects position and heading.
  [[nodiscard]] TruthPose project(const GeodeticTruth& truth) const;

 private:
  Frame frame_;
};

/// Returns the place of an Earth-centred, Earth-fixed point, m.
[[nodiscard]] GeodeticPoint geodetic_from_ecef(const Eigen::Vector3d& point);

/// Returns the heading on the grid for a course (clockwise from true north), in (-pi, pi].
[[nodiscard]] double grid_heading_from_course(double course_rad, double convergence_rad);
/// Returns the heading on the grid for a heading counter-clockwise from true east, in (-pi, pi].
[[nodiscard]] double grid_heading_from_true(double heading_rad, double convergence_rad);
/// The inverse of grid_heading_from_course, in [0, 2 pi).
[[nodiscard]] double course_from_grid_heading(double heading_rad, double convergence_rad);

}  // namespace waymark::drive
