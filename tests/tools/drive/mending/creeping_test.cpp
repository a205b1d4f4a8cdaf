// Wheel sensors that read 0 below some speed: the fixes show that the vehicle creeps.
#include <catch2/catch.hpp>

#include <cmath>
#include <random>
#include <span>
#include <vector>

#include <waymark/tools/drive/mending/creeping.hpp>

#include "winding_scene.hpp"

namespace creeping_test {

using namespace waymark;
using namespace waymark::drive;
using waymark::testing::winding_scene;
using waymark::testing::WindingScene;

namespace {

constexpr double kZone = 0.7;  // m/s

/// 200 s at 6 m/s, between 80 and 100 s at a creeping speed, as a sensor with a dead zone tells it.
WindingScene scene(double creeping) {
  WindingScene result = winding_scene(
      200, [&](double t) { return t > 80 && t < 100 ? creeping : 6 + std::sin(t); },
      [](double) { return 0.01; });
  for (OdometrySample& sample : result.odometry)
    if (sample.speed_mps < kZone) sample.speed_mps = 0;
  for (int i = 0; i < 20; ++i)  // a start shows the edge of the zone
    result.odometry[static_cast<std::size_t>(i)].speed_mps = kZone + 0.3 * i;
  return result;
}

}  // namespace

TEST_CASE("creeping: a vehicle that creeps within the dead zone gets the speed of the fixes") {
  WindingScene made = scene(0.5);
  CHECK(dead_zone_mps(made.odometry) == Approx(kZone).margin(0.31));
  const std::vector<Creeping> found = find_creeping(made.odometry, made.fixes);
  REQUIRE(found.size() == 1);
  CHECK(made.odometry[found[0].first].stamp.seconds() == Approx(80).margin(0.11));
  CHECK(found[0].speed_mps == Approx(0.5).epsilon(0.01));
  CHECK_THAT(warning_of(found, made.odometry),
             Catch::Contains("the fixes move by 10 m while it reads 0, in 1 place"));
  creep(found, made.odometry);
  CHECK(made.odometry[900].speed_mps == found[0].speed_mps);
  CHECK(made.odometry[900].assumed);
}

TEST_CASE("creeping: a vehicle that stands has fixes that drift, and no speed") {
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal(0, 1);
  WindingScene made = scene(0);
  Eigen::Vector2d drift(0, 0);  // 2 m that last 30 s
  for (Fix& fix : made.fixes) {
    drift = std::exp(-1.0 / 30) * drift +
            2 * std::sqrt(1 - std::exp(-2.0 / 30)) * Eigen::Vector2d(normal(random), normal(random));
    fix.position += drift;
    fix.covariance = 4 * Eigen::Matrix2d::Identity();
  }
  CHECK(find_creeping(made.odometry, made.fixes).empty());
}

TEST_CASE("creeping: fixes that wander while the receiver has lost its corrections are no way") {
  WindingScene made = scene(0);
  const Eigen::Vector2d ahead = (made.fixes[79].position - made.fixes[75].position).normalized();
  for (std::size_t i = 0; i < made.fixes.size(); ++i) {
    Fix& fix = made.fixes[i];
    fix.covariance = 1e-4 * Eigen::Matrix2d::Identity();
    if (i < 85 || i > 99) continue;
    fix.position += 0.08 * static_cast<double>(i - 85) * ahead;
    fix.covariance = 4 * Eigen::Matrix2d::Identity();
  }
  CHECK(find_creeping(made.odometry, made.fixes).empty());
  for (Fix& fix : made.fixes) fix.covariance = 1e-4 * Eigen::Matrix2d::Identity();
  CHECK(find_creeping(made.odometry, made.fixes).size() == 1);
}

TEST_CASE("creeping: a sensor without a dead zone is believed") {
  WindingScene made = scene(0.5);
  for (std::size_t i = 0; i < 20; ++i) made.odometry[i].speed_mps = 0.05 + 0.3 * static_cast<double>(i);
  made.odometry[21].speed_mps = 0.02;
  made.odometry[22].speed_mps = 0.04;
  CHECK(dead_zone_mps(made.odometry) == 0);
  CHECK(find_creeping(made.odometry, made.fixes).empty());
}

namespace {

/// A minute at 6 m/s, a stop from 60 to 80 s, and a minute more: it brakes at 2 m/s^2 and starts at 1.
double speed_with_stop(double t) {
  if (t < 57) return 6;
  if (t < 60) return 2 * (60 - t);
  if (t < 80) return 0;
  return std::min(6.0, t - 80);
}

double way_of(std::span<const OdometrySample> odometry) {
  double way_m = 0;
  for (std::size_t i = 1; i < odometry.size(); ++i)
    way_m += 0.5 * (odometry[i - 1].speed_mps + odometry[i].speed_mps) *
             seconds_between(odometry[i - 1].stamp, odometry[i].stamp);
  return way_m;
}

}  // namespace

TEST_CASE("creeping: speeds pass a dead zone as they came to its edge") {
  const double sign = GENERATE(1.0, -1.0);
  WindingScene made = winding_scene(
      140, [&](double t) { return sign * speed_with_stop(t); }, [](double) { return 0.01; });
  const double driven_m = way_of(made.odometry);
  for (OdometrySample& sample : made.odometry)
    if (std::abs(sample.speed_mps) < kZone) sample.speed_mps = 0;
  // Braking it loses 0.7^2 / 4 m, starting 0.7^2 / 2.
  CHECK(std::abs(driven_m - way_of(made.odometry)) == Approx(0.37).margin(0.1));
  pass_dead_zone(made.odometry);
  CHECK(way_of(made.odometry) == Approx(driven_m).margin(0.03));
  for (const OdometrySample& sample : made.odometry) {
    const double t = sample.stamp.seconds();
    CHECK(sample.speed_mps == Approx(sign * speed_with_stop(t)).margin(0.02));
    CHECK(sample.assumed == (std::abs(sample.speed_mps) > 0 && std::abs(sample.speed_mps) < kZone - 0.01));
  }
}

TEST_CASE("creeping: speeds that reach 0 by themselves, and ones that leap to it, stay") {
  WindingScene smooth = winding_scene(140, speed_with_stop, [](double) { return 0.01; });
  WindingScene leap = winding_scene(
      140, [](double t) { return t > 60 && t < 80 ? 0 : 6 + std::sin(t); }, [](double) { return 0.01; });
  for (WindingScene* made : {&smooth, &leap}) {
    const std::vector<OdometrySample> before = made->odometry;
    pass_dead_zone(made->odometry);
    for (std::size_t i = 0; i < before.size(); ++i) {
      CHECK(made->odometry[i].speed_mps == before[i].speed_mps);
      CHECK_FALSE(made->odometry[i].assumed);
    }
  }
}

}  // namespace creeping_test
