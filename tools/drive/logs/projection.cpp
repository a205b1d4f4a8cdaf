#include <waymark/tools/drive/logs/projection.hpp>

#include <cmath>
#include <numbers>

#include <fmt/format.h>
#include <GeographicLib/TransverseMercator.hpp>
#include <GeographicLib/UTMUPS.hpp>

#include <waymark/core/base/angle.hpp>
#include <waymark/core/base/error.hpp>
#include <waymark/types_se2/se2.hpp>

namespace waymark::drive {
namespace {

using GeographicLib::TransverseMercator;
using GeographicLib::UTMUPS;
using std::numbers::pi;

constexpr double kFalseEasting = 500'000;      // m
constexpr double kFalseNorthing = 10'000'000;  // of the southern hemisphere, m
// degrees of longitude from the zone's central meridian
constexpr double kWidestOffset = 30;
constexpr double kFarthest = 5'000'000;  // m, an easting of about that offset or more
constexpr double kOriginStep = 100;      // m

double central_meridian_deg(int zone) {
  return 6.0 * zone - 183;
}

double false_northing(bool north) {
  return north ? 0 : kFalseNorthing;
}

/// Returns UTM easting and northing. The transverse Mercator map itself has no border and no
/// equator. UTMUPS would refuse eastings beyond 1000 km, and count northings by the hemisphere
/// of the point.
GridPoint forward(const GeodeticPoint& point, int zone, bool north) {
  const double meridian = central_meridian_deg(zone);
  const double offset = std::remainder(point.longitude_deg - meridian, 360);
  const bool good = std::abs(point.latitude_deg) <= 90 && std::abs(offset) <= kWidestOffset;
  if (!good)
    throw InputError(fmt::format("latitude {}, longitude {} cannot be projected into UTM zone {}",
                                 point.latitude_deg, point.longitude_deg, zone));
  double x = 0;
  double y = 0;
  double convergence_deg = 0;
  double scale = 1;
  TransverseMercator::UTM().Forward(meridian, point.latitude_deg, point.longitude_deg, x, y, convergence_deg,
                                    scale);
  return {{x + kFalseEasting, y + false_northing(north)}, convergence_deg * kDegree, scale};
}

}  // namespace

Frame choose_frame(const GeodeticPoint& first_fix, std::optional<int> zone,
                   const std::optional<Eigen::Vector2d>& origin) {
  Frame frame;
  frame.zone = zone ? std::abs(*zone)
                    : UTMUPS::StandardZone(first_fix.latitude_deg, first_fix.longitude_deg, UTMUPS::UTM);
  frame.north = zone ? *zone > 0 : first_fix.latitude_deg >= 0;
  const Eigen::Vector2d first = forward(first_fix, frame.zone, frame.north).position;
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
  GridPoint grid = forward(point, frame_.zone, frame_.north);
  grid.position -= Eigen::Vector2d(frame_.origin_easting_m, frame_.origin_northing_m);
  return grid;
}

GeodeticPoint Projection::to_geodetic(const Eigen::Vector2d& position) const {
  const double x = position.x() + frame_.origin_easting_m - kFalseEasting;
  const double y = position.y() + frame_.origin_northing_m - false_northing(frame_.north);
  if (!(std::abs(x) <= kFarthest && std::abs(y) <= 2 * kFarthest))
    throw InputError(fmt::format("easting {}, northing {} are outside UTM zone {}", x + kFalseEasting,
                                 y + false_northing(frame_.north), frame_.zone));
  GeodeticPoint point;
  TransverseMercator::UTM().Reverse(central_meridian_deg(frame_.zone), x, y, point.latitude_deg,
                                    point.longitude_deg);
  return point;
}

Fix Projection::project(const GeodeticFix& fix) const {
  const GridPoint grid = to_grid({fix.latitude_deg, fix.longitude_deg});
  const double c = std::cos(grid.convergence_rad);
  const double s = std::sin(grid.convergence_rad);
  Eigen::Matrix2d turn;  // true east, north -> grid x, y: counter-clockwise by the convergence
  turn << c, -s, s, c;

  Fix result;
  result.stamp = fix.stamp;
  result.position = grid.position;
  const Eigen::Matrix2d turned = grid.scale * grid.scale * turn * fix.covariance_en * turn.transpose();
  result.covariance = 0.5 * (turned + turned.transpose());
  result.accuracy_claimed = fix.accuracy_claimed;
  if (fix.course_rad) result.heading_rad = grid_heading_from_course(*fix.course_rad, grid.convergence_rad);
  result.heading_sigma_rad = fix.course_sigma_rad;
  result.speed_mps = fix.speed_mps;
  result.speed_sigma_mps = fix.speed_sigma_mps;
  result.height_m = fix.height_m;
  result.grid_scale = grid.scale;
  result.source = fix.source;
  return result;
}

TruthPose Projection::project(const GeodeticTruth& truth) const {
  const GridPoint grid = to_grid({truth.latitude_deg, truth.longitude_deg});
  TruthPose result;
  result.stamp = truth.stamp;
  result.position = grid.position;
  if (truth.heading_rad)
    result.heading_rad = grid_heading_from_true(*truth.heading_rad, grid.convergence_rad);
  return result;
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
