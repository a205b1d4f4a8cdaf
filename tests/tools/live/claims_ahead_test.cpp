// Fixes that claim what none has claimed before: a receiver whose ambiguities are fixed to centimetres loses them.
#include <algorithm>
#include <cmath>
#include <random>

#include <Eigen/LU>
#include <catch2/catch.hpp>

#include <waymark/tools/live/learning/noise_ahead.hpp>

#include "live_drive.hpp"

namespace claims_ahead_test {

using namespace waymark;
using namespace waymark::live;
using namespace waymark_test;

namespace {

constexpr double kFixed_m = 0.02;
constexpr double kFloat_m = 1.5;

/// A drive with fixes of centimetres, but for a time in which they err by metres, slowly, and claim that.
LiveDrive rtk_drive(double duration_s, double float_from_s, double float_to_s, std::uint64_t seed) {
  LiveDrive drive = live_drive("rural", duration_s, seed);
  std::mt19937 random(static_cast<unsigned>(seed));
  std::normal_distribution<double> normal;
  const drive::Projection projection(drive.simulated.frame);
  const std::vector<StampedPose>& truth = drive.simulated.poses;
  const Stamp begin = stamp_of(drive.arrivals.front());
  Eigen::Vector2d slow(kFloat_m * normal(random), kFloat_m * normal(random));
  for (Sample& sample : drive.arrivals) {
    auto* fix = std::get_if<GeodeticFix>(&sample);
    if (fix == nullptr) continue;
    const double decay = std::exp(-1.0 / 60);
    slow = decay * slow +
           kFloat_m * std::sqrt(1 - decay * decay) * Eigen::Vector2d(normal(random), normal(random));
    const double at_s = seconds_between(begin, fix->stamp);
    const bool floats = at_s > float_from_s && at_s < float_to_s;
    const auto at = std::lower_bound(truth.begin(), std::prev(truth.end()), fix->stamp,
                                     [](const StampedPose& of, Stamp moment) { return of.stamp < moment; });
    const Eigen::Vector2d error =
        floats ? slow : Eigen::Vector2d(kFixed_m * normal(random), kFixed_m * normal(random));
    const GeodeticPoint point = projection.to_geodetic(at->pose.head<2>() + error);
    fix->latitude_deg = point.latitude_deg;
    fix->longitude_deg = point.longitude_deg;
    const double claim_m = floats ? kFloat_m : kFixed_m;
    fix->covariance_en = claim_m * claim_m * Eigen::Matrix2d::Identity();
    fix->accuracy_claimed = true;
  }
  return drive;
}

}  // namespace

TEST_CASE("the first float solutions of a drive are not believed as the fixed ones before", "[live]") {
  double inside = 0;
  constexpr int kDrives = 3;
  for (int seed = 1; seed <= kDrives; ++seed) {
    const LiveDrive drive = rtk_drive(150, 80, 150, static_cast<std::uint64_t>(seed));
    inside += coverage95(listen(drive.arrivals), drive) / kDrives;
  }
  CHECK(inside > 0.9);
}

TEST_CASE("fixes of centimetres are worth decimetres before the drive has told their noise", "[live]") {
  const LiveDrive drive = rtk_drive(50, 1e6, 1e6, 1);
  const Said said = listen(drive.arrivals);
  CHECK(rms(errors_m(said, drive)) < 0.5);
  CHECK(coverage95(said, drive) > 0.9);
}

TEST_CASE("noise ahead: few minutes tell little of an exponent, many tell all", "[live]") {
  CHECK(deviation_ahead(0.3, 0.3, 600) == Approx(0.3));                 // the drive tells nothing
  CHECK(deviation_ahead(1e-6, 0.3, 90) == Approx(0.3 / std::sqrt(2)));  // one sample of a minute and a half
  CHECK(deviation_ahead(0.1, 0.3, 1e9) == Approx(0.1).epsilon(1e-3));
  CHECK(deviation_ahead(0.1, 0.3, 600) > deviation_ahead(0.1, 0.3, 1200));
}

}  // namespace claims_ahead_test
