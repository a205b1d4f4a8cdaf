// Wheel sensors that read 0 below some speed: the fixes show that the vehicle creeps.
#include <catch2/catch.hpp>

#include <cmath>
#include <random>
#include <span>
#include <vector>

#include <waymark/tools/drive/mending/creeping.hpp>
#include <waymark/tools/drive/nodes/timeline.hpp>

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

/// Every 140 s a minute at 6 m/s, a stop from 60 to 80 s, and a minute more: it brakes at 2 m/s^2 and starts at 1.
double speed_with_stops(double time) {
  const double t = std::fmod(time, 140);
  if (t < 57) return 6;
  if (t < 60) return 2 * (60 - t);
  if (t < 80) return 0;
  return std::min(6.0, t - 80);
}

constexpr int kStops = 3;

WindingScene with_stops(double sign = 1) {
  return winding_scene(
      140 * kStops, [&](double t) { return sign * speed_with_stops(t); }, [](double) { return 0.01; });
}

double way_of(std::span<const OdometrySample> odometry) {
  double way_m = 0;
  for (std::size_t i = 1; i < odometry.size(); ++i)
    way_m += 0.5 * (odometry[i - 1].speed_mps + odometry[i].speed_mps) *
             seconds_between(odometry[i - 1].stamp, odometry[i].stamp);
  return way_m;
}

void check_kept(std::vector<OdometrySample> odometry) {
  const std::vector<OdometrySample> before = odometry;
  CHECK(pass_dead_zone(odometry).edges == 0);
  for (std::size_t i = 0; i < before.size(); ++i) {
    CHECK(odometry[i].speed_mps == before[i].speed_mps);
    CHECK(odometry[i].distance_variance_per_s == 0);
  }
}

}  // namespace

TEST_CASE("creeping: speeds pass a dead zone as they came to its edge") {
  const double sign = GENERATE(1.0, -1.0);
  WindingScene made = with_stops(sign);
  const double driven_m = way_of(made.odometry);
  for (OdometrySample& sample : made.odometry)
    if (std::abs(sample.speed_mps) < kZone) sample.speed_mps = 0;
  // Braking it loses 0.7^2 / 4 m, starting 0.7^2 / 2.
  const double unseen_m = std::abs(driven_m - way_of(made.odometry));
  CHECK(unseen_m == Approx(0.37 * kStops).margin(0.1 * kStops));
  const PassedZone passed = pass_dead_zone(made.odometry);
  CHECK(passed.edges == 2 * kStops);
  CHECK(passed.way_m == Approx(unseen_m).epsilon(0.3));
  CHECK_THAT(note_of(passed), Catch::Contains("at 6 stops and starts"));
  CHECK(way_of(made.odometry) == Approx(driven_m).margin(0.03 * kStops));
  for (const OdometrySample& sample : made.odometry) {
    const double speed = speed_with_stops(sample.stamp.seconds());
    CHECK(sample.speed_mps == Approx(sign * speed).margin(0.02));
    CHECK((sample.distance_variance_per_s > 0) == (speed > 1e-6 && speed < kZone - 0.01));
    CHECK_FALSE(sample.assumed);  // the yaw rate is measured
  }
}

TEST_CASE("creeping: what is not known of a ramp is in the distances beside it") {
  OdometrySample left{.stamp = {0}, .speed_mps = 0.5};
  OdometrySample right{.stamp = Stamp::from_seconds(0.1), .speed_mps = 0.3};
  left.distance_variance_per_s = 0.02;
  right.distance_variance_per_s = 0.04;
  CHECK(motion_between(left, right, 1, 1, nullptr, nullptr).distance_sigma_m ==
        Approx(std::sqrt(0.03 * 0.1)));
}

TEST_CASE("creeping: speeds that reach 0 by themselves, leap to it, or are rounded have no dead zone") {
  check_kept(with_stops().odometry);
  check_kept(
      winding_scene(
          140, [](double t) { return t > 60 && t < 80 ? 0 : 6 + std::sin(t); }, [](double) { return 0.01; })
          .odometry);
  // OBD: whole km/h, once or ten times a second.
  for (const std::size_t every : {10U, 1U}) {
    const WindingScene made = with_stops();
    std::vector<OdometrySample> obd;
    for (std::size_t i = 0; i < made.odometry.size(); i += every) {
      obd.push_back(made.odometry[i]);
      obd.back().speed_mps = std::floor(3.6 * obd.back().speed_mps) / 3.6;
    }
    check_kept(obd);
  }
}

}  // namespace creeping_test
