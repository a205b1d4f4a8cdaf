// Neither the rate of the odometry log nor splits at fixes change the result (additive process noise).
#include <random>

#include <catch2/catch.hpp>

#include <waymark/tools/drive/model/fuse.hpp>
#include <waymark/tools/drive/model/poses_at_fixes.hpp>
#include <waymark/types_se2/se2.hpp>

#include "support/registry.hpp"

namespace additivity_test {

using namespace waymark;
using namespace waymark::drive;
using namespace waymark::formats;

namespace {

constexpr double kSpeed = 8;       // m/s
constexpr double kYawRate = 0.05;  // rad/s: a circle of 160 m radius
constexpr int kSeconds = 120;

Eigen::Vector2d true_position(double t) {
  return se2_exp<double>(Eigen::Vector3d(kSpeed * t, 0, kYawRate * t)).position;
}

/// Odometry with a constant error in yaw rate and speed, logged at the given rate; fixes at 1 Hz, off the
/// log's stamps.
PreparedDrive drive_at(double rate_hz) {
  PreparedDrive drive;
  for (int i = 0; i <= kSeconds * rate_hz; ++i) {
    drive.odometry.push_back({Stamp::from_seconds(i / rate_hz), kSpeed * 1.004, kYawRate + 0.0005});
  }
  std::mt19937 generator(7);
  std::normal_distribution<double> noise(0, 1.5);
  for (int k = 0; k < kSeconds; ++k) {
    Fix fix;
    fix.stamp = Stamp::from_seconds(k + 0.3737);
    fix.position = true_position(k + 0.3737) + Eigen::Vector2d(noise(generator), noise(generator));
    fix.covariance = 2.25 * Eigen::Matrix2d::Identity();
    fix.epoch = k;
    drive.fixes.push_back(fix);
  }
  return drive;
}

struct Fused {
  std::vector<StampedPose> poses;
  double chi2 = 0;
};

Fused fused(const PreparedDrive& drive) {
  const TypeRegistry registry = waymark_test::full_registry();
  FusionSettings settings;
  settings.modeling = "g1";
  settings.gate.enabled = false;
  settings.minimization.solver = "eigen";
  const FusedDrive result = fuse(drive, settings, registry);
  REQUIRE(result.minimum.summary.converged());
  return {poses_at_fixes(result.model.document), result.minimum.summary.final_chi2};
}

void check_same(const Fused& a, const Fused& b) {
  CHECK(a.chi2 == Approx(b.chi2).epsilon(1e-4));
  REQUIRE(a.poses.size() == b.poses.size());
  double worst = 0;
  for (std::size_t i = 0; i < a.poses.size(); ++i) {
    worst = std::max(worst, (a.poses[i].pose.head<2>() - b.poses[i].pose.head<2>()).norm());
  }
  // A per-edge noise model would move poses by decimetres here; the rest is the curvature of the error
  // inside an interval, of second order.
  CHECK(worst < 2e-3);
}

}  // namespace

TEST_CASE("additivity: the same drive logged at 10, 25 and 100 Hz gives the same fused poses") {
  const Fused reference = fused(drive_at(25));
  check_same(fused(drive_at(10)), reference);
  check_same(fused(drive_at(100)), reference);
}

TEST_CASE("additivity: nodes that only split intervals do not change the fused poses") {
  const PreparedDrive drive = drive_at(10);
  PreparedDrive split = drive;
  // Withheld fixes get nodes of their own but no edges: pure splits, at irregular places.
  for (int k = 0; k < kSeconds; ++k) {
    Fix fix = drive.fixes[static_cast<std::size_t>(k)];
    fix.stamp = Stamp::from_seconds(k + 0.6181);
    fix.status = FixStatus::withheld;
    split.fixes.push_back(fix);
  }
  std::sort(split.fixes.begin(), split.fixes.end(),
            [](const Fix& a, const Fix& b) { return a.stamp < b.stamp; });
  Fused of_split = fused(split);
  std::vector<StampedPose> kept;
  for (std::size_t i = 0; i < of_split.poses.size(); ++i) {
    if (split.fixes[i].status == FixStatus::accepted) kept.push_back(of_split.poses[i]);
  }
  of_split.poses = kept;
  check_same(of_split, fused(drive));
}

}  // namespace additivity_test
