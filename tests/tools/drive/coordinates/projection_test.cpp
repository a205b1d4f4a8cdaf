#include <catch2/catch.hpp>

#include <cmath>
#include <numbers>

#include <Eigen/LU>

#include <waymark/core/base/error.hpp>
#include <waymark/tools/drive/coordinates/projection.hpp>

namespace projection_test {

using namespace waymark;
using namespace waymark::drive;
using Catch::Matchers::Message;
using std::numbers::pi;

namespace {

constexpr double kDegree = pi / 180;

Projection utm(int zone, bool north = true) {
  return Projection(Frame{.zone = zone, .north = north});
}

/// Metres on WGS84 per radian of latitude and of longitude.
Eigen::Vector2d metres_per_radian(double latitude_deg) {
  const double a = 6378137;
  const double e2 = 0.00669437999014;
  const double s = std::sin(latitude_deg * kDegree);
  const double w = std::sqrt(1 - e2 * s * s);
  return {a * (1 - e2) / (w * w * w), a / w * std::cos(latitude_deg * kDegree)};
}

}  // namespace

TEST_CASE("projection: published coordinates") {
  // CN Tower, 43 38 33.24 N 79 23 13.7 W = 17T 630084 4833438 (the worked example of the UTM article of
  // Wikipedia).
  const Eigen::Vector2d tower =
      utm(17).to_grid({43 + 38 / 60.0 + 33.24 / 3600, -(79 + 23 / 60.0 + 13.7 / 3600)}).position;
  CHECK(tower.x() == Approx(630084).margin(1));
  CHECK(tower.y() == Approx(4833438).margin(1));
  // 33.3 N 44.4 E = 38SMB 44140 84706 (the example of GeographicLib's MGRS documentation).
  const Eigen::Vector2d baghdad = utm(38).to_grid({33.3, 44.4}).position;
  CHECK(baghdad.x() == Approx(444140.5).margin(0.5));
  CHECK(baghdad.y() == Approx(3684706.5).margin(0.5));
}

TEST_CASE("projection: on the central meridian") {
  const GridPoint equator = utm(32).to_grid({0, 9});
  CHECK(equator.position.x() == Approx(500'000).margin(1e-6));
  CHECK(equator.position.y() == Approx(0).margin(1e-6));
  CHECK(equator.scale == Approx(0.9996).epsilon(1e-12));
  CHECK(equator.convergence_rad == Approx(0).margin(1e-12));
  // The meridian arc of WGS84 from the equator to 45 degrees is 4984944.378 m.
  CHECK(utm(32).to_grid({45, 9}).position.y() == Approx(0.9996 * 4'984'944.378).margin(1e-3));
}

TEST_CASE("projection: convergence is positive east of the central meridian in the north") {
  for (const double latitude : {-40.0, 10.0, 52.5}) {
    for (const double offset : {-2.0, 1.0, 2.5}) {
      const GridPoint point = utm(33, latitude > 0).to_grid({latitude, 15 + offset});
      const double formula = std::atan(std::sin(latitude * kDegree) * std::tan(offset * kDegree));
      CHECK(point.convergence_rad == Approx(formula).margin(2e-6));
      const double x = (point.position.x() - 500'000) / 6.37e6;
      CHECK(point.scale == Approx(0.9996 * (1 + x * x / 2)).margin(5e-6));
    }
  }
}

TEST_CASE("projection: a short step along a course shows on the grid as heading and scale say") {
  const double latitude = GENERATE(52.5, -33.0);
  const double longitude = GENERATE(12.2, 17.8, 21.0);  // the last lies three degrees past the zone's border
  const double course = GENERATE(0.0, 1.0, 2.5, 4.4);
  const Projection projection = utm(33, latitude > 0);
  const double length = 1;  // m
  const Eigen::Vector2d per_radian = metres_per_radian(latitude);
  const double north = length * std::cos(course) / per_radian.x() / kDegree;
  const double east = length * std::sin(course) / per_radian.y() / kDegree;
  const GridPoint here = projection.to_grid({latitude, longitude});
  const GridPoint there = projection.to_grid({latitude + north, longitude + east});
  const Eigen::Vector2d step = there.position - here.position;
  const double heading = grid_heading_from_course(course, here.convergence_rad);
  CHECK(std::abs(std::remainder(std::atan2(step.y(), step.x()) - heading, 2 * pi)) < 1e-6);
  CHECK(step.norm() / length == Approx(here.scale).epsilon(1e-6));
  CHECK(std::abs(std::remainder(course_from_grid_heading(heading, here.convergence_rad) - course, 2 * pi)) <
        1e-12);
  CHECK(std::abs(std::remainder(grid_heading_from_true(pi / 2 - course, here.convergence_rad) - heading,
                                2 * pi)) < 1e-12);
}

TEST_CASE("projection: there and back, also past the border and across the equator") {
  for (const GeodeticPoint point :
       {GeodeticPoint{52.5, 13.4}, {56.1, 22}, {-0.01, 15}, {0.01, 15}, {-33, 16}}) {
    for (const bool north : {true, false}) {
      const Projection projection(
          Frame{.zone = 33, .north = north, .origin_easting_m = 1e5, .origin_northing_m = 2e5});
      const GeodeticPoint back = projection.to_geodetic(projection.to_grid(point).position);
      CHECK(back.latitude_deg == Approx(point.latitude_deg).margin(1e-12));
      CHECK(back.longitude_deg == Approx(point.longitude_deg).margin(1e-12));
    }
  }
  // A step over the equator is a step, not a jump by the false northing.
  const Projection north = utm(33, true);
  const double step = north.to_grid({0.001, 15}).position.y() - north.to_grid({-0.001, 15}).position.y();
  CHECK(step == Approx(0.9996 * 0.002 * kDegree * metres_per_radian(0).x()).epsilon(1e-6));
}

TEST_CASE("projection: the frame of a drive") {
  const Frame frame = choose_frame({52.5046, 13.3737}, std::nullopt, std::nullopt);
  CHECK(frame.zone == 33);
  CHECK(frame.north);
  CHECK(std::fmod(frame.origin_easting_m, 100) == 0);
  CHECK(std::fmod(frame.origin_northing_m, 100) == 0);
  const Eigen::Vector2d first = Projection(frame).to_grid({52.5046, 13.3737}).position;
  CHECK(first.cwiseAbs().maxCoeff() <= 50);

  CHECK(choose_frame({60.4, 5.3}, std::nullopt, std::nullopt).zone == 32);  // Bergen: Norway's exception
  CHECK(choose_frame({-33.9, 151.2}, std::nullopt, std::nullopt) ==
        choose_frame({-33.9, 151.2}, -56, std::nullopt));
  const Frame stated = choose_frame({52.5, 12.01}, 32, Eigen::Vector2d(690'000, 5'800'000));
  CHECK(stated ==
        Frame{.zone = 32, .north = true, .origin_easting_m = 690'000, .origin_northing_m = 5'800'000});

  CHECK_THROWS_MATCHES(
      choose_frame({52.5, -100}, 33, std::nullopt), InputError,
      Message("latitude 52.5, longitude -100 cannot be projected into UTM zone 33N; leave the wrong "
              "places out ('time: {from, to}'), or state 'frame: {utm_zone: ...}'"));
  CHECK_THROWS_MATCHES(Projection(Frame{}), InputError,
                       Message("a frame without a UTM zone (zone 0) has no geodetic position"));
}

TEST_CASE("projection: a fix keeps what has no direction and turns what has") {
  GeodeticFix fix;
  fix.stamp = Stamp{17};
  fix.latitude_deg = 52.5;
  fix.longitude_deg = 17.5;
  fix.height_m = 80;
  fix.covariance_en << 9, 0, 0, 1;
  fix.course_rad = 0;
  fix.course_sigma_rad = 0.1;
  fix.speed_mps = 3;
  fix.source = 2;
  const Projection projection = utm(33);
  const GridPoint grid = projection.to_grid({52.5, 17.5});
  const double gamma = grid.convergence_rad;
  REQUIRE(gamma > 0.03);

  const Fix result = projection.project(fix);
  CHECK(result.stamp == fix.stamp);
  CHECK(result.position == grid.position);
  CHECK(result.grid_scale == grid.scale);
  CHECK(*result.heading_rad == Approx(pi / 2 + gamma));  // true north lies left of grid north
  CHECK(*result.heading_sigma_rad == 0.1);
  CHECK(*result.speed_mps == 3);
  CHECK(result.height_m == 80);
  CHECK(result.source == 2);
  const double k2 = grid.scale * grid.scale;
  CHECK(result.covariance(0, 0) ==
        Approx(k2 * (9 * std::pow(std::cos(gamma), 2) + std::pow(std::sin(gamma), 2))));
  CHECK(result.covariance(0, 1) ==
        Approx(k2 * 8 * std::cos(gamma) * std::sin(gamma)));  // east turned to the left
  CHECK(result.covariance(1, 0) == result.covariance(0, 1));
  CHECK(result.covariance.determinant() == Approx(9 * k2 * k2));

  GeodeticTruth truth;
  truth.latitude_deg = 52.5;
  truth.longitude_deg = 17.5;
  truth.heading_rad = pi - 0.01;
  CHECK(*projection.project(truth).heading_rad == Approx(gamma - 0.01 - pi));  // wrapped
}

}  // namespace projection_test
