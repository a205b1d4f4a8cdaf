// Speeds that are a wrong multiple for some of the drive, and what only looks like it.
#include <cmath>
#include <random>
#include <vector>

#include <catch2/catch.hpp>

#include <waymark/tools/drive/mending/factor_change.hpp>

#include "winding_scene.hpp"

namespace factor_change_test {

using namespace waymark;
using namespace waymark::drive;
using waymark::testing::winding_scene;
using waymark::testing::WindingScene;

namespace {

double speed_at(double t) {
  return 10 + 4 * std::sin(t / 9);
}

/// Ten minutes of bends with fixes that are good to 2 m. @param factor of the readings at a time
WindingScene scene(const std::function<double(double)>& factor) {
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal(0, 2);
  WindingScene result = winding_scene(600, speed_at, [](double t) { return 0.2 * std::sin(t / 7); });
  for (OdometrySample& sample : result.odometry) sample.speed_mps *= factor(sample.stamp.seconds());
  for (Fix& fix : result.fixes) {
    fix.position += Eigen::Vector2d(normal(random), normal(random));
    fix.covariance = 4 * Eigen::Matrix2d::Identity();
  }
  return result;
}

}  // namespace

TEST_CASE("factor change: it is found with its time, and taken back") {
  for (const double factor : {3.6, 0.2778, 0.5, 2.237}) {
    CAPTURE(factor);
    WindingScene drive = scene([&](double t) { return t >= 200 && t < 400 ? factor : 1; });
    const std::vector<FactorChange> found = find_factor_changes(drive.odometry, drive.fixes);
    REQUIRE(found.size() == 1);
    CHECK(found[0].factor == Approx(1 / factor).epsilon(0.015));
    // fixes that are good to 2 m know it to a second, and the readings leap
    CHECK(drive.odometry[found[0].first].stamp.seconds() == Approx(200).margin(0.01));
    CHECK(drive.odometry[found[0].last].stamp.seconds() == Approx(399.9).margin(0.01));
    CHECK_THAT(warning_of(found[0], drive.odometry), Catch::Contains("check the unit of the speed"));
    take_factors(found, drive.odometry);
    for (const OdometrySample& sample : drive.odometry) {
      const double t = sample.stamp.seconds();
      CHECK(sample.speed_mps == Approx(speed_at(t)).epsilon(0.015));
    }
  }
}

TEST_CASE("factor change: one that lasts to the end, or from the start, reaches them") {
  const WindingScene late = scene([](double t) { return t >= 350 ? 3.6 : 1; });
  const auto found = find_factor_changes(late.odometry, late.fixes);
  REQUIRE(found.size() == 1);
  CHECK(found[0].last + 1 == late.odometry.size());
  const WindingScene early = scene([](double t) { return t < 250 ? 0.5 : 1; });
  REQUIRE(find_factor_changes(early.odometry, early.fixes).size() == 1);
  CHECK(find_factor_changes(early.odometry, early.fixes)[0].first == 0);
}

TEST_CASE("factor change: a sound drive has none, nor one with a wrong unit all the time") {
  for (const double factor : {1.0, 3.6, 0.5}) {
    const WindingScene drive = scene([&](double) { return factor; });
    CHECK(find_factor_changes(drive.odometry, drive.fixes).empty());
  }
}

TEST_CASE("factor change: fixes that run away for a minute are none, nor are wheels that slip by a fifth") {
  WindingScene away = scene([](double) { return 1; });
  for (Fix& fix : away.fixes) {
    const double t = fix.stamp.seconds();
    if (t > 300 && t < 360) fix.position += Eigen::Vector2d(8 * (t - 300), 5 * std::sin(t) * (t - 300) / 10);
  }
  CHECK(find_factor_changes(away.odometry, away.fixes).empty());
  const WindingScene slip = scene([](double t) { return t > 200 && t < 400 ? 1.2 : 1; });
  CHECK(find_factor_changes(slip.odometry, slip.fixes).empty());
}

}  // namespace factor_change_test
