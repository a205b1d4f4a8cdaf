#include <waymark/formats/logs/detail/place/geocentric.hpp>

#include <cmath>

#include <waymark/core/base/angle.hpp>

namespace waymark::formats {
namespace {

constexpr double kSemiMajor = 6378137;
constexpr double kFlattening = 1 / 298.257223563;
constexpr double kEccentricity2 = kFlattening * (2 - kFlattening);
constexpr double kSemiMinor = kSemiMajor * (1 - kFlattening);
constexpr double kSecondEccentricity2 = kEccentricity2 / (1 - kEccentricity2);

}  // namespace

Eigen::Vector3d ecef_from_geodetic(const GeodeticPlace& place) {
  const double sine = std::sin(kDegree * place.latitude_deg);
  const double cosine = std::cos(kDegree * place.latitude_deg);
  const double longitude = kDegree * place.longitude_deg;
  const double normal = kSemiMajor / std::sqrt(1 - kEccentricity2 * sine * sine);
  const double from_axis = (normal + place.height_m) * cosine;
  return {from_axis * std::cos(longitude), from_axis * std::sin(longitude),
          (normal * (1 - kEccentricity2) + place.height_m) * sine};
}

GeodeticPlace geodetic_from_ecef(const Eigen::Vector3d& ecef) {
  const double from_axis = std::hypot(ecef.x(), ecef.y());
  double parametric = std::atan2(ecef.z(), (1 - kFlattening) * from_axis);
  double latitude = 0;
  for (int i = 0; i < 3; ++i) {
    const double sine = std::sin(parametric);
    const double cosine = std::cos(parametric);
    latitude = std::atan2(ecef.z() + kSecondEccentricity2 * kSemiMinor * sine * sine * sine,
                          from_axis - kEccentricity2 * kSemiMajor * cosine * cosine * cosine);
    parametric = std::atan2((1 - kFlattening) * std::sin(latitude), std::cos(latitude));
  }
  const double sine = std::sin(latitude);
  const double height = from_axis * std::cos(latitude) + ecef.z() * sine -
                        kSemiMajor * std::sqrt(1 - kEccentricity2 * sine * sine);
  return {latitude / kDegree, std::atan2(ecef.y(), ecef.x()) / kDegree, height};
}

Eigen::Matrix3d enu_from_ecef(double latitude_deg, double longitude_deg) {
  const double sin_lat = std::sin(kDegree * latitude_deg);
  const double cos_lat = std::cos(kDegree * latitude_deg);
  const double sin_lon = std::sin(kDegree * longitude_deg);
  const double cos_lon = std::cos(kDegree * longitude_deg);
  Eigen::Matrix3d rotation;
  rotation << -sin_lon, cos_lon, 0,                     //
      -sin_lat * cos_lon, -sin_lat * sin_lon, cos_lat,  //
      cos_lat * cos_lon, cos_lat * sin_lon, sin_lat;
  return rotation;
}

}  // namespace waymark::formats
