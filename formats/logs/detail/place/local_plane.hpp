/// Places on the tangent plane of a local origin; private to the CSV reader.
#pragma once

#include <optional>

#include <Eigen/Core>

#include <waymark/core/drive/log_reader.hpp>
#include <waymark/formats/logs/detail/place/utm.hpp>

namespace waymark::formats {

/// A place on WGS84, and how the axes of the plane lie there.
struct LocalPlace {
  double latitude_deg = 0;
  double longitude_deg = 0;
  GridAxes axes{};
};

/// Converts metres east and north of an origin. The place is taken to have the height of the origin: the plane
/// rises above the ellipsoid by 8 m at 10 km.
/// @return empty at 1000 km from the origin or more
[[nodiscard]] std::optional<LocalPlace> place_on_plane(const Eigen::Vector2d& east_north_m,
                                                       const LocalOrigin& origin);

}  // namespace waymark::formats
