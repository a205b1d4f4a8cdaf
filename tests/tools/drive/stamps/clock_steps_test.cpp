// A clock of the odometry that was set during the drive, and gaps that only look like it.
#include <cmath>
#include <functional>
#include <random>
#include <vector>

#include <catch2/catch.hpp>

#include <waymark/tools/drive/stamps/clock_steps.hpp>
#include <waymark/types_se2/se2.hpp>

namespace clock_steps_test {

using namespace waymark;
using namespace waymark::drive;

namespace {

struct Logged {
  std::vector<OdometrySample> odometry;  ///< in the order of the log
  std::vector<Fix> fixes;
};

/// Ten minutes at 20 Hz in streets: speeds and turns that do not repeat. Fixes are good to 2 m.
/// @param clock the stamp of the odometry at a time; negative: it writes nothing
Logged logged(const std::function<double(double)>& clock) {
  constexpr double kStep_s = 0.05;
  std::mt19937_64 random(2);
  std::normal_distribution<double> normal(0, 1);
  Logged logs;
  Pose2<double> pose(0, 0, 0);
  double speed_mps = 8;
  double wanted_mps = 8;
  double turn_radps = 0;
  double wanted_radps = 0;
  for (int i = 0; i <= 12000; ++i) {
    const double t = i * kStep_s;
    if (i % 200 == 0) wanted_mps = 8 + 4 * normal(random);
    if (i % 120 == 0) wanted_radps = 0.2 * normal(random);
    speed_mps += kStep_s / 2 * (wanted_mps - speed_mps);
    turn_radps += kStep_s / 1.5 * (wanted_radps - turn_radps);
    if (const double stamp = clock(t); stamp >= 0)
      logs.odometry.push_back({Stamp::from_seconds(stamp), speed_mps, turn_radps});
    if (i % 20 == 0) {
      Fix fix;
      fix.stamp = Stamp::from_seconds(t);
      fix.position = pose.position + Eigen::Vector2d(normal(random), normal(random));
      fix.covariance = 4 * Eigen::Matrix2d::Identity();
      logs.fixes.push_back(fix);
    }
    pose = compose(pose, se2_exp<double>(Eigen::Vector3d(speed_mps * kStep_s, 0, turn_radps * kStep_s)));
  }
  return logs;
}

std::vector<Stamp> stamps_of(const Logged& logs) {
  std::vector<Stamp> stamps;
  for (const OdometrySample& sample : logs.odometry) stamps.push_back(sample.stamp);
  return stamps;
}

std::vector<StampStep> clock_steps(Logged logs) {
  const std::vector<StampStep> steps = find_stamp_steps(stamps_of(logs));
  std::stable_sort(logs.odometry.begin(), logs.odometry.end(),
                   [](const OdometrySample& a, const OdometrySample& b) { return a.stamp < b.stamp; });
  return find_clock_steps(steps, logs.odometry, logs.fixes);
}

}  // namespace

TEST_CASE("clock steps: a clock that is set forward or back by seconds or an hour is taken back") {
  for (const double by_s : {0.6, 2.5, 3600.0, -0.8, -2.5, -40.0}) {
    CAPTURE(by_s);
    const Logged logs = logged([&](double t) { return t < 300 ? 100 + t : 100 + t + by_s; });
    Logged on_time = logs;
    for (Fix& fix : on_time.fixes) fix.stamp = fix.stamp.later(100);
    const std::vector<StampStep> steps = clock_steps(on_time);
    REQUIRE(steps.size() == 1);
    CHECK(steps[0].row == 6000);
    CHECK(steps[0].by_s == Approx(by_s).margin(1e-6));
    std::vector<Stamp> stamps = stamps_of(on_time);
    take_back(steps, stamps);
    for (std::size_t i = 0; i < stamps.size(); ++i)
      CHECK(std::abs(stamps[i].seconds() - 100 - 0.05 * static_cast<double>(i)) < 1e-6);
  }
}

TEST_CASE("clock steps: where the odometry wrote nothing for a while, its clock was not set") {
  for (const double gap_s : {0.6, 2.5, 60.0}) {
    CAPTURE(gap_s);
    const Logged logs = logged([&](double t) { return t > 300 && t < 300 + gap_s ? -1 : t; });
    REQUIRE(find_stamp_steps(stamps_of(logs)).size() == 1);
    CHECK(clock_steps(logs).empty());
  }
}

TEST_CASE("clock steps: two of them are told apart") {
  const std::vector<StampStep> steps = clock_steps(logged([](double t) {
    return t < 200 ? t : t < 400 ? t + 5 : t + 3.5;
  }));
  REQUIRE(steps.size() == 2);
  CHECK(steps[0].by_s == Approx(5));
  CHECK(steps[1].by_s == Approx(-1.5));
}

}  // namespace clock_steps_test
