// Where a receiver that smooths has the vehicle: by the transfer function of its filter,
// H(s) = (1 + sqrt(2) T s) / (1 + sqrt(2) T s + T^2 s^2).
#include <cmath>
#include <complex>
#include <vector>

#include <catch2/catch.hpp>

#include <waymark/tools/drive/nodes/receiver_filter.hpp>

namespace receiver_filter_test {

using namespace waymark;
using namespace waymark::drive;

namespace {

constexpr double kTime_s = 1.5;

std::vector<Interval> motion(double duration_s, double dt_s, double first_mps, double acceleration_mps2,
                             double yaw_rate_radps) {
  std::vector<Interval> intervals;
  for (double t = 0.5 * dt_s; t < duration_s; t += dt_s)
    intervals.push_back(
        {.speed_mps = first_mps + acceleration_mps2 * t, .yaw_rate_radps = yaw_rate_radps, .dt_s = dt_s});
  return intervals;
}

Eigen::Vector2d at_end(const std::vector<Interval>& intervals) {
  return smoothed_beside(intervals, kTime_s, 0.01).back();
}

}  // namespace

TEST_CASE("receiver filter: at constant speed on a straight way it is right, from the first node on") {
  for (const Eigen::Vector2d& beside : smoothed_beside(motion(20, 0.1, 15, 0, 0), kTime_s, 0.01))
    CHECK(beside.norm() < 1e-12);
}

TEST_CASE("receiver filter: it stays behind by T^2 times an acceleration that lasts, and settles at rest") {
  std::vector<Interval> intervals = motion(30, 0.1, 1, 0.8, 0);
  CHECK(at_end(intervals).x() == Approx(-kTime_s * kTime_s * 0.8).epsilon(1e-3));
  CHECK(std::abs(at_end(intervals).y()) < 1e-12);
  const std::vector<Interval> rest = motion(30, 0.1, 0, 0, 0);
  intervals.insert(intervals.end(), rest.begin(), rest.end());
  CHECK(at_end(intervals).norm() < 1e-3);
}

TEST_CASE("receiver filter: on a circle it is where its transfer function says, outside and behind") {
  constexpr double kSpeed_mps = 10;
  constexpr double kTurn_radps = 0.25;
  const std::complex<double> s(0, kTurn_radps * kTime_s);
  const std::complex<double> transfer = (1.0 + std::sqrt(2.0) * s) / (1.0 + std::sqrt(2.0) * s + s * s);
  // The vehicle is at r exp(i w t) and heads along i exp(i w t).
  const std::complex<double> beside =
      (transfer - 1.0) * (kSpeed_mps / kTurn_radps) / std::complex<double>(0, 1);
  for (const double dt_s : {0.02, 0.2}) {
    const Eigen::Vector2d at = at_end(motion(40, dt_s, kSpeed_mps, 0, kTurn_radps));
    CHECK(at.x() == Approx(beside.real()).epsilon(0.01));
    CHECK(at.y() == Approx(beside.imag()).epsilon(0.01));
    CHECK(at.y() < -4);  // to the right of a left bend: 5.6 m are T^2 v w
  }
}

TEST_CASE("receiver filter: how a way is split into intervals changes nothing") {
  std::vector<Interval> split;
  const std::vector<Interval> whole = motion(8, 0.8, 4, 1, 0);
  for (const Interval& interval : whole) {
    Interval part = interval;
    part.dt_s = interval.dt_s / 4;
    split.insert(split.end(), 4, part);
  }
  CHECK((at_end(split) - at_end(whole)).norm() < 1e-9);
}

}  // namespace receiver_filter_test
