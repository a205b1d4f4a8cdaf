// The scale of a yaw rate is told where turns show it, and by no other error of fixes or odometry.
#include <cmath>
#include <random>

#include <catch2/catch.hpp>

#include <waymark/tools/drive/comparison/turn_factor.hpp>
#include <waymark/types_se2/se2.hpp>

namespace turn_factor_test {

using namespace waymark;
using namespace waymark::drive;

namespace {

struct Errors {
  double factor = 1;       ///< the odometry's turns per turn of the vehicle
  double gyro_bias = 0;    ///< rad/s
  double gyro_noise = 0;   ///< rad/sqrt(s)
  double fix_noise_m = 0;  ///< per axis
  int delay_s = 0;         ///< of the fixes
};

/// Quarter turns of 5 s to either side, 15 s apart, at 10 m/s for 20 minutes, and fixes at 1 Hz.
ReckonedFixes drive_with(const Errors& errors, unsigned seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  const auto unit = [&] { return Eigen::Vector2d(normal(random), normal(random)); };
  ReckonedFixes receiver;
  std::vector<Pose2<double>> truth{{}};
  Eigen::Vector3d read = Eigen::Vector3d::Zero();
  double side = 0;
  for (int second = 0; second < 1200; ++second) {
    Fix fix;
    fix.stamp = Stamp::from_seconds(second);
    fix.position = truth[static_cast<std::size_t>(std::max(0, second - errors.delay_s))].position +
                   errors.fix_noise_m * unit();
    receiver.fixes.push_back(fix);
    receiver.antenna.push_back(read);
    receiver.place.push_back(static_cast<std::size_t>(second));
    if (second % 20 == 0) side = random() % 2 == 0 ? 1 : -1;
    const double turn = second % 20 < 15 ? 0 : side * 0.314;
    truth.push_back(compose(truth.back(), se2_exp<double>(Eigen::Vector3d(10, 0, turn))));
    const double reading = errors.factor * turn + errors.gyro_bias + errors.gyro_noise * normal(random);
    const Pose2<double> step = se2_exp<double>(Eigen::Vector3d(10, 0, reading));
    read.head<2>() += rotate(read[2], Eigen::Vector2d(step.position));
    read[2] += reading;
  }
  return receiver;
}

}  // namespace

TEST_CASE("turn factor: it comes out within four of its sigmas, beside a bias and noise of the fixes") {
  for (const double factor : {0.3, 0.7, 0.9, 1.1, 1.6}) {
    for (unsigned seed = 1; seed <= 5; ++seed) {
      INFO(factor << ", seed " << seed);
      const auto found = turn_factor(drive_with({factor, 0.02, 0, 0.5, 0}, seed));
      REQUIRE(found);
      CHECK(std::abs(found->value - factor) < 4 * found->sigma + 0.01);
      CHECK(found->sigma < 0.02);
      CHECK(found->turns > 20);
    }
  }
}

TEST_CASE("turn factor: no other error is taken for a scale") {
  const Errors others[] = {{},
                           {.factor = 1.02},
                           {.gyro_bias = 0.05},
                           {.gyro_noise = 0.1},
                           {.fix_noise_m = 3},
                           {.gyro_noise = 0.05, .fix_noise_m = 2},
                           {.delay_s = 1}};
  for (const Errors& errors : others) {
    for (unsigned seed = 1; seed <= 20; ++seed) {
      INFO("error " << &errors - others << ", seed " << seed);
      const auto found = turn_factor(drive_with(errors, seed));
      INFO((found ? found->value : 1) << " +- " << (found ? found->sigma : 0));
      CHECK_FALSE(found);
    }
  }
}

TEST_CASE("turn factor: an odometry that does not turn, or a way without turns, has none") {
  CHECK_FALSE(turn_factor(drive_with({.factor = 0, .fix_noise_m = 1}, 1)));
  ReckonedFixes straight = drive_with({.factor = 0}, 1);
  for (std::size_t i = 0; i < straight.fixes.size(); ++i)
    straight.fixes[i].position = straight.antenna[i].head<2>();
  CHECK_FALSE(turn_factor(straight));
}

}  // namespace turn_factor_test
