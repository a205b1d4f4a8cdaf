// Stamps of the odometry that are late: receivers know the time, so it is the odometry that is moved.
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

struct Drive {
  PreparedDrive prepared;
  std::vector<Eigen::Vector2d> truth;  ///< at the fixes
};

/// Five minutes of bends at 10 Hz and 8 to 16 m/s, with fixes of 2 cm at 1 Hz.
Drive bends(double odometry_late_s) {
  constexpr double kStep_s = 0.1;
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal(0, 1);
  Drive drive;
  drive.prepared.receivers = {{"gnss"}};
  Pose2<double> pose(0, 0, 0.7);
  const auto speed_at = [](double t) { return 12 + 4 * std::sin(t / 7); };
  const auto turn_at = [](double t) { return 0.15 * std::sin(t / 11) + 0.1 * std::sin(t / 4); };
  for (int i = 0; i <= 3000; ++i) {
    const double t = i * kStep_s;
    drive.prepared.odometry.push_back({.stamp = Stamp::from_seconds(1000 + t + odometry_late_s),
                                       .speed_mps = speed_at(t) + 0.03 * normal(random),
                                       .yaw_rate_radps = turn_at(t) + 0.002 * normal(random)});
    if (i % 10 == 0 && i >= 10 && i <= 2990) {
      Fix fix;
      fix.stamp = Stamp::from_seconds(1000 + t);
      fix.epoch = i / 10 - 1;
      fix.position = pose.position + 0.02 * Eigen::Vector2d(normal(random), normal(random));
      fix.covariance = 4e-4 * Eigen::Matrix2d::Identity();
      drive.prepared.fixes.push_back(fix);
      drive.truth.push_back(pose.position);
    }
    const double middle = t + 0.5 * kStep_s;
    pose = compose(
        pose, se2_exp<double>(Eigen::Vector3d(speed_at(middle) * kStep_s, 0, turn_at(middle) * kStep_s)));
  }
  return drive;
}

struct Result {
  double rms_m = 0;
  bool is_moved = false;
};

Result fused(const Drive& drive) {
  const FusedDrive fused = fuse(drive.prepared, {}, registry());
  const Graph& graph = fused.model.document.graph;
  double sum = 0;
  for (std::size_t i = 0; i < drive.truth.size(); ++i) {
    const Eigen::Vector2d place(graph.value(graph.find(fused.model.placed.fixes[i].vertex).value()).data());
    sum += (place - drive.truth[i]).squaredNorm();
  }
  const std::vector<std::string> warnings = fused.model.warnings();
  return {std::sqrt(sum / static_cast<double>(drive.truth.size())),
          std::any_of(warnings.begin(), warnings.end(), [](const std::string& warning) {
            return warning.find("its stamps are moved") != std::string::npos;
          })};
}

}  // namespace

TEST_CASE("late odometry: poses are at the times of the fixes, and the move is told") {
  for (const double late_s : {0.05, 0.1, 0.4}) {
    const Result result = fused(bends(late_s));
    CHECK(result.is_moved);
    CHECK(result.rms_m < 0.04);  // 12 m/s times 0.1 s would be 1.2 m
  }
}

TEST_CASE(
    "late odometry: nothing is moved where clocks agree, where fixes may be late, or a delay is stated") {
  const Result sound = fused(bends(0));
  CHECK_FALSE(sound.is_moved);
  CHECK(sound.rms_m < 0.04);
  CHECK_FALSE(fused(bends(-0.1)).is_moved);
  Drive stated = bends(0.1);
  stated.prepared.receivers.front().delay_is_stated = true;
  CHECK_FALSE(fused(stated).is_moved);
}

}  // namespace late_odometry_test
