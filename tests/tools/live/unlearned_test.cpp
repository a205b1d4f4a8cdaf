// What is assumed of a gyro whose drive has not told anything yet, and what its readings show at once.
#include <algorithm>
#include <cmath>
#include <deque>
#include <random>
#include <vector>

#include <catch2/catch.hpp>

#include <waymark/core/base/angle.hpp>
#include <waymark/tools/live/estimator/guards/spot_turns.hpp>
#include <waymark/tools/live/learning/claims_so_far.hpp>
#include <waymark/tools/live/learning/gyro_shown.hpp>
#include <waymark/tools/live/learning/unlearned.hpp>

#include "live_drive.hpp"
#include "support/registry.hpp"

namespace unlearned_test {

using namespace waymark;
using namespace waymark::live;
using namespace waymark_test;

namespace {

constexpr double kDt_s = 0.04;

OdometrySample sample_at(std::size_t i, double speed_mps, double yaw_rate_radps) {
  return {Stamp::from_seconds(1000 + kDt_s * static_cast<double>(i)), speed_mps, yaw_rate_radps};
}

/// Share of the headings that are within 1.96 of their deviations.
double headings_inside(const Said& said, const LiveDrive& drive) {
  const std::vector<StampedPose>& truth = drive.simulated.poses;
  std::size_t inside = 0;
  std::size_t all = 0;
  for (const LivePose& pose : said.poses) {
    if (!pose.heading_known) continue;
    const auto at = std::lower_bound(truth.begin(), std::prev(truth.end()), pose.stamp,
                                     [](const StampedPose& of, Stamp moment) { return of.stamp < moment; });
    const double off = wrap_angle(pose.pose[2] - at->pose[2]);
    inside += std::abs(off) < 1.96 * std::sqrt(pose.covariance(2, 2));
    ++all;
  }
  return static_cast<double>(inside) / static_cast<double>(all);
}

}  // namespace

TEST_CASE("headings are within their regions though a gyro is off by 3 deg/s, or shakes", "[live]") {
  const double bias_radps = GENERATE(0.0, 0.05, -0.05);
  const double density = GENERATE(0.0, 3e-5);  // rad^2/s
  double inside = 0;
  constexpr int kDrives = 4;
  for (int seed = 1; seed <= kDrives; ++seed) {
    LiveDrive drive = live_drive("urban", 55, static_cast<std::uint64_t>(seed));
    std::mt19937 random(static_cast<unsigned>(seed));
    std::normal_distribution<double> noise(0, std::sqrt(density / kDt_s));
    for (Sample& sample : drive.arrivals)
      if (auto* odometry = std::get_if<OdometrySample>(&sample))
        odometry->yaw_rate_radps += bias_radps + noise(random);
    inside += headings_inside(listen(drive.arrivals), drive) / kDrives;
  }
  CHECK(inside > 0.9);
}

TEST_CASE("the white noise of a gyro is seen in its readings while the vehicle turns", "[live]") {
  const double density = GENERATE(4e-7, 3e-5);
  std::mt19937 random(1);
  std::normal_distribution<double> noise(0, std::sqrt(density / kDt_s));
  std::deque<OdometrySample> readings;
  for (std::size_t i = 0; i < 5000; ++i)
    readings.push_back(
        sample_at(i, 10, 0.05 + 0.4 * std::sin(0.5 * kDt_s * static_cast<double>(i)) + noise(random)));
  CHECK(white_noise_of(readings) == Approx(density).epsilon(0.1));
  readings.resize(50);
  CHECK(white_noise_of(readings) == 0);
}

TEST_CASE("the walk of a gyro's bias is seen from stop to stop", "[live]") {
  const double walk = GENERATE(0.0, 3e-4);  // rad/s/sqrt(s)
  std::mt19937 random(2);
  std::normal_distribution<double> noise(0, 3e-3);
  std::normal_distribution<double> step(0, walk * std::sqrt(kDt_s));
  std::deque<OdometrySample> readings;
  double bias = 0.01;
  for (std::size_t i = 0; i < 45'000; ++i) {  // half an hour, with 30 stops of 10 s
    bias += step(random);
    readings.push_back(sample_at(i, i % 1500 < 250 ? 0 : 10, bias + noise(random)));
  }
  if (walk > 0)
    CHECK(bias_walk_of(readings) == Approx(walk).epsilon(0.4));  // 29 steps: 13 %, at three deviations
  else
    CHECK(bias_walk_of(readings) < 5e-5);
  CHECK(bias_walk_of({}) == Approx(2e-5));
}

TEST_CASE("a turntable is seen by a gyro that has a bias", "[live]") {
  const double rate_radps = GENERATE(0.0, 0.05, -0.03);
  std::mt19937 random(3);
  std::normal_distribution<double> noise(0, 3e-3);
  constexpr double kBias_radps = 0.02;
  SpotTurns guard;
  double turned_rad = 0;
  OdometrySample last;
  for (std::size_t i = 0; i < 2500; ++i) {
    const double rate = i >= 500 && i < 1500 ? rate_radps : 0;
    const OdometrySample judged = guard.judged(sample_at(i, 0, kBias_radps + rate + noise(random)));
    if (i > 0 && judged.turns_on_spot && last.turns_on_spot)
      turned_rad += kDt_s * (0.5 * (judged.yaw_rate_radps + last.yaw_rate_radps) - kBias_radps);
    last = judged;
  }
  CHECK(turned_rad == Approx(40 * rate_radps).margin(0.02));
}

TEST_CASE("a turntable is seen by a gyro whose readings come unevenly", "[live]") {
  constexpr double kRate_radps = 0.05;
  std::mt19937 random(3);
  std::normal_distribution<double> noise(0, 1e-3);
  SpotTurns guard;
  double turned_rad = 0;
  OdometrySample last;
  double time_s = 1000;
  for (std::size_t i = 0; i < 3000; ++i) {
    time_s += i % 3 == 0 ? 0.09 : 0.015;  // 40 ms on average, in bursts
    const double rate = time_s >= 1020 && time_s < 1060 ? kRate_radps : 0;
    const OdometrySample judged = guard.judged({Stamp::from_seconds(time_s), 0, rate + noise(random)});
    if (i > 0 && judged.turns_on_spot && last.turns_on_spot)
      turned_rad +=
          0.5 * (judged.yaw_rate_radps + last.yaw_rate_radps) * seconds_between(last.stamp, judged.stamp);
    last = judged;
  }
  CHECK(turned_rad == Approx(40 * kRate_radps).margin(0.04));
}

TEST_CASE("a turn that was learned first is no standing for ever", "[live]") {
  SpotTurns guard;
  std::size_t turns = 0;
  for (std::size_t i = 0; i < 10'000; ++i) {
    const OdometrySample judged =
        guard.judged(sample_at(i, 0, i < 250 ? 0.1 : 0.01));  // ten seconds, then still
    if (i > 5000) turns += judged.turns_on_spot ? 1 : 0;
  }
  CHECK(turns == 0);
}

TEST_CASE("a rare kind of solution keeps its claims", "[live]") {
  ClaimsSoFar claims;
  ClaimedAccuracies last;
  for (int i = 0; i < 9'990; ++i) {
    Fix fix;
    const bool floats = i % 1000 == 999;
    fix.told.quality = floats ? FixQuality::floating : FixQuality::fixed;
    fix.accuracy_claimed = true;
    fix.covariance = std::pow(floats ? 1.5 : 0.02, 2) * Eigen::Matrix2d::Identity();
    last = claims.with(fix);
  }
  CHECK(last.of(SolutionKind::floating) == Approx(1.5));
  CHECK(last.of(SolutionKind::fixed) == Approx(0.02));
}

TEST_CASE("what is stated of an odometry is not assumed otherwise", "[live]") {
  drive::FusionSettings stated = live_fusion();
  stated.odometry_options = {{"gyro_bias_sigma", "0.001"}};
  drive::DriveDescription description = live_description();
  const DriveSoFar nothing(description, 60);
  const auto open = [&] { return with_open_calibration(stated, description, nothing, registry()); };
  CHECK(open().odometry_options.at("gyro_bias_sigma") == "0.001");
  description.odometry.front().assembly.yaw_rate_from = "rear_wheels";
  CHECK(open().odometry_options.at("yaw_scale") == "constant");
  stated.calibration = Options();
  CHECK_FALSE(
      with_open_calibration(stated, description, nothing, registry()).odometry_options.contains("yaw_scale"));
}

}  // namespace unlearned_test
