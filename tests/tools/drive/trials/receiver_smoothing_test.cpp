// A receiver that smooths its positions is found by fusing, and what it does to them is taken out.
#include <cmath>
#include <random>

#include <catch2/catch.hpp>

#include <waymark/tools/drive/model/fuse.hpp>
#include <waymark/types_se2/se2.hpp>

#include "support/registry.hpp"

namespace receiver_smoothing_test {

using namespace waymark;
using namespace waymark::drive;
using namespace waymark_test;

namespace {

struct SmoothedDrive {
  PreparedDrive drive;
  std::vector<Eigen::Vector2d> truth;  ///< at the fixes
  double raw_rms_m = 0;
};

constexpr double kFixes_s = 0.2;
/// Of an alpha-beta filter, the discrete form of the Kalman filter: alpha^2 = 2 beta for small beta.
constexpr double kBeta = 0.0178;
const double kAlpha = std::sqrt(2 * kBeta);
/// It stays behind by (1 - alpha) dt^2 / beta times the acceleration, a ReceiverFilter by T^2 times that.
const double kTime_s = kFixes_s * std::sqrt((1 - kAlpha) / kBeta);

/// Six minutes of bends at 10 Hz and 2 to 14 m/s, with fixes at 5 Hz that are good to 5 cm.
/// @param is_filtered whether the receiver filters them
SmoothedDrive drive_with(bool is_filtered) {
  constexpr double kStep_s = 0.1;
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal(0, 1);
  SmoothedDrive result;
  result.drive.receivers = {{"gnss"}};
  const auto speed_at = [](double t) { return 8 + 6 * std::sin(t / 5); };
  const auto turn_at = [](double t) { return 0.15 * std::sin(t / 11) + 0.1 * std::sin(t / 4); };
  Pose2<double> pose(0, 0, 0.7);
  Eigen::Vector2d place = pose.position;
  Eigen::Vector2d velocity = speed_at(0) * Eigen::Vector2d(std::cos(0.7), std::sin(0.7));
  double sum = 0;
  for (int i = 0; i <= 3600; ++i) {
    const double t = i * kStep_s;
    result.drive.odometry.push_back({.stamp = Stamp::from_seconds(1000 + t),
                                     .speed_mps = speed_at(t) + 0.03 * normal(random),
                                     .yaw_rate_radps = turn_at(t) + 0.002 * normal(random)});
    if (i % 2 == 0 && i > 0 && i < 3600) {
      const Eigen::Vector2d measured = pose.position + 0.05 * Eigen::Vector2d(normal(random), normal(random));
      place += kFixes_s * velocity;
      const Eigen::Vector2d new_in_it = measured - place;
      place += kAlpha * new_in_it;
      velocity += kBeta / kFixes_s * new_in_it;
      Fix fix;
      fix.stamp = Stamp::from_seconds(1000 + t);
      fix.epoch = i / 2 - 1;
      fix.position = is_filtered ? place : measured;
      fix.covariance = 0.25 * Eigen::Matrix2d::Identity();
      result.drive.fixes.push_back(fix);
      result.truth.push_back(pose.position);
      sum += (fix.position - pose.position).squaredNorm();
    }
    const double middle = t + 0.5 * kStep_s;
    pose = compose(
        pose, se2_exp<double>(Eigen::Vector3d(speed_at(middle) * kStep_s, 0, turn_at(middle) * kStep_s)));
  }
  result.raw_rms_m = std::sqrt(sum / static_cast<double>(result.truth.size()));
  return result;
}

double rms_m(const FusedDrive& fused, const SmoothedDrive& of) {
  const Graph& graph = fused.model.document.graph;
  double sum = 0;
  for (std::size_t i = 0; i < of.truth.size(); ++i) {
    const VertexId node = vertex_of(fused.model.placed.timeline.fix_node[i]);
    sum += (Eigen::Vector2d(graph.value(graph.find(node).value()).data()) - of.truth[i]).squaredNorm();
  }
  return std::sqrt(sum / static_cast<double>(of.truth.size()));
}

std::string told(const FusedDrive& fused) {
  for (const std::string& warning : fused.model.warnings())
    if (warning.find("smoothed by the receiver") != std::string::npos) return warning;
  return {};
}

}  // namespace

TEST_CASE("smoothing receiver: its time is found, and what it does to the positions is taken out") {
  const SmoothedDrive of = drive_with(true);
  REQUIRE(of.raw_rms_m > 1);
  const FusedDrive fused = fuse(of.drive, {}, registry());
  CHECK(fused.model.placed.smoothings_s.front() == Approx(kTime_s).epsilon(0.05));
  CHECK_THAT(told(fused), Catch::Contains("state 'smoothing: 1."));
  CHECK(rms_m(fused, of) < 0.2 * of.raw_rms_m);
  CHECK(std::abs(fused.model.placed.time_offsets_s.front()) < 0.03);
  // what is compared with the fixes is where the receiver has the antenna
  for (const Fix& fix : fused.model.document.fixes) REQUIRE(fix.smoothed_m.norm() < 10);
}

TEST_CASE("smoothing receiver: what is stated is believed, and one that does not smooth is told nothing") {
  SmoothedDrive of = drive_with(true);
  of.drive.receivers.front().smoothing_s = 0;
  const FusedDrive without = fuse(of.drive, {}, registry());
  CHECK(told(without).empty());
  CHECK(without.model.placed.smoothings_s.front() == 0);
  of.drive.receivers.front().smoothing_s = kTime_s;
  const FusedDrive stated = fuse(of.drive, {}, registry());
  CHECK(told(stated).empty());
  CHECK(rms_m(stated, of) < 0.2 * of.raw_rms_m);
  CHECK(rms_m(stated, of) < 0.5 * rms_m(without, of));

  const FusedDrive sharp = fuse(drive_with(false).drive, {}, registry());
  CHECK(told(sharp).empty());
  CHECK(sharp.model.placed.smoothings_s.front() == 0);
}

TEST_CASE("smoothing receiver: the paper's modelings take a stated filter out of the fixes as well") {
  for (const char* modeling : {"g1", "g2", "g3"}) {
    SmoothedDrive of = drive_with(true);
    FusionSettings settings;
    settings.modeling = modeling;
    const double without_m = rms_m(fuse(of.drive, settings, registry()), of);
    of.drive.receivers.front().smoothing_s = kTime_s;
    CHECK(rms_m(fuse(of.drive, settings, registry()), of) < 0.5 * without_m);
  }
}

}  // namespace receiver_smoothing_test
