// Speed and yaw rate that are late by different times: each lag is found as it was made, one of them is named only
// where it is late alone.
#include <catch2/catch.hpp>

#include <cmath>
#include <random>

#include <Eigen/Geometry>

#include <waymark/tools/drive/clocks/late_quantity.hpp>
#include <waymark/tools/drive/clocks/motion_lags.hpp>
#include <waymark/tools/drive/description/drive_file.hpp>

namespace late_quantity_test {

using namespace waymark;
using namespace waymark::drive;

namespace {

/// Bends every 40 s at 5 m/s, straight roads at 13 m/s between them.
double speed_of(double t) {
  return 9 + 4 * std::sin(2 * M_PI * t / 40);
}

double bends_of(double t) {
  return 0.4 * std::sin(2 * M_PI * t / 160) * std::pow(std::sin(M_PI * (t - 10) / 40), 8);
}

struct Fault {
  double speed_late_s = 0;
  double yaw_rate_late_s = 0;
  double fixes_late_s = 0;
  double antenna_ahead_m = 0;      ///< of where it is stated
  double yaw_factor = 1;           ///< of the readings of the gyro
  double bends_until_s = 1e9;      ///< straight roads only after that
  double cloverleaf_from_s = 1e9;  ///< 40 s of turning by 0.4 rad/s, less often than all else
};

struct Readings {
  std::vector<OdometrySample> odometry;
  std::vector<Fix> fixes;

