// A speed without a sign: the fixes tell where the vehicle drove backwards.
#include <catch2/catch.hpp>

#include <random>
#include <tuple>

#include <waymark/core/base/angle.hpp>
#include <waymark/tools/drive/mending/reversing.hpp>

#include "winding_scene.hpp"

namespace reversing_test {

using namespace waymark;
using namespace waymark::drive;
using waymark::testing::winding_scene;
using waymark::testing::WindingScene;

namespace {

/// Five ways of 40 s, each up to 5 m/s and with a stop of 5 s after it. @param backwards index of the one in reverse
double signed_speed(double t, int backwards) {
  const double at = std::fmod(t, 45);
  if (at > 40) return 0;
  const double sign = static_cast<int>(t / 45) == backwards ? -1 : 1;
  return sign * std::min({5.0, at, 40 - at});
}

double yaw_rate_at(double t) {
  return std::abs(signed_speed(t, -1)) > 0 ? 0.06 * std::sin(0.11 * t) : 0;
}

/// @param bias_radps of the gyro @param turns_radpm of an odometry whose wheels differ
WindingScene scene(int backwards, double bias_radps = 0.003, double turns_radpm = 0) {
  WindingScene result = winding_scene(
      225, [&](double t) { return signed_speed(t, backwards); }, yaw_rate_at);
  std::mt19937_64 random(5);
  std::normal_distribution<double> gyro(0, 0.002);
  for (OdometrySample& sample : result.odometry) {
    sample.speed_mps = std::abs(sample.speed_mps);
    sample.yaw_rate_radps += bias_radps + turns_radpm * sample.speed_mps + gyro(random);
  }
  return result;
}

}  // namespace

TEST_CASE("reversing: the way that is driven backwards is found, wherever it is in the drive") {
  for (int backwards = 0; backwards < 5; ++backwards) {
    WindingScene made = scene(backwards);
    const std::vector<Reversing> found = find_reversing(made.odometry, made.fixes);
    REQUIRE(found.size() == 1);
    CHECK(made.odometry[found[0].first].stamp.seconds() == Approx(45 * backwards).margin(0.21));
    CHECK(made.odometry[found[0].last].stamp.seconds() == Approx(45 * backwards + 40).margin(0.21));
    drive_backwards(found, made.odometry);
    const std::size_t middle = static_cast<std::size_t>(450 * backwards + 200);
    CHECK(made.odometry[middle].speed_mps == Approx(-5));
    CHECK(made.odometry[middle].yaw_rate_radps ==
          Approx(yaw_rate_at(0.1 * static_cast<double>(middle))).margin(0.02));
    CHECK(find_reversing(made.odometry, made.fixes).empty());  // it has a sign now
  }
}

TEST_CASE("reversing: a drive forwards has none, also with fixes of 3 m") {
  WindingScene made = scene(-1);
  CHECK(find_reversing(made.odometry, made.fixes).empty());
  std::mt19937_64 random(11);
  std::normal_distribution<double> noise(0, 3);
  for (Fix& fix : made.fixes) {
    fix.position += Eigen::Vector2d(noise(random), noise(random));
    fix.covariance = 9 * Eigen::Matrix2d::Identity();
  }
  CHECK(find_reversing(made.odometry, made.fixes).empty());
}

TEST_CASE("reversing: an odometry that turns all the time drives no way backwards, and hides none") {
  double bias_radps;
  double turns_radpm;
  std::tie(bias_radps, turns_radpm) = GENERATE(
      table<double, double>({{0.1, 0.0}, {-0.1, 0.0}, {0.003, 0.01}, {0.003, -0.015}, {0.05, -0.01}}));
  // the gyro never rests: its bias is not known from stops
  const auto moving = [&](int backwards) {
    WindingScene made = scene(backwards, bias_radps, turns_radpm);
    std::erase_if(made.odometry, [](const OdometrySample& sample) { return sample.speed_mps == 0; });
    return made;
  };
  WindingScene forwards = moving(-1);
  CHECK(find_reversing(forwards.odometry, forwards.fixes).empty());
  WindingScene reverses = moving(2);
  const std::vector<Reversing> found = find_reversing(reverses.odometry, reverses.fixes);
  REQUIRE(found.size() == 1);
  CHECK(reverses.odometry[found[0].first].stamp.seconds() ==
        Approx(90).margin(5.2));  // the stop has no samples
  CHECK(reverses.odometry[found[0].last].stamp.seconds() == Approx(130).margin(5.2));
}

TEST_CASE("reversing: a turn while the odometry was silent is no drive backwards") {
  constexpr double kFrom = 85;  // between two stops
  constexpr double kTo = 90;
  const auto is_silent = [](double t) { return t > kFrom && t < kTo; };
  WindingScene made = winding_scene(
      225, [&](double t) { return is_silent(t) ? 4 : signed_speed(t, -1); },
      [&](double t) { return is_silent(t) ? 180 * kDegree / (kTo - kFrom) : yaw_rate_at(t); });
  std::erase_if(made.odometry,
                [&](const OdometrySample& sample) { return is_silent(sample.stamp.seconds()); });
  CHECK(find_reversing(made.odometry, made.fixes).empty());
}

TEST_CASE("reversing: wheels that say nothing at rest are still one odometry") {
  WindingScene made = scene(2);
  std::erase_if(made.odometry, [](const OdometrySample& sample) { return sample.speed_mps == 0; });
  CHECK(find_reversing(made.odometry, made.fixes).size() == 1);
}

TEST_CASE("reversing: odometry with a sign is believed") {
  WindingScene made = scene(2);
  made.odometry[3].speed_mps = -0.01;
  CHECK(find_reversing(made.odometry, made.fixes).empty());
}

TEST_CASE("reversing: fixes that do not have the shape of the odometry prove nothing") {
  WindingScene made = scene(2);
  std::mt19937_64 random(13);
  std::normal_distribution<double> wild(0, 60);
  for (Fix& fix : made.fixes)
    if (fix.stamp.seconds() > 88 && fix.stamp.seconds() < 132)
      fix.position += Eigen::Vector2d(wild(random), wild(random));
  CHECK(find_reversing(made.odometry, made.fixes).empty());
}

TEST_CASE("reversing: a yaw rate from wheels changes its sign with the speed") {
  WindingScene made = scene(1);
  for (OdometrySample& sample : made.odometry) {
    const double t = sample.stamp.seconds();
    const double sign = static_cast<int>(t / 45) == 1 ? -1 : 1;
    sample.yaw_rate_radps =
        sample.speed_mps > 0 ? sign * yaw_rate_at(t) : 0;  // (right - left) / track, no signs
  }
  const std::vector<Reversing> found = find_reversing(made.odometry, made.fixes);
  REQUIRE(found.size() == 1);
  drive_backwards(found, made.odometry);
  CHECK(made.odometry[650].yaw_rate_radps == Approx(yaw_rate_at(65)));
  CHECK_THAT(warning_of(found, made.odometry), Catch::Contains("the fixes move backwards 45."));
}

}  // namespace reversing_test
