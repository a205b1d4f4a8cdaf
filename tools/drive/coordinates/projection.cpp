#include <waymark/tools/drive/coordinates/projection.hpp>

#include <cmath>
#include <numbers>

#include <fmt/format.h>
#include <GeographicLib/Geocentric.hpp>
#include <GeographicLib/UTMUPS.hpp>

#include <waymark/core/base/angle.hpp>
#include <waymark/core/base/error.hpp>
#include <waymark/formats/logs/detail/place/utm.hpp>
#include <waymark/types_se2/se2.hpp>

namespace waymark::drive {
namespace {

using formats::UtmPlace;
using GeographicLib::Geocentric;
using GeographicLib::UTMUPS;
using std::numbers::pi;

constexpr double kOriginStep = 100;  // m

UtmPlace forward(const GeodeticPoint& point, int zone, bool north) {
  const std::optional<UtmPlace> place =
      formats::utm_from_geodetic(point.latitude_deg, point.longitude_deg, zone, north);
  if (!place)
    throw InputError(fmt::format(
        "latitude {}, longitude {} cannot be projected into UTM zone {}{}; leave the wrong places out ('time: "
        "{{from, to}}'), or state 'frame: {{utm_zone: ...}}'",
        point.latitude_deg, point.longitude_deg, zone, north ? 'N' : 'S'));
  return *place;
}

Eigen::Vector2d origin_of(const Frame& frame) {
  return {frame.origin_easting_m, frame.origin_northing_m};
}

}  // namespace

Frame choose_frame(const GeodeticPoint& first_fix, std::optional<int> zone,
                   const std::optional<Eigen::Vector2d>& origin) {
  Frame frame;
  frame.zone = zone ? std::abs(*zone)
                    : UTMUPS::StandardZone(first_fix.latitude_deg, first_fix.longitude_deg, UTMUPS::UTM);
  frame.north = zone ? *zone > 0 : first_fix.latitude_deg >= 0;
  const Eigen::Vector2d first = forward(first_fix, frame.zone, frame.north).grid;
  const Eigen::Vector2d rounded = kOriginStep * (first / kOriginStep).array().round().matrix();
  frame.origin_easting_m = origin ? origin->x() : rounded.x();
  frame.origin_northing_m = origin ? origin->y() : rounded.y();
  return frame;
}

Projection::Projection(const Frame& frame) : frame_(frame) {
  if (frame.zone < 1 || frame.zone > 60)
    throw InputError(
        fmt::format("a frame without a UTM zone (zone {}) has no geodetic position", frame.zone));
}

GridPoint Projection::to_grid(const GeodeticPoint& point) const {
  const UtmPlace place = forward(point, frame_.zone, frame_.north);
  return {place.grid - origin_of(frame_), place.axes.convergence_rad, place.axes.scale};
}

GeodeticPoint Projection::to_geodetic(const Eigen::Vector2d& position) const {
  const Eigen::Vector2d grid = position + origin_of(frame_);
  const std::optional<UtmPlace> place = formats::utm_from_grid(grid, frame_.zone, frame_.north);
  if (!place)
    throw InputError(
        fmt::format("easting {}, northing {} are outside UTM zone {}", grid.x(), grid.y(), frame_.zone));
  return {place->latitude_deg, place->longitude_deg};
}

Eigen::Vector3d Projection::to_ecef(const PointWithHeight& point) const {
  const GeodeticPoint place = to_geodetic(point.position);
  Eigen::Vector3d ecef;
  Geocentric::WGS84().Forward(place.latitude_deg, place.longitude_deg, point.height_m, ecef.x(), ecef.y(),
                              ecef.z());
  return ecef;
}

PointWithHeight Projection::from_ecef(const Eigen::Vector3d& point) const {
  GeodeticPoint place;
  double height_m = 0;
  Geocentric::WGS84().Reverse(point.x(), point.y(), point.z(), place.latitude_deg, place.longitude_deg,
                              height_m);
  return {to_grid(place).position, height_m};
}

Fix Projection::project(const GeodeticFix& fix) const {
  const GridPoint grid = to_grid({fix.latitude_deg, fix.longitude_deg});
  Fix result;
  result.stamp = fix.stamp;
  result.position = grid.position;
  result.covariance = formats::covariance_on_grid(fix.covariance_en, {grid.convergence_rad, grid.scale});
  result.accuracy_claimed = fix.accuracy_claimed;
  if (fix.course_rad) result.heading_rad = grid_heading_from_course(*fix.course_rad, grid.convergence_rad);
  result.heading_sigma_rad = fix.course_sigma_rad;
  result.speed_mps = fix.speed_mps;
  result.speed_sigma_mps = fix.speed_sigma_mps;
  result.height_m = fix.height_m;
  result.grid_scale = grid.scale;
  result.source = fix.source;
  result.told = fix.told;
  return result;
}

TruthPose Projection::project(const GeodeticTruth& truth) const {
  const GridPoint grid = to_grid({truth.latitude_deg, truth.longitude_deg});
  TruthPose result;
  result.stamp = truth.stamp;
  result.position = grid.position;
  result.height_m = truth.height_m;
  if (truth.heading_rad)
    result.heading_rad = grid_heading_from_true(*truth.heading_rad, grid.convergence_rad);
  return result;
}

GeodeticPoint geodetic_from_ecef(const Eigen::Vector3d& point) {
  GeodeticPoint place;
  double height_m = 0;
  Geocentric::WGS84().Reverse(point.x(), point.y(), point.z(), place.latitude_deg, place.longitude_deg,
                              height_m);
  return place;
}

double grid_heading_from_course(double course_rad, double convergence_rad) {
  return wrap_angle(pi / 2 - course_rad + convergence_rad);
}

double grid_heading_from_true(double heading_rad, double convergence_rad) {
  return wrap_angle(heading_rad + convergence_rad);
}

double course_from_grid_heading(double heading_rad, double convergence_rad) {
  const double course = std::fmod(pi / 2 - heading_rad + convergence_rad, 2 * pi);
  return course < 0 ? course + 2 * pi : course;
}

}  // namespace waymark::drive
