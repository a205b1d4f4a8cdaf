// A yaw rate from wheels or steering is told from a gyro's by its readings at rest.
#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include <catch2/catch.hpp>

#include <waymark/tools/drive/nodes/yaw_rate_at_rest.hpp>

namespace yaw_rate_at_rest_test {

using namespace waymark;
using namespace waymark::drive;

TEST_CASE("yaw rate at rest: one that never changes at rest is no gyro's, and a gyro shows its noise there") {
  std::mt19937_64 random(7);
  std::normal_distribution<double> noise(0, 0.01);
  std::vector<OdometrySample> wheels;
  for (int i = 0; i < 2000; ++i)
    wheels.push_back({.stamp = Stamp::from_seconds(0.1 * i),
                      .speed_mps = i < 1500 ? 0.0 : 5.0,
                      .yaw_rate_radps = i < 1500 ? 0.0 : 0.01 * i});
  CHECK(yaw_rate_at_rest(wheels).is_derived());
  std::vector<OdometrySample> gyro = wheels;
  for (OdometrySample& sample : gyro) sample.yaw_rate_radps += 0.02 + noise(random);
  const YawRateAtRest rest = yaw_rate_at_rest(gyro);
  CHECK_FALSE(rest.is_derived());
  CHECK(rest.seconds == Approx(149.9));
  CHECK(rest.variance_per_s == Approx(1e-4 * 0.1).epsilon(0.15));  // variance times period; 1500 readings
  wheels.erase(wheels.begin(), wheels.begin() + 1460);             // 4 s at rest
  CHECK_FALSE(yaw_rate_at_rest(wheels).is_known());
}

TEST_CASE("yaw rate at rest: turning on the spot is no rest") {
  std::vector<OdometrySample> robot;
  for (int i = 0; i < 200; ++i)
    robot.push_back({.stamp = Stamp::from_seconds(0.1 * i), .yaw_rate_radps = i < 100 ? 0.0 : 0.5});
  CHECK(yaw_rate_at_rest(robot).seconds == Approx(9.9));
  CHECK(yaw_rate_at_rest(robot).is_derived());
}

/// A minute at rest at 10 Hz; from 20 to 40 s the vehicle turns by the rate.
std::vector<OdometrySample> stop_with_turn(double turn_radps, double bias_radps, double noise_radps) {
  std::mt19937_64 random(7);
  std::normal_distribution<double> noise(0, noise_radps);
  std::vector<OdometrySample> samples;
  for (int i = 0; i < 600; ++i)
    samples.push_back(
        {.stamp = Stamp::from_seconds(0.1 * i),
         .yaw_rate_radps = bias_radps + noise(random) + (i >= 200 && i < 400 ? turn_radps : 0.0)});
  mark_turns_on_spot(samples);
  return samples;
}

TEST_CASE("yaw rate at rest: a slow turn on the spot is marked, whatever the bias") {
  for (const double bias : {-0.04, 0.0, 0.04}) {
    for (const double turn : {-0.03, 0.05}) {
      INFO(bias << " " << turn);
      const std::vector<OdometrySample> samples = stop_with_turn(turn, bias, 0.002);
      for (int i = 0; i < 600; ++i) {
        // A mean over two seconds leaves its ends open.
        if (i >= 200 && i < 400) CHECK(samples[static_cast<std::size_t>(i)].turns_on_spot);
        if (i < 180 || i >= 420) CHECK_FALSE(samples[static_cast<std::size_t>(i)].turns_on_spot);
      }
      CHECK(yaw_rate_at_rest(samples).seconds < 41);
    }
  }
}

TEST_CASE("yaw rate at rest: of a stop that is mostly a turn, the rest is no turn") {
  std::vector<OdometrySample> samples;
  for (int i = 0; i < 1000; ++i)
    samples.push_back({.stamp = Stamp::from_seconds(0.1 * i),
                       .speed_mps = i < 500 ? 1.0 : 0.0,
                       .yaw_rate_radps = 0.01 + (i >= 600 ? 0.05 : 0.001 * std::sin(i))});
  mark_turns_on_spot(samples);
  CHECK_FALSE(samples[550].turns_on_spot);
  CHECK(samples[700].turns_on_spot);
  CHECK(samples[999].turns_on_spot);
}

TEST_CASE("yaw rate at rest: a bias that drifts and the noise of a poor gyro are no turns") {
  for (const auto& samples : {stop_with_turn(0.008, 0.02, 0.002), stop_with_turn(0, 0.02, 0.1)})
    CHECK(std::none_of(samples.begin(), samples.end(),
                       [](const OdometrySample& sample) { return sample.turns_on_spot; }));
}

}  // namespace yaw_rate_at_rest_test