  [[nodiscard]] std::optional<MotionLags> lags(double arm_sigma_m = 0.3) const {
    std::vector<const Fix*> pointers;
    for (const Fix& fix : fixes) pointers.push_back(&fix);
    return estimate_motion_lags(odometry, pointers, arm_sigma_m);
  }
  [[nodiscard]] std::optional<LateQuantity> late() const { return late_quantity_shown(odometry, fixes, {}); }
};

/// Twenty minutes: odometry at 25 Hz with a speed 2 % too large and a biased gyro, fixes at 1 Hz with white errors.
Readings drive_with(const Fault& fault, double noise_m, double length_s = 1200) {
  constexpr double kStep_s = 0.01;
  constexpr double kScale = 1.02;
  constexpr double kBias_radps = 0.002;
  const Eigen::Vector2d antenna_m(1.0, 0.3);
  const auto yaw_rate_of = [&](double t) {
    if (t > fault.cloverleaf_from_s && t < fault.cloverleaf_from_s + 40) return 0.4 + bends_of(t);
    return t < fault.bends_until_s ? bends_of(t) : 0;
  };
  std::mt19937 random(5);
  std::normal_distribution<double> noise(0, 1);
  Readings readings;
  Eigen::Vector2d position(0, 0);
  double heading = 0;
  for (int i = 0; kStep_s * i <= length_s; ++i) {
    const double t = kStep_s * i;
    const Stamp stamp{static_cast<std::int64_t>(i) * 10'000'000};
    if (i % 4 == 0)
      readings.odometry.push_back({stamp, kScale * speed_of(t - fault.speed_late_s),
                                   kBias_radps + fault.yaw_factor * yaw_rate_of(t - fault.yaw_rate_late_s)});
    if (i % 100 == 0) {
      Fix fix;
      fix.stamp = stamp.later(fault.fixes_late_s);
      fix.antenna_m = antenna_m;
      fix.position = position +
                     Eigen::Rotation2Dd(heading) * (antenna_m + Eigen::Vector2d(fault.antenna_ahead_m, 0)) +
                     noise_m * Eigen::Vector2d(noise(random), noise(random));
      readings.fixes.push_back(fix);
    }
    const double middle = heading + 0.5 * kStep_s * yaw_rate_of(t + kStep_s / 2);
    position += kStep_s * speed_of(t + kStep_s / 2) * Eigen::Vector2d(std::cos(middle), std::sin(middle));
    heading += kStep_s * yaw_rate_of(t + kStep_s / 2);
  }
  return readings;
}

}  // namespace

TEST_CASE("late quantity: without errors of the fixes both lags are found to milliseconds") {
  const auto lags = drive_with({.speed_late_s = 0.6, .yaw_rate_late_s = -0.2}, 0).lags();
  REQUIRE(lags);
  CHECK(lags->speed_s == Approx(0.6).margin(0.005));
  CHECK(lags->yaw_rate_s == Approx(-0.2).margin(0.005));
}

TEST_CASE("late quantity: the covariance of the lags covers their errors, with fixes of 1 m") {
  const auto [speed_late, yaw_late] = GENERATE(std::pair(0.0, 0.0), std::pair(0.4, 0.0), std::pair(0.8, 0.8));
  const auto lags = drive_with({.speed_late_s = speed_late, .yaw_rate_late_s = yaw_late}, 1).lags();
  REQUIRE(lags);
  CHECK(lags->difference_sigma_s() < 0.1);
  CHECK(std::abs(lags->speed_s - speed_late) < 3 * std::sqrt(lags->covariance_s2(0, 0)));
  CHECK(std::abs(lags->yaw_rate_s - yaw_late) < 3 * std::sqrt(lags->covariance_s2(1, 1)));
  CHECK(std::abs(lags->difference_s() - (speed_late - yaw_late)) < 3 * lags->difference_sigma_s());
}

TEST_CASE("late quantity: a delay of the fixes is in both lags, and not in their difference") {
  const auto lags = drive_with({.speed_late_s = 0.5, .fixes_late_s = 0.3}, 0.02).lags();
  REQUIRE(lags);
  CHECK(lags->speed_s == Approx(0.2).margin(0.01));
  CHECK(lags->yaw_rate_s == Approx(-0.3).margin(0.01));
  CHECK(lags->difference_s() == Approx(0.5).margin(0.01));
}

TEST_CASE("late quantity: one bend has no spread, so a drive with no other tells no lags") {
  // The fixes of the only bend are those of a receiver that coasts through it and then catches up.
  Readings readings = drive_with({.bends_until_s = 50}, 1);
  for (Fix& fix : readings.fixes) {
    const double t = fix.stamp.seconds();
    if (t > 25 && t < 45) fix.position += 0.05 * (t - 25) * (45 - t) * Eigen::Vector2d(1, -1);
  }
  CHECK_FALSE(readings.lags());
  CHECK_FALSE(readings.late());
  CHECK(drive_with({.bends_until_s = 400}, 1).lags());
}

TEST_CASE("late quantity: few windows that tell much do not hide what the others tell") {
  // Two turns on a cloverleaf.
  Readings readings = drive_with({.speed_late_s = 0.4, .cloverleaf_from_s = 600}, 1);
  const auto late = readings.late();
  REQUIRE(late);
  CHECK(late->late_s == Approx(0.4).margin(0.15));
}

TEST_CASE("late quantity: a late speed is named, with its key") {
  const auto noise_m = GENERATE(0.02, 1.0);
  const auto late = drive_with({.speed_late_s = 0.4}, noise_m).late();
  REQUIRE(late);
  CHECK(late->kind == LateQuantity::Kind::speed);
  CHECK(late->key() == "speed_delay");
  CHECK(late->late_s == Approx(0.4).margin(0.02 + 3 * late->sigma_s));
  CHECK(late_quantity_warning("the odometry", {LateQuantity::Kind::speed, 0.4, 0}, "state it") ==
        "the odometry's speed seems 0.40 +- 0.05 s late, its yaw rate not: state it");
}

TEST_CASE("late quantity: a late yaw rate is named, unless wheels or steering tell both") {
  const Readings readings = drive_with({.yaw_rate_late_s = 0.5}, 0.02);
  const auto late = readings.late();
  REQUIRE(late);
  CHECK(late->kind == LateQuantity::Kind::yaw_rate);
  CHECK(late->late_s == Approx(0.5).margin(0.02));
  CHECK(LateQuantity{LateQuantity::Kind::yaw_rate, 0.5, 0}.increase() == "increase 'yaw_rate_delay' by 0.50");
  CHECK_FALSE(late_quantity_shown(readings.odometry, readings.fixes, {.stated_derived = true}));
}

TEST_CASE("late quantity: a sound odometry, one clock for both, late fixes and few fixes name none") {
  CHECK_FALSE(drive_with({}, 1).late());
  CHECK_FALSE(drive_with({}, 0.02).late());
  CHECK_FALSE(drive_with({.speed_late_s = 0.7, .yaw_rate_late_s = 0.7}, 0.02).late());
  CHECK_FALSE(drive_with({.fixes_late_s = 0.5}, 0.02).late());
  CHECK_FALSE(drive_with({.speed_late_s = 0.5}, 0.02, 120).late());
}

TEST_CASE("late quantity: an antenna ahead of where it is stated is no late yaw rate") {
  // At 5 m/s in the bends 2 m are 0.4 s.
  CHECK_FALSE(drive_with({.antenna_ahead_m = 2}, 0.02).late());
}

TEST_CASE("late quantity: a gyro of a wrong scale is no late speed, and hides none") {
  for (const double factor : {0.9, 1.1, 1.2}) {
    INFO("turns " << factor << " times those of the vehicle");
    CHECK_FALSE(drive_with({.yaw_factor = factor}, 0.02).late());
    CHECK_FALSE(drive_with({.yaw_factor = factor}, 1).late());
    const auto late = drive_with({.speed_late_s = 0.4, .yaw_factor = factor}, 0.5).late();
    REQUIRE(late);
    CHECK(late->kind == LateQuantity::Kind::speed);
    CHECK(late->late_s == Approx(0.4).margin(0.02 + 3 * late->sigma_s));
  }
}

TEST_CASE("late quantity: a drive without bends tells nothing of the yaw rate") {
  Readings readings = drive_with({.speed_late_s = 0.5}, 1);
  for (OdometrySample& sample : readings.odometry) sample.yaw_rate_radps = 0.002;
  for (std::size_t i = 0; i < readings.fixes.size(); ++i)
    readings.fixes[i].position = Eigen::Vector2d(9 * static_cast<double>(i), 0.5 * (i % 2 == 0 ? 1 : -1));
  CHECK_FALSE(readings.late());
}

TEST_CASE("late quantity: a yaw rate that is late with the speed is told apart from one that is on time") {
  const Readings both = drive_with({.speed_late_s = 0.4, .yaw_rate_late_s = 0.4}, 0.5);
  CHECK(yaw_rate_is_late(both.odometry, both.fixes));
  const Readings speed = drive_with({.speed_late_s = 0.4}, 0.5);
  CHECK_FALSE(yaw_rate_is_late(speed.odometry, speed.fixes));
}

TEST_CASE("late quantity: without it the samples are those of an odometry on time") {
  const Readings late = drive_with({.speed_late_s = 0.5}, 1);
  const Readings sound = drive_with({}, 1);
  const std::vector<OdometrySample> moved =
      without_lateness(late.odometry, {LateQuantity::Kind::speed, 0.5, 0});
  REQUIRE(moved.size() > sound.odometry.size() - 20);
  for (std::size_t i = 0; i < moved.size(); i += 101) {
    CHECK(moved[i].stamp == sound.odometry[i].stamp);
    CHECK(moved[i].speed_mps == Approx(sound.odometry[i].speed_mps).margin(0.01));
    CHECK(moved[i].yaw_rate_radps == Approx(sound.odometry[i].yaw_rate_radps).margin(1e-9));
  }
}

TEST_CASE(
    "late quantity: delays are stated by their keys, or by parts with different offsets, but not by zones") {
  OdometryConfig odometry;
  odometry.logs.resize(2);
  CHECK_FALSE(states_delays(odometry));
  for (LogConfig& log : odometry.logs) log.request.time_offset_s = -4.4;  // a logger's clock, that of both
  CHECK_FALSE(states_delays(odometry));
  odometry.logs.front().request.time_offset_s = -4.8;
  CHECK(states_delays(odometry));
  odometry.logs.front().request.time_offset_s = -4.4 - 5.75 * 3600;  // the zone of Nepal
  CHECK_FALSE(states_delays(odometry));
  OdometryConfig zero;
  zero.logs.resize(1);
  zero.delay_place = "drive.yaml:3:16: ";
  CHECK(states_delays(zero));
}

}  // namespace late_quantity_test
