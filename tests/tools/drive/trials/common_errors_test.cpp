// Receivers that err alike do not confirm each other: they are found, and taken for a group.
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include <Eigen/LU>
#include <catch2/catch.hpp>

#include <waymark/tools/drive/model/fuse.hpp>
#include <waymark/tools/drive/model/poses_at_fixes.hpp>
#include <waymark/types_se2/se2.hpp>

#include "support/registry.hpp"

namespace common_errors_test {

using namespace waymark;
using namespace waymark::drive;
using namespace waymark_test;

namespace {

struct Scene {
  PreparedDrive drive;
  std::vector<Eigen::Vector2d> truth;  ///< at the fixes
};

/// Eight minutes of bends, and two receivers with fixes of 0.5 m once in a second, beside errors of 3 m that last for 40 s.
/// @param are_common whether both have the same of these
Scene scene(bool are_common, std::uint64_t seed) {
  constexpr double kStep_s = 0.1;
  constexpr double kLasting_m = 3;
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal(0, 1);
  const auto noise = [&] { return Eigen::Vector2d(normal(random), normal(random)); };
  Scene result;
  result.drive.receivers = {{"front"}, {"rear"}};
  Eigen::Vector2d lasting[2] = {kLasting_m * noise(), kLasting_m * noise()};
  const double kept = std::exp(-1.0 / 40);
  Pose2<double> pose(0, 0, 0.7);
  const auto speed_at = [](double t) { return 12 + 4 * std::sin(t / 7); };
  const auto turn_at = [](double t) { return 0.15 * std::sin(t / 11) + 0.1 * std::sin(t / 4); };
  for (int i = 0; i <= 4800; ++i) {
    const double t = i * kStep_s;
    result.drive.odometry.push_back({.stamp = Stamp::from_seconds(1000 + t),
                                     .speed_mps = speed_at(t) + 0.03 * normal(random),
                                     .yaw_rate_radps = turn_at(t) + 0.002 * normal(random)});
    for (int r = 0; r < 2 && i % 10 == 0 && i > 0 && i < 4800; ++r) {
      lasting[r] = kept * lasting[r] + std::sqrt(1 - kept * kept) * kLasting_m * noise();
      Fix fix;
      fix.stamp = Stamp::from_seconds(1000 + t);
      fix.epoch = i / 10 - 1;
      fix.source = r;
      fix.position = pose.position + lasting[are_common ? 0 : r] + 0.5 * noise();
      fix.covariance = 9 * Eigen::Matrix2d::Identity();
      result.drive.fixes.push_back(fix);
      result.truth.push_back(pose.position);
    }
    const double middle = t + 0.5 * kStep_s;
    pose = compose(
        pose, se2_exp<double>(Eigen::Vector3d(speed_at(middle) * kStep_s, 0, turn_at(middle) * kStep_s)));
  }
  return result;
}

FusedDrive fused(const Scene& of, const FusionSettings& stated = {}) {
  FusionSettings settings = stated;
  settings.minimization.covariances = "fixes";
  return fuse(of.drive, settings, registry());
}

bool is_told(const FusedDrive& fused) {
  for (const std::string& warning : fused.model.warnings())
    if (warning.find("receivers err alike, 'rear' as 'front' does") != std::string::npos) return true;
  return false;
}

/// Returns the share of positions within their ellipse of 95 %.
double inside(const FusedDrive& fused, const Scene& of) {
  const auto poses = evaluated_poses(fused.model.document);
  const auto covariances = evaluated_covariances(fused.model.document);
  double count = 0;
  for (std::size_t i = 0; i < of.truth.size(); ++i) {
    const Eigen::Vector2d error = poses[i].pose.head<2>() - of.truth[i];
    count += error.dot(covariances[i]->inverse() * error) <= 5.991;
  }
  return count / static_cast<double>(of.truth.size());
}

}  // namespace

TEST_CASE("common errors: two receivers that err alike are told, and are as if 'common' were stated") {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    CAPTURE(seed);
    const Scene alike = scene(true, seed);
    const FusedDrive found = fused(alike);
    CHECK(is_told(found));
    CHECK(inside(found, alike) > 0.9);
    FusionSettings stated;
    stated.sources["rear"].common = "front";
    const FusedDrive as_stated = fused(alike, stated);
    CHECK_FALSE(is_told(as_stated));
    CHECK(found.model.settings.sources.at("rear").common == "front");
    CHECK(found.minimum.summary.final_chi2 == Approx(as_stated.minimum.summary.final_chi2).epsilon(0.01));
  }
}

TEST_CASE("common errors: receivers with errors of their own are no group") {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    CAPTURE(seed);
    CHECK_FALSE(is_told(fused(scene(false, seed))));
  }
}

TEST_CASE("common errors: what is stated for a receiver alone is left as it is") {
  FusionSettings stated;
  stated.sources["rear"].options["white_sigma"] = "0.5";
  CHECK_FALSE(is_told(fused(scene(true, 1), stated)));
}

}  // namespace common_errors_test
