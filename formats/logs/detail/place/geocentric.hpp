/// Earth-centred and geodetic coordinates of WGS84. GeographicLib has these two functions too. But
/// everyone who links the log readers would inherit the dependency.
#pragma once

#include <Eigen/Core>

namespace waymark::formats {

/// A place on or near the ellipsoid.
struct GeodeticPlace {
  double latitude_deg = 0;
  double longitude_deg = 0;
  double height_m = 0;  ///< above the ellipsoid
};

/// The formula is exact (Torge, Geodesy, 4.27).
[[nodiscard]] Eigen::Vector3d ecef_from_geodetic(const GeodeticPlace& place);
/// Bowring's iteration for the parametric latitude (Survey Review 23, 1976), three times. It is
/// exact to 1e-9 m from 100 km below the ellipsoid to 1000 km above it, also at the poles.
[[nodiscard]] GeodeticPlace geodetic_from_ecef(const Eigen::Vector3d& ecef);
/// Returns the rotation whose rows are east, north and up at a place.
[[nodiscard]] Eigen::Matrix3d enu_from_ecef(double latitude_deg, double longitude_deg);

}  // namespace waymark::formats
