// Stamps of the odometry that are late: receivers know the time, so the odometry is told to be late.
#include <algorithm>
#include <cmath>
#include <random>

#include <catch2/catch.hpp>

#include <waymark/tools/drive/model/fuse.hpp>
#include <waymark/types_se2/se2.hpp>

#include "support/registry.hpp"

namespace late_odometry_test {

using namespace waymark;
using namespace waymark::drive;
using namespace waymark_test;

namespace {

/// Five minutes of bends at 10 Hz and 8 to 16 m/s, with fixes of 2 cm at 1 Hz.
PreparedDrive bends(double odometry_late_s) {
  constexpr double kStep_s = 0.1;
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal(0, 1);
  PreparedDrive drive;
  drive.receivers = {{"gnss"}};
  Pose2<double> pose(0, 0, 0.7);
  const auto speed_at = [](double t) { return 12 + 4 * std::sin(t / 7); };
  const auto turn_at = [](double t) { return 0.15 * std::sin(t / 11) + 0.1 * std::sin(t / 4); };
  for (int i = 0; i <= 3000; ++i) {
    const double t = i * kStep_s;
    drive.odometry.push_back({.stamp = Stamp::from_seconds(1000 + t + odometry_late_s),
                              .speed_mps = speed_at(t) + 0.03 * normal(random),
                              .yaw_rate_radps = turn_at(t) + 0.002 * normal(random)});
    if (i % 10 == 0 && i >= 10 && i <= 2990) {
      Fix fix;
      fix.stamp = Stamp::from_seconds(1000 + t);
      fix.epoch = i / 10 - 1;
      fix.position = pose.position + 0.02 * Eigen::Vector2d(normal(random), normal(random));
      fix.covariance = 4e-4 * Eigen::Matrix2d::Identity();
      drive.fixes.push_back(fix);
    }
    const double middle = t + 0.5 * kStep_s;
    pose = compose(
        pose, se2_exp<double>(Eigen::Vector3d(speed_at(middle) * kStep_s, 0, turn_at(middle) * kStep_s)));
  }
  return drive;
}

/// Returns what is said about a late odometry; empty: nothing.
std::string told(const PreparedDrive& drive) {
  for (const std::string& warning : fuse(drive, {}, registry()).model.warnings())
    if (warning.find("the odometry is probably late") != std::string::npos) return warning;
  return {};
}

}  // namespace

TEST_CASE("late odometry: it is told by how much, with what to state") {
  CHECK_THAT(told(bends(0.1)), Catch::Contains("add -0.10") || Catch::Contains("add -0.09"));
  CHECK_THAT(told(bends(0.4)), Catch::Contains("add -0.40") || Catch::Contains("add -0.39"));
}

TEST_CASE(
    "late odometry: nothing is said where clocks agree, where fixes may be late, or a delay is stated") {
  CHECK(told(bends(0)).empty());
  CHECK(told(bends(-0.1)).empty());
  PreparedDrive stated = bends(0.1);
  stated.receivers.front().delay_is_stated = true;
  CHECK(told(stated).empty());
}

}  // namespace late_odometry_test
