#include <waymark/formats/logs/detail/place/utm.hpp>

#include <cmath>

#include <GeographicLib/TransverseMercator.hpp>

#include <waymark/core/base/angle.hpp>

namespace waymark::formats {
namespace {

using GeographicLib::TransverseMercator;

constexpr double kFalseEasting = 500'000;      // m
constexpr double kFalseNorthing = 10'000'000;  // of the southern hemisphere, m
// degrees of longitude from the zone's central meridian
constexpr double kWidestOffset = 30;
constexpr double kFarthest = 5'000'000;  // m, an easting of about that offset or more

double central_meridian_deg(int zone) {
  return 6.0 * zone - 183;
}

Eigen::Vector2d false_origin(bool north) {
  return {kFalseEasting, north ? 0 : kFalseNorthing};
}

Eigen::Matrix2d turned(const Eigen::Matrix2d& covariance, double angle_rad, double scale) {
  const double c = std::cos(angle_rad);
  const double s = std::sin(angle_rad);
  Eigen::Matrix2d turn;
  turn << c, -s, s, c;
  const Eigen::Matrix2d result = scale * scale * turn * covariance * turn.transpose();
  return 0.5 * (result + result.transpose());
}

}  // namespace

// UTMUPS of GeographicLib would refuse eastings beyond 1000 km, and count northings by the
// hemisphere of the point.
std::optional<UtmPlace> utm_from_geodetic(double latitude_deg, double longitude_deg, int zone, bool north) {
  const double meridian = central_meridian_deg(zone);
  const double offset = std::remainder(longitude_deg - meridian, 360);
  // The comparisons fail for NaN.
  if (!(std::abs(latitude_deg) <= 90 && std::abs(offset) <= kWidestOffset)) return std::nullopt;
  UtmPlace place{.latitude_deg = latitude_deg, .longitude_deg = longitude_deg};
  double convergence_deg = 0;
  TransverseMercator::UTM().Forward(meridian, latitude_deg, longitude_deg, place.grid.x(), place.grid.y(),
                                    convergence_deg, place.axes.scale);
  place.grid += false_origin(north);
  place.axes.convergence_rad = convergence_deg * kDegree;
  return place;
}

std::optional<UtmPlace> utm_from_grid(const Eigen::Vector2d& grid, int zone, bool north) {
  const Eigen::Vector2d map = grid - false_origin(north);
  if (!(std::abs(map.x()) <= kFarthest && std::abs(map.y()) <= 2 * kFarthest)) return std::nullopt;
  UtmPlace place{.grid = grid};
  double convergence_deg = 0;
  TransverseMercator::UTM().Reverse(central_meridian_deg(zone), map.x(), map.y(), place.latitude_deg,
                                    place.longitude_deg, convergence_deg, place.axes.scale);
  place.axes.convergence_rad = convergence_deg * kDegree;
  return place;
}

// A vector in true axes is turned counter-clockwise by the convergence to become one on the grid.
Eigen::Matrix2d covariance_on_grid(const Eigen::Matrix2d& covariance_en, const GridAxes& axes) {
  return turned(covariance_en, axes.convergence_rad, axes.scale);
}

Eigen::Matrix2d covariance_from_grid(const Eigen::Matrix2d& covariance, const GridAxes& axes) {
  return turned(covariance, -axes.convergence_rad, 1 / axes.scale);
}

}  // namespace waymark::formats
