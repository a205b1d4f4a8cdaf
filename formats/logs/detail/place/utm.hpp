/// Places in UTM: one transverse Mercator map for readers of metric positions and for the
/// projection of a drive, so that each undoes the other exactly.
#pragma once

#include <optional>

#include <Eigen/Core>

namespace waymark::formats {

/// The axes of a grid at a place. The default is that of true axes, in metres on the ellipsoid.
struct GridAxes {
  /// meridian convergence: bearing of grid north, clockwise from true north
  double convergence_rad = 0;
  double scale = 1;  ///< grid metres per metre on the ellipsoid
};

/// A place on WGS84 and in a UTM zone.
struct UtmPlace {
  double latitude_deg = 0;
  double longitude_deg = 0;
  Eigen::Vector2d grid = Eigen::Vector2d::Zero();  ///< UTM easting and northing, m
  GridAxes axes{};
};

/// Projects with GeographicLib's transverse Mercator (5 nm). Neither the border of the zone nor the
/// equator ends the map.
/// @param zone 1..60; @param north hemisphere; in the southern one northings count from -10,000 km
/// @return empty if the latitude is none, or at 30 degrees of longitude or more from the meridian
/// of the zone
[[nodiscard]] std::optional<UtmPlace> utm_from_geodetic(double latitude_deg, double longitude_deg, int zone,
                                                        bool north);
/// The inverse. @param grid UTM easting and northing, m
/// @return empty beyond 5,000 km from the meridian or 10,000 km from the equator
[[nodiscard]] std::optional<UtmPlace> utm_from_grid(const Eigen::Vector2d& grid, int zone, bool north);

/// Turns a covariance [m^2] from true axes (east, north) to those of the grid, in grid metres.
[[nodiscard]] Eigen::Matrix2d covariance_on_grid(const Eigen::Matrix2d& covariance_en, const GridAxes& axes);
/// The inverse of covariance_on_grid.
[[nodiscard]] Eigen::Matrix2d covariance_from_grid(const Eigen::Matrix2d& covariance, const GridAxes& axes);

}  // namespace waymark::formats
