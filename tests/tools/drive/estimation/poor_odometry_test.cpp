// An odometry that does not move as the vehicle does: the result is not worse than the fixes, and says why.
#include <algorithm>
#include <cmath>
#include <random>

#include <catch2/catch.hpp>

#include <waymark/tools/drive/model/fuse.hpp>
#include <waymark/types_se2/se2.hpp>

#include "support/registry.hpp"

namespace poor_odometry_test {

using namespace waymark;
using namespace waymark::drive;
using namespace waymark_test;

namespace {

/// What the odometry makes of a motion at a time.
using Fault = void (*)(double time_s, OdometrySample& sample);

void sound(double, OdometrySample&) {}
void dead_gyro(double, OdometrySample& sample) {
  sample.yaw_rate_radps = 0;
}
void slipping_wheels(double time_s, OdometrySample& sample) {
  if (std::fmod(time_s, 240) > 120) sample.speed_mps *= 1.35;
}

struct Drive {
  PreparedDrive prepared;
  std::vector<Eigen::Vector2d> truth;  ///< at the fixes
};

/// Eight minutes of town blocks: straight for 16 s, then a quarter turn to the left or the right in 4 s, at 10 m/s.
/// The fixes are 2 m off for half a minute (Gauss-Markov), and by 0.5 m each.
Drive blocks(Fault fault) {
  constexpr double kStep_s = 0.1;
  constexpr double kSpeed_mps = 10;
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal(0, 1);
  const double decay = std::exp(-1.0 / 30);
  Drive drive;
  Pose2<double> pose(0, 0, 0.7);
  Eigen::Vector2d lasting(normal(random), normal(random));
  double side = 1;
  for (int i = 0; i <= 4800; ++i) {
    const double t = i * kStep_s;
    if (i % 200 == 0) side = normal(random) > 0 ? 1 : -1;
    const double turn = i % 200 >= 160 ? side * M_PI / 2 / 4 : 0;
    OdometrySample sample{
        .stamp = Stamp::from_seconds(1000 + t), .speed_mps = kSpeed_mps, .yaw_rate_radps = turn};
    sample.speed_mps += 0.05 * normal(random);
    sample.yaw_rate_radps += 0.003 * normal(random);
    fault(t, sample);
    drive.prepared.odometry.push_back(sample);
    if (i % 10 == 0) {
      Fix fix;
      fix.stamp = Stamp::from_seconds(1000 + t);
      fix.epoch = i / 10;
      fix.position = pose.position + 2 * lasting + 0.5 * Eigen::Vector2d(normal(random), normal(random));
      fix.covariance = 6.25 * Eigen::Matrix2d::Identity();
      drive.prepared.fixes.push_back(fix);
      drive.truth.push_back(pose.position);
      lasting =
          decay * lasting + std::sqrt(1 - decay * decay) * Eigen::Vector2d(normal(random), normal(random));
    }
    pose = compose(pose, se2_exp<double>(Eigen::Vector3d(kSpeed_mps * kStep_s, 0, turn * kStep_s)));
  }
  return drive;
}

double rms(const std::vector<Eigen::Vector2d>& errors) {
  double sum = 0;
  for (const Eigen::Vector2d& error : errors) sum += error.squaredNorm();
  return std::sqrt(sum / static_cast<double>(errors.size()));
}

struct Result {
  double raw_m = 0;
  double fused_m = 0;
  bool says_why = false;
};

Result fused(Fault fault) {
  const Drive drive = blocks(fault);
  const FusedDrive fused = fuse(drive.prepared, {}, registry());
  std::vector<Eigen::Vector2d> raw;
  std::vector<Eigen::Vector2d> after;
  for (std::size_t i = 0; i < drive.truth.size(); ++i) {
    raw.push_back(drive.prepared.fixes[i].position - drive.truth[i]);
    const VertexIndex node = fused.model.document.graph.find(fused.model.placed.fixes[i].vertex).value();
    after.push_back(Eigen::Vector2d(fused.model.document.graph.value(node).data()) - drive.truth[i]);
  }
  const std::vector<std::string> warnings = fused.model.warnings();
  return {rms(raw), rms(after), std::any_of(warnings.begin(), warnings.end(), [](const std::string& warning) {
            return warning.find("does not move as the fixes do") != std::string::npos;
          })};
}

}  // namespace

TEST_CASE(
    "poor odometry: a dead gyro and slipping wheels leave the fixes as good as they are, and are told") {
  for (const Fault fault : {dead_gyro, slipping_wheels}) {
    const Result result = fused(fault);
    CHECK(result.fused_m < 1.05 * result.raw_m);
    CHECK(result.says_why);
  }
}

TEST_CASE("poor odometry: a sound one is believed") {
  const Result result = fused(sound);
  CHECK(result.fused_m < 0.7 * result.raw_m);
  CHECK_FALSE(result.says_why);
}

}  // namespace poor_odometry_test
