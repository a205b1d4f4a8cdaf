// A yaw rate from wheels or steering is told from a gyro's by its readings at rest.
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

}  // namespace yaw_rate_at_rest_test
