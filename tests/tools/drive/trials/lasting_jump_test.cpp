// Fixes that are elsewhere from a moment on, for good: the drive does not know which side is right, and says so.
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include <Eigen/LU>
#include <catch2/catch.hpp>

#include <waymark/tools/drive/model/fuse.hpp>
#include <waymark/tools/drive/model/poses_at_fixes.hpp>
#include <waymark/tools/drive/trials/lasting_jump.hpp>
#include <waymark/types_se2/se2.hpp>

#include "support/registry.hpp"

namespace lasting_jump_test {

using namespace waymark;
using namespace waymark::drive;
using namespace waymark_test;

namespace {

struct Scene {
  PreparedDrive drive;
  std::vector<Eigen::Vector2d> truth;  ///< at the fixes
};

struct Receiver {
  double white_m = 0.8;
  double lasting_m = 1.5;  ///< sigma of the error that lasts for 30 s
  Eigen::Vector2d jump_m{0, 0};
  double jumps_at_s = 240;
};

/// Eight minutes of bends at 10 Hz and 8 to 16 m/s, with fixes of each receiver once in a second.
Scene scene(const std::vector<Receiver>& receivers, std::uint64_t seed, int every = 10) {
  constexpr double kStep_s = 0.1;
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal(0, 1);
  const auto noise = [&] { return Eigen::Vector2d(normal(random), normal(random)); };
  Scene result;
  for (std::size_t r = 0; r < receivers.size(); ++r)
    result.drive.receivers.push_back({r == 0 ? "gnss" : "other"});
  std::vector<Eigen::Vector2d> lasting;
  for (const Receiver& receiver : receivers) lasting.emplace_back(receiver.lasting_m * noise());
  const double kept = std::exp(-every * kStep_s / 30);
  Pose2<double> pose(0, 0, 0.7);
  const auto speed_at = [](double t) { return 12 + 4 * std::sin(t / 7); };
  const auto turn_at = [](double t) { return 0.15 * std::sin(t / 11) + 0.1 * std::sin(t / 4); };
  for (int i = 0; i <= 4800; ++i) {
    const double t = i * kStep_s;
    result.drive.odometry.push_back({.stamp = Stamp::from_seconds(1000 + t),
                                     .speed_mps = speed_at(t) + 0.03 * normal(random),
                                     .yaw_rate_radps = turn_at(t) + 0.002 * normal(random)});
    for (std::size_t r = 0; r < receivers.size() && i % every == 0 && i > 0 && i < 4800; ++r) {
      const Receiver& receiver = receivers[r];
      lasting[r] = kept * lasting[r] + std::sqrt(1 - kept * kept) * receiver.lasting_m * noise();
      Fix fix;
      fix.stamp = Stamp::from_seconds(1000 + t);
      fix.epoch = i / every - 1;
      fix.source = static_cast<int>(r);
      fix.position = pose.position + lasting[r] + receiver.white_m * noise();
      if (t >= receiver.jumps_at_s) fix.position += receiver.jump_m;
      const double claimed_m = std::hypot(receiver.white_m, receiver.lasting_m);
      fix.covariance = claimed_m * claimed_m * Eigen::Matrix2d::Identity();
      result.drive.fixes.push_back(fix);
      result.truth.push_back(pose.position);
    }
    const double middle = t + 0.5 * kStep_s;
    pose = compose(
        pose, se2_exp<double>(Eigen::Vector3d(speed_at(middle) * kStep_s, 0, turn_at(middle) * kStep_s)));
  }
  return result;
}

FusedDrive fused(const Scene& of) {
  FusionSettings settings;
  settings.minimization.covariances = "fixes";
  return fuse(of.drive, settings, registry());
}

std::string told(const FusedDrive& fused) {
  for (const std::string& warning : fused.model.warnings())
    if (warning.find(" m elsewhere") != std::string::npos) return warning;
  return {};
}

/// Returns the size that is told, m; 0: nothing is told.
double told_size_m(const FusedDrive& fused) {
  const std::string warning = told(fused);
  const std::string before = " lie ";
  const auto place = warning.find(before);
  return place == std::string::npos ? 0 : std::stod(warning.substr(place + before.size()));
}

struct Result {
  double rms_m = 0;
  double inside = 0;  ///< share of positions within their ellipse of 95 %
};

Result result_of(const FusedDrive& fused, const Scene& of) {
  const auto& document = fused.model.document;
  const auto poses = evaluated_poses(document);
  const auto covariances = evaluated_covariances(document);
  Result result;
  for (std::size_t i = 0; i < of.truth.size(); ++i) {
    const Eigen::Vector2d error = poses[i].pose.head<2>() - of.truth[i];
    result.rms_m += error.squaredNorm();
    result.inside += error.dot(covariances[i]->inverse() * error) <= 5.991;
  }
  const auto count = static_cast<double>(of.truth.size());
  return {std::sqrt(result.rms_m / count), result.inside / count};
}

}  // namespace

TEST_CASE("lasting jump: it is told, the result lies between both sides, and its covariances contain both") {
  const Scene jumping = scene({{.jump_m = {12, -9}}}, 3);
  const FusedDrive result = fused(jumping);
  CHECK_THAT(told(result), Catch::StartsWith("the fixes of 'gnss' lie ") &&
                               Catch::Contains("from 239.0 s after the first fix on"));
  CHECK(told_size_m(result) == Approx(15).margin(2));
  const auto [rms_m, inside] = result_of(result, jumping);
  CHECK(rms_m <
        9.5);  // half the jump, and what fixes are off in the mean; with all fixes alike it is 15 m / sqrt(2)
  CHECK(inside > 0.9);
}

TEST_CASE("lasting jump: half a metre of fixes that are good to centimetres, at the very fix") {
  const Scene jumping =
      scene({{.white_m = 0.012, .lasting_m = 0.01, .jump_m = {0.3, 0.4}, .jumps_at_s = 299.95}}, 4, 2);
  const FusedDrive result = fused(jumping);
  CHECK(told_size_m(result) == Approx(0.5).margin(0.03));
  for (const Fix& fix : result.model.placed.fixes)
    CHECK(fix.level == (seconds_between(Stamp::from_seconds(1000), fix.stamp) > 299.95 ? 1 : 0));
  CHECK(result_of(result, jumping).inside > 0.9);
}

TEST_CASE("lasting jump: another receiver that does not jump tells which side is right") {
  const Scene alone = scene({{}}, 5);
  const Scene both = scene({{.jump_m = {-8, 14}}, {}}, 5);
  const FusedDrive result = fused(both);
  CHECK(told_size_m(result) == Approx(16).margin(2));
  CHECK(result_of(result, both).rms_m < 1.5 * result_of(fused(alone), alone).rms_m);
}

TEST_CASE("lasting jump: reflections of a minute are none") {
  Scene reflected = scene({{}}, 3);
  for (Fix& fix : reflected.drive.fixes) {
    const double t = seconds_between(Stamp::from_seconds(1000), fix.stamp);
    if (t >= 240 && t < 300) fix.position += Eigen::Vector2d(7, -5);
  }
  CHECK(told(fused(reflected)).empty());
}

TEST_CASE("lasting jump: fixes that do not jump have none, nor has one at an end of the drive") {
  for (std::uint64_t seed = 10; seed < 16; ++seed) CHECK(told(fused(scene({{}}, seed))).empty());
  CHECK(told(fused(scene({{.jump_m = {12, 9}, .jumps_at_s = 450}}, 3))).empty());
}

TEST_CASE("lasting jump: the slow errors of each side are half as large as the larger jump beside it") {
  std::vector<Fix> fixes(4);
  for (std::size_t i = 0; i < fixes.size(); ++i)
    fixes[i].stamp = Stamp::from_seconds(100.0 * static_cast<double>(i));
  fixes[3].source = 1;
  const std::vector<LastingJump> jumps = {{0, Stamp::from_seconds(150), {0, 20}},
                                          {0, Stamp::from_seconds(50), {6, 8}}};
  take_jumps(jumps, fixes);
  CHECK(fixes[0].level == 0);
  CHECK(fixes[0].jump_sigma_m == 5);
  CHECK(fixes[1].level == 1);
  CHECK(fixes[1].jump_sigma_m == 10);
  CHECK(fixes[2].level == 2);
  CHECK(fixes[2].jump_sigma_m == 10);
  CHECK(fixes[3].level == 0);
  CHECK(fixes[3].jump_sigma_m == 0);
}

}  // namespace lasting_jump_test
