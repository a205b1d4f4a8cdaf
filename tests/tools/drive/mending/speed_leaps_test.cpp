// Speeds that leap away and back as no vehicle does: found, and bridged by the speed around them.
#include <catch2/catch.hpp>

#include <random>

#include <waymark/tools/drive/mending/speed_leaps.hpp>

#include "winding_scene.hpp"

namespace speed_leaps_test {

using namespace waymark;
using namespace waymark::drive;

namespace {

/// 100 s at 25 Hz with a gentle speed, of which `damage` changes readings.
std::vector<OdometrySample> drive_with(const std::function<double(double t, double speed)>& damage) {
  std::vector<OdometrySample> odometry;
  for (int i = 0; i <= 2500; ++i) {
    const double t = 0.04 * i;
    const double speed = 12 + 3 * std::sin(0.2 * t);
    odometry.push_back(
        {.stamp = Stamp::from_seconds(t), .speed_mps = damage(t, speed), .yaw_rate_radps = 0.1});
  }
  return odometry;
}

double largest_error(const std::vector<OdometrySample>& odometry) {
  double largest = 0;
  for (const OdometrySample& sample : odometry)
    largest =
        std::max(largest, std::abs(sample.speed_mps - (12 + 3 * std::sin(0.2 * sample.stamp.seconds()))));
  return largest;
}

bool within(double t, double from, double to) {
  return t >= from && t <= to;
}

}  // namespace

TEST_CASE("speed leaps: wheels that lock or spin are bridged by the speed around them") {
  for (const double factor : {0.0, 0.3, 1.8}) {
    std::vector<OdometrySample> odometry =
        drive_with([&](double t, double speed) { return within(t, 40.02, 41.02) ? factor * speed : speed; });
    const std::vector<SpeedLeap> leaps = find_speed_leaps(odometry);
    REQUIRE(leaps.size() == 1);
    CHECK(odometry[leaps[0].first].stamp.seconds() == Approx(40.0).margin(0.3));
    CHECK(odometry[leaps[0].last].stamp.seconds() == Approx(41.0).margin(0.3));
    bridge_speed_leaps(leaps, odometry);
    // a line over 1.3 s of a speed that bends by 3 * 0.2^2 m/s^3 is off by at most 0.12 * 1.3^2 / 8
    CHECK(largest_error(odometry) < 0.026);
    CHECK(odometry[1012].assumed);
    CHECK(odometry[1012].yaw_rate_radps == 0.1);
    CHECK_FALSE(odometry[980].assumed);
  }
}

TEST_CASE("speed leaps: wheels take some samples to lock and to roll again") {
  std::vector<OdometrySample> odometry = drive_with([](double t, double speed) {
    if (within(t, 40, 40.2)) return speed * (1 - (t - 40) / 0.2);
    if (within(t, 40.2, 41)) return 0.0;
    return within(t, 41, 41.2) ? speed * (t - 41) / 0.2 : speed;
  });
  const std::vector<SpeedLeap> leaps = find_speed_leaps(odometry);
  REQUIRE(leaps.size() == 1);
  bridge_speed_leaps(leaps, odometry);
  CHECK(largest_error(odometry) < 0.1);
}

TEST_CASE("speed leaps: single wrong readings are found at 1 Hz as well") {
  std::vector<OdometrySample> odometry;
  for (int i = 0; i < 200; ++i)
    odometry.push_back({.stamp = Stamp::from_seconds(i), .speed_mps = i == 60 ? 0.0 : 25 + 0.01 * i});
  const std::vector<SpeedLeap> leaps = find_speed_leaps(odometry);
  REQUIRE(leaps.size() == 1);
  CHECK(leaps[0].first == 60);
  CHECK(leaps[0].last == 60);
  CHECK_THAT(warning_of(leaps, odometry), Catch::Contains("in 1 place of 2.0 s together, the first 60.0 s"));
}

TEST_CASE("speed leaps: what a vehicle can do is none") {
  SECTION("an emergency stop, and a start after it") {
    CHECK(find_speed_leaps(drive_with([](double t, double speed) {
            if (within(t, 40, 41.5)) return std::max(0.0, speed - 10 * (t - 40));
            return within(t, 41.5, 44) ? 4 * (t - 41.5) : speed;
          })).empty());
  }
  SECTION("a sensor that reads 0 below 1 m/s") {
    CHECK(find_speed_leaps(drive_with([](double t, double) {
            const double slow = 3 * std::abs(std::sin(0.3 * t));
            return slow < 1 ? 0 : slow;
          })).empty());
  }
  SECTION("noise of 0.5 m/s") {
    std::mt19937_64 random(3);
    std::normal_distribution<double> noise(0, 0.5);
    CHECK(find_speed_leaps(drive_with([&](double, double speed) { return speed + noise(random); })).empty());
  }
  SECTION("a speed that is rough throughout") {
    CHECK(find_speed_leaps(drive_with([](double t, double speed) {
            return std::fmod(t, 2) < 0.5 ? 0.5 * speed : speed;
          })).empty());
  }
  SECTION("a step that stays") {
    CHECK(find_speed_leaps(drive_with([](double t, double speed) {
            return t > 50 ? speed + 8 : speed;
          })).empty());
  }
}

}  // namespace speed_leaps_test
