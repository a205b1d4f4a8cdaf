// What is wrong with the sources while driving: wheels that lock or spin, and receivers that differ for minutes.
#include <algorithm>
#include <cmath>
#include <variant>
#include <vector>

#include <catch2/catch.hpp>

#include <waymark/tools/live/estimator/fix_judge.hpp>
#include <waymark/tools/live/estimator/guards/receiver_comparison.hpp>
#include <waymark/tools/live/estimator/guards/speed_guard.hpp>

#include "live_drive.hpp"
#include "support/registry.hpp"

namespace guards_test {

using namespace waymark;
using namespace waymark::live;
using waymark_test::LiveDrive;
using waymark_test::Said;

namespace {

constexpr double kDt_s = 0.04;

/// Gives the guard speeds at 25 Hz; returns what it makes of them.
std::vector<OdometrySample> judged(const std::vector<double>& speeds) {
  SpeedGuard guard;
  std::vector<OdometrySample> samples;
  for (std::size_t i = 0; i < speeds.size(); ++i)
    samples.push_back(
        guard.judged({Stamp::from_seconds(1000 + kDt_s * static_cast<double>(i)), speeds[i], 0.1}));
  return samples;
}

/// Speeds that swing slowly about 15 m/s, by at most 1.5 m/s^2.
std::vector<double> swinging(std::size_t count) {
  std::vector<double> speeds;
  for (std::size_t i = 0; i < count; ++i)
    speeds.push_back(15 + 5 * std::sin(0.3 * kDt_s * static_cast<double>(i)));
  return speeds;
}

std::size_t assumed(const std::vector<OdometrySample>& samples) {
  std::size_t count = 0;
  for (const OdometrySample& sample : samples) count += sample.assumed;
  return count;
}

}  // namespace

TEST_CASE("speed guard: wheels that spin and lock are held at the speed before, and nothing else is",
          "[live]") {
  std::vector<double> speeds = swinging(2000);
  for (std::size_t i = 500; i < 525; ++i) speeds[i] *= 2.5;
  for (std::size_t i = 1000; i < 1025; ++i) speeds[i] *= 0.05;
  const std::vector<OdometrySample> samples = judged(speeds);
  for (std::size_t i = 0; i < speeds.size(); ++i) {
    INFO(i);
    const std::size_t before = i >= 500 && i < 525 ? 499 : i >= 1000 && i < 1025 ? 999 : i;
    CHECK(samples[i].speed_mps == speeds[before]);
    CHECK(samples[i].assumed == (before != i));
    CHECK(samples[i].yaw_rate_radps == 0.1);
  }
}

TEST_CASE("speed guard: wheels need some readings to spin up and to come back", "[live]") {
  std::vector<double> speeds = swinging(1500);
  const std::vector<double> sound = speeds;
  for (std::size_t i = 500; i < 530; ++i) speeds[i] += i < 503 ? 5.0 * static_cast<double>(i - 499) : 20;
  for (std::size_t i = 530; i < 533; ++i) speeds[i] += 5.0 * static_cast<double>(533 - i);
  const std::vector<OdometrySample> samples = judged(speeds);
  for (std::size_t i = 533; i < speeds.size(); ++i) CHECK(samples[i].speed_mps == sound[i]);
  for (std::size_t i = 500; i < 530; ++i) CHECK(samples[i].assumed);
}

TEST_CASE("speed guard: what a vehicle can do is believed", "[live]") {
  std::vector<double> speeds(250, 20);
  for (int i = 1; i <= 50; ++i) speeds.push_back(20 - 10 * kDt_s * i);  // 10 m/s^2 to a standstill
  speeds.insert(speeds.end(), 250, 0);
  CHECK(assumed(judged(speeds)) == 0);
}

TEST_CASE("speed guard: a leap that does not come back is believed after five seconds", "[live]") {
  std::vector<double> speeds = swinging(1000);
  for (std::size_t i = 500; i < speeds.size(); ++i) speeds[i] += 12;
  const std::vector<OdometrySample> samples = judged(speeds);
  CHECK(assumed(samples) == 124);
  CHECK(samples[623].assumed);  // 4.96 s after the sample before the leap
  CHECK_FALSE(samples[624].assumed);
}

TEST_CASE("speed guard: a speed that repeated itself was wrong before its leap, not after it", "[live]") {
  std::vector<double> speeds = swinging(1000);
  for (std::size_t i = 300; i < 500; ++i) speeds[i] = speeds[300] + 10;
  CHECK(assumed(judged(speeds)) == 124);  // the freeze begins with a leap; five seconds later it is believed
  std::vector<double> slowly = swinging(1000);
  for (std::size_t i = 300; i < 500; ++i) slowly[i] = slowly[300];
  for (std::size_t i = 500; i < 1000; ++i) slowly[i] += 8;
  CHECK(assumed(judged(slowly)) == 0);
}

TEST_CASE("speed guard: a slip that outlasts the guard comes back at once", "[live]") {
  std::vector<double> speeds = swinging(1000);
  const std::vector<double> sound = speeds;
  for (std::size_t i = 500; i < 700; ++i) speeds[i] += 12;
  const std::vector<OdometrySample> samples = judged(speeds);
  for (std::size_t i = 700; i < 1000; ++i) CHECK(samples[i].speed_mps == sound[i]);
}

TEST_CASE("speed guard: a sample that is older than the last one is no leap", "[live]") {
  SpeedGuard guard;
  for (int i = 0; i < 100; ++i) (void)guard.judged({Stamp::from_seconds(i * kDt_s), 10, 0});
  CHECK_FALSE(guard.judged({Stamp::from_seconds(3), 10.2, 0}).assumed);
  CHECK_FALSE(guard.judged({Stamp::from_seconds(100 * kDt_s), 10, 0}).assumed);
}

TEST_CASE("speed guard: a speed that leaps all the time is rough, and believed", "[live]") {
  std::vector<double> speeds = swinging(3000);
  for (std::size_t i = 0; i < speeds.size(); ++i)
    if (i / 25 % 3 == 0) speeds[i] += 10;
  const std::vector<OdometrySample> samples = judged(speeds);
  CHECK(assumed(samples) < 300);
  CHECK_FALSE(samples.back().assumed);
}

TEST_CASE("a slip of a second is told once, and costs no accuracy", "[live]") {
  const LiveDrive sound = waymark_test::live_drive("rural", 300);
  LiveDrive slipping = sound;
  std::size_t slipped = 0;
  for (Sample& sample : slipping.arrivals) {
    auto* odometry = std::get_if<OdometrySample>(&sample);
    if (odometry == nullptr || slipped > 25 || (slipped == 0 && odometry->speed_mps < 10)) continue;
    if (seconds_between(stamp_of(sound.arrivals.front()), odometry->stamp) < 100) continue;
    odometry->speed_mps *= 2.5;
    ++slipped;
  }
  REQUIRE(slipped > 20);
  const Said before = waymark_test::listen(sound.arrivals);
  const Said after = waymark_test::listen(slipping.arrivals);
  CHECK(before.count("leap") == 0);
  CHECK(after.count("leap") == 1);
  CHECK(waymark_test::rms(waymark_test::errors_m(after, slipping)) <
        1.1 * waymark_test::rms(waymark_test::errors_m(before, sound)));
}

TEST_CASE("a wrong reading of a compass does not move what is published at once", "[live]") {
  const LiveDrive drive = waymark_test::live_drive("rural", 240);
  drive::DriveDescription description = waymark_test::live_description();
  description.sensors.push_back(
      {.name = "heading", .log = {}, .options = {}, .place = "", .source = "compass"});
  const auto with_readings = [&](double wrong_rad) {
    waymark_test::Arrivals arrivals;
    int count = 0;
    for (const Sample& sample : drive.arrivals) {
      arrivals.push_back(sample);
      const auto* odometry = std::get_if<OdometrySample>(&sample);
      if (odometry == nullptr || ++count % 5 != 0) continue;
      const auto truth =
          std::lower_bound(drive.simulated.truth.begin(), drive.simulated.truth.end(), odometry->stamp,
                           [](const auto& of, Stamp s) { return of.stamp < s; });
      if (truth == drive.simulated.truth.end()) continue;
      const double off = count % 50 == 0 && count > 1500 ? wrong_rad : 0;  // one in ten
      arrivals.push_back(SensorReading{odometry->stamp, 0, {*truth->heading_rad + off, 0.02}});
    }
    return arrivals;
  };
  const auto largest = [&](const waymark_test::Arrivals& arrivals) {
    const std::vector<double> errors =
        waymark_test::errors_m(waymark_test::listen(description, arrivals), drive);
    return *std::max_element(errors.begin(), errors.end());
  };
  CHECK(largest(with_readings(2)) < 1.1 * largest(with_readings(0)));
}

TEST_CASE("receivers that differ for minutes by more than they claim are told once", "[live]") {
  const LiveDrive drive = waymark_test::live_drive("three-absolute", 300);
  waymark_test::Arrivals shifted = drive.arrivals;
  for (Sample& sample : shifted)
    if (auto* fix = std::get_if<GeodeticFix>(&sample); fix != nullptr && fix->source == 1)
      fix->latitude_deg += 8 / 111200.0;  // 8 m to the north
  const std::vector<std::string> names = {"one", "two", "three"};
  CHECK(waymark_test::listen(drive.arrivals, {}, "correlated", names).count("receivers") == 0);
  const Said said = waymark_test::listen(shifted, {}, "correlated", names);
  // Once for each of the other receivers at most. The errors of the first one are as large as the claims of both.
  CHECK(said.count("receivers") >= 1);
  CHECK(said.count("receivers") <= 2);
  for (const Event& event : said.events)
    if (event.kind == "receivers") CHECK(event.text.find("two") != std::string::npos);
}

TEST_CASE("a receiver's usual claim is that of the drive so far, not of the last minutes", "[live]") {
  const drive::DriveDescription description = waymark_test::live_description();
  const drive::FusionSettings settings = waymark_test::live_fusion();
  const LiveSettings live;
  FixJudge judge(description, settings, live, waymark_test::registry());
  double stamp_s = 1000;
  const auto usual_after = [&](int fixes, double accuracy_m) {
    ClaimedAccuracies claims;
    for (int i = 0; i < fixes; ++i) {
      Fix fix;
      fix.stamp = Stamp::from_seconds(stamp_s += 0.2);
      fix.covariance = accuracy_m * accuracy_m * Eigen::Matrix2d::Identity();
      claims = judge.accept(fix);
    }
    return claims.reference_m();
  };
  CHECK(usual_after(5000, 0.02) == Approx(0.02));
  CHECK(usual_after(4800, 1.5) == Approx(0.02));
  CHECK(usual_after(400, 1.5) == Approx(1.5));
}

TEST_CASE("a receiver that tells the quality but no accuracy of code fixes has them beside the fixed ones",
          "[live]") {
  const drive::DriveDescription description = waymark_test::live_description();
  const drive::FusionSettings settings = waymark_test::live_fusion();
  const LiveSettings live;
  FixJudge judge(description, settings, live, waymark_test::registry());
  Fix fix;
  fix.stamp = Stamp::from_seconds(1000);
  fix.told.quality = FixQuality::single;
  fix.accuracy_claimed = false;
  fix.covariance = 9 * Eigen::Matrix2d::Identity();
  CHECK(judge.accept(fix).reference_m() == 0);
  fix.stamp = fix.stamp.later(1);
  fix.told.quality = FixQuality::fixed;
  fix.accuracy_claimed = true;
  fix.covariance = 0.02 * 0.02 * Eigen::Matrix2d::Identity();
  const ClaimedAccuracies both = judge.accept(fix);
  CHECK(both.reference_m() == Approx(3));
  CHECK(both.of(SolutionKind::fixed) == Approx(0.02));
}

}  // namespace guards_test
