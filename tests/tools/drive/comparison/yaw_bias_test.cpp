// A constant error of the yaw rate is told by the fixes: that of a gyro by the time, that of unequal wheels by the way.
#include <cmath>
#include <random>

#include <catch2/catch.hpp>

#include <waymark/tools/drive/comparison/chords.hpp>
#include <waymark/types_se2/se2.hpp>

namespace yaw_bias_test {

using namespace waymark;
using namespace waymark::drive;

namespace {

/// A bias as it is put into the readings.
struct Bias {
  double radps = 0;
  double radpm = 0;
};

/// Twenty minutes of bends to either side at 5 to 25 m/s, and fixes at 1 Hz with 1 m of noise per axis.
ReckonedFixes drive_with(const Bias& bias, unsigned seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  ReckonedFixes receiver;
  Pose2<double> truth;
  Pose2<double> read;
  double heading = 0;
  for (int second = 0; second < 1200; ++second) {
    Fix fix;
    fix.stamp = Stamp::from_seconds(second);
    fix.position = truth.position + Eigen::Vector2d(normal(random), normal(random));
    receiver.fixes.push_back(fix);
    receiver.antenna.emplace_back(read.position.x(), read.position.y(), heading);
    receiver.place.push_back(static_cast<std::size_t>(second));
    const double speed = 15 + 10 * std::sin(second / 40.0);
    const double turn = 0.1 * std::sin(second / 15.0);
    const double reading = turn + bias.radps + bias.radpm * speed;
    truth = compose(truth, se2_exp<double>(Eigen::Vector3d(speed, 0, turn)));
    read = compose(read, se2_exp<double>(Eigen::Vector3d(speed, 0, reading)));
    heading += reading;
  }
  return receiver;
}

YawBias found_in(const ReckonedFixes& receiver) {
  return bias_of(chords_of(receiver, 30, [](const ChordPair& chord) { return chord.gnss.norm() >= 20; }));
}

}  // namespace

TEST_CASE("yaw bias: that of time and that of the way are told from each other") {
  for (unsigned seed = 1; seed <= 10; ++seed) {
    for (const double sign : {-1.0, 1.0}) {
      INFO("seed " << seed << ", sign " << sign);
      const YawBias of_time = found_in(drive_with({.radps = sign * 0.05}, seed));
      CHECK(of_time.is_large());
      CHECK(of_time.radpm == 0);
      CHECK(of_time.radps == Approx(sign * 0.05).margin(0.005));
      const YawBias of_way = found_in(drive_with({.radpm = sign * 0.004}, seed));
      CHECK(of_way.is_large());
      CHECK(of_way.radps == 0);
      CHECK(of_way.radpm == Approx(sign * 0.004).margin(0.0004));
    }
  }
}

TEST_CASE("yaw bias: bends and noise alone are none") {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    INFO("seed " << seed);
    CHECK_FALSE(found_in(drive_with({}, seed)).is_large());
  }
}

TEST_CASE("yaw bias: without it the odometry moves as the fixes do") {
  for (const Bias& bias : {Bias{.radps = 0.05}, Bias{.radpm = 0.004}}) {
    const ReckonedFixes bent = drive_with(bias, 1);
    const ReckonedFixes mended = without_error(bent, {.bias_radps = bias.radps, .bias_radpm = bias.radpm});
    const double truth = drive_with({}, 1).antenna.back()[2];
    CHECK(std::abs(bent.antenna.back()[2] - truth) > 50);
    CHECK(mended.antenna.back()[2] == Approx(truth).margin(0.2));
    CHECK_FALSE(found_in(mended).is_large());
  }
}

}  // namespace yaw_bias_test
