// Tyres that slip make speeds wrong in proportion to the acceleration; what that does to a way is known.
#include <cmath>

#include <catch2/catch.hpp>

#include <waymark/tools/drive/estimation/speed_slip.hpp>

namespace speed_slip_test {

using namespace waymark;
using namespace waymark::drive;

namespace {

constexpr double kSlip = 0.01;
constexpr double kEnd_s = 120;

double true_speed_mps(double t) {
  return 20 - 10 * std::cos(0.1 * t);
}

double acceleration_mps2(double t) {
  return std::sin(0.1 * t);
}

/// A vehicle between 10 and 30 m/s, and what its wheels say with a slip.
PreparedDrive drive_with(double slip) {
  PreparedDrive drive;
  for (double t = 0; t <= kEnd_s; t += 0.1)
    drive.odometry.push_back({.stamp = Stamp::from_seconds(t),
                              .speed_mps = true_speed_mps(t) * (1 + slip * acceleration_mps2(t))});
  return drive;
}

}  // namespace

TEST_CASE("speed slip: without it speeds are the true ones, to the square of the slip") {
  const PreparedDrive freed = without_slip(drive_with(kSlip), {kSlip, 0});
  REQUIRE(freed.odometry.size() == drive_with(0).odometry.size());
  double worst_mps = 0;
  for (const OdometrySample& sample : freed.odometry) {
    const double t = seconds_between(freed.odometry.front().stamp, sample.stamp);
    if (t < 1 || t > kEnd_s - 1) continue;
    worst_mps = std::max(worst_mps, std::abs(sample.speed_mps - true_speed_mps(t)));
  }
  CHECK(worst_mps < 10 * kSlip * kSlip * 30);  // of 0.2 m/s
}

TEST_CASE("speed slip: a way is longer by half of the slip times the change of the squared speed") {
  const auto way_m = [](const PreparedDrive& drive, double until_s) {
    double way = 0;
    for (std::size_t i = 1; i < drive.odometry.size(); ++i) {
      const double t = seconds_between(drive.odometry.front().stamp, drive.odometry[i].stamp);
      if (t <= until_s) way += 0.05 * (drive.odometry[i - 1].speed_mps + drive.odometry[i].speed_mps);
    }
    return way;
  };
  const double half_period_s = 31.4;  // from 10 to 30 m/s
  const double longer_m = way_m(drive_with(kSlip), half_period_s) - way_m(drive_with(0), half_period_s);
  CHECK(longer_m == Approx(0.5 * kSlip * (30 * 30 - 10 * 10)).epsilon(0.01));
}

TEST_CASE("speed slip: speeds across a silence stay as they are") {
  PreparedDrive drive;
  for (const double t : {0.0, 10.0, 20.0})
    drive.odometry.push_back({.stamp = Stamp::from_seconds(t), .speed_mps = t});
  const PreparedDrive freed = without_slip(drive, {kSlip, 0});
  for (std::size_t i = 0; i < 3; ++i) CHECK(freed.odometry[i].speed_mps == drive.odometry[i].speed_mps);
}

}  // namespace speed_slip_test
