/// A drive on bends with receivers whose errors last, for tests of what makes its fixes most probable.
#pragma once

#include <cmath>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include <Eigen/LU>

#include <waymark/tools/drive/model/fuse.hpp>
#include <waymark/tools/drive/model/poses_at_fixes.hpp>
#include <waymark/types_se2/se2.hpp>

#include "support/registry.hpp"

namespace waymark_test {

struct ReceiversScene {
  waymark::drive::PreparedDrive drive;
  std::vector<Eigen::Vector2d> truth;  ///< at the fixes
};

struct SceneReceiver {
  std::string name = "gnss";
  double white_m = 0.8;
  double lasting_m = 1.5;  ///< sigma of the error that lasts
  double lasting_s = 30;
  bool errs_as_first = false;  ///< it has the lasting error of the first receiver
  Eigen::Vector2d jump_m{0, 0};
  double jumps_at_s = 240;
};

/// Eight minutes of bends at 10 Hz and 8 to 16 m/s, from stamp 1000 s on. @param every so many samples each receiver has a fix
inline ReceiversScene receivers_scene(const std::vector<SceneReceiver>& receivers, std::uint64_t seed,
                                      int every = 10) {
  using namespace waymark;
  constexpr double kStep_s = 0.1;
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal(0, 1);
  const auto noise = [&] { return Eigen::Vector2d(normal(random), normal(random)); };
  ReceiversScene result;
  std::vector<Eigen::Vector2d> lasting;
  for (const SceneReceiver& receiver : receivers) {
    result.drive.receivers.push_back({receiver.name});
    lasting.emplace_back(receiver.lasting_m * noise());
  }
  Pose2<double> pose(0, 0, 0.7);
  const auto speed_at = [](double t) { return 12 + 4 * std::sin(t / 7); };
  const auto turn_at = [](double t) { return 0.15 * std::sin(t / 11) + 0.1 * std::sin(t / 4); };
  for (int i = 0; i <= 4800; ++i) {
    const double t = i * kStep_s;
    result.drive.odometry.push_back({.stamp = Stamp::from_seconds(1000 + t),
                                     .speed_mps = speed_at(t) + 0.03 * normal(random),
                                     .yaw_rate_radps = turn_at(t) + 0.002 * normal(random)});
    for (std::size_t r = 0; r < receivers.size() && i % every == 0 && i > 0 && i < 4800; ++r) {
      const SceneReceiver& receiver = receivers[r];
      const double kept = std::exp(-every * kStep_s / receiver.lasting_s);
      lasting[r] = kept * lasting[r] + std::sqrt(1 - kept * kept) * receiver.lasting_m * noise();
      Fix fix;
      fix.stamp = Stamp::from_seconds(1000 + t);
      fix.epoch = i / every - 1;
      fix.source = static_cast<int>(r);
      fix.position = pose.position + lasting[receiver.errs_as_first ? 0 : r] + receiver.white_m * noise();
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

/// Fuses a scene, with the covariances at its fixes.
inline waymark::drive::FusedDrive fused(const ReceiversScene& of,
                                        waymark::drive::FusionSettings settings = {}) {
  settings.minimization.covariances = "fixes";
  return waymark::drive::fuse(of.drive, settings, registry());
}

/// Returns the warning that contains some words; empty: there is none.
inline std::string warning_with(const std::string& words, const waymark::drive::FusedDrive& fused) {
  for (const std::string& warning : fused.model.warnings())
    if (warning.find(words) != std::string::npos) return warning;
  return {};
}

struct SceneResult {
  double rms_m = 0;
  double inside = 0;  ///< share of positions within their ellipse of 95 %
};

inline SceneResult result_of(const waymark::drive::FusedDrive& fused, const ReceiversScene& of) {
  const auto poses = waymark::drive::evaluated_poses(fused.model.document);
  const auto covariances = waymark::drive::evaluated_covariances(fused.model.document);
  SceneResult result;
  for (std::size_t i = 0; i < of.truth.size(); ++i) {
    const Eigen::Vector2d error = poses[i].pose.head<2>() - of.truth[i];
    result.rms_m += error.squaredNorm();
    result.inside += error.dot(covariances[i]->inverse() * error) <= 5.991;
  }
  const auto count = static_cast<double>(of.truth.size());
  return {std::sqrt(result.rms_m / count), result.inside / count};
}

}  // namespace waymark_test
