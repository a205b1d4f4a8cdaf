#include <waymark/plugins/gnss_raw/detail/local_sky.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include <Eigen/Geometry>

namespace waymark::plugins::gnss_raw {

LocalSky::LocalSky(const PointWithHeight& reference, bool turned, const Geodesy& geodesy)
    : reference_(reference.position.x(), reference.position.y(), reference.height_m),
      ecef_(geodesy.to_ecef(reference)),
      turned_(turned) {
  constexpr double kDegree = std::numbers::pi / 180;
  const GeodeticPoint place = geodesy.to_geodetic(reference.position);
  const GridPoint grid = geodesy.to_grid(place);
  const double latitude = kDegree * place.latitude_deg;
  const double longitude = kDegree * place.longitude_deg;
  const Eigen::Vector3d east(-std::sin(longitude), std::cos(longitude), 0);
  const Eigen::Vector3d up(std::cos(latitude) * std::cos(longitude), std::cos(latitude) * std::sin(longitude),
                           std::sin(latitude));
  const Eigen::Vector3d north = up.cross(east);
  const double c = std::cos(grid.convergence_rad);
  const double s = std::sin(grid.convergence_rad);
  axes_.row(0) = c * east - s * north;
  axes_.row(1) = s * east + c * north;
  axes_.row(2) = up;
  ground_ = 1 / grid.scale;
}

Eigen::Vector3d LocalSky::local(const Eigen::Vector3d& satellite) const {
  const double travel_s = turned_ ? 0 : (satellite - ecef_).norm() / kLight_mps;
  return axes_ * (turned_with_earth(satellite, travel_s) - ecef_);
}

Eigen::Vector3d LocalSky::local_velocity(const Eigen::Vector3d& velocity, double range_m) const {
  return axes_ * turned_with_earth(velocity, turned_ ? 0 : range_m / kLight_mps);
}

double LocalSky::common_offset_m(const Epoch& epoch) const {
  std::vector<double> offsets;
  for (const SatelliteReading& reading : epoch.satellites)
    if (!std::isnan(reading.pseudorange_m))
      offsets.push_back(reading.pseudorange_m - local(reading.position).norm());
  if (offsets.empty()) return std::numeric_limits<double>::quiet_NaN();
  const auto middle = offsets.begin() + static_cast<std::ptrdiff_t>(offsets.size() / 2);
  std::nth_element(offsets.begin(), middle, offsets.end());
  return *middle;
}

}  // namespace waymark::plugins::gnss_raw
