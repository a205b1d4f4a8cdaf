// The process noise of the odometry: additive, so neither the log's rate nor a split changes a
// covariance; 1.1 % drift.
#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include <Eigen/Cholesky>
#include <catch2/catch.hpp>

#include <waymark/plugins/odometry/detail/noise.hpp>
#include <waymark/types_se2/se2.hpp>

#include "support/dense.hpp"

namespace odometry_noise_test {

using namespace waymark;
using namespace waymark::plugins::odometry;
using waymark_test::relative_difference;

namespace {

/// A motion with its covariance in the body frame at its end.
struct Uncertain {
  Pose2<double> motion;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
};

Uncertain of_interval(const Interval& interval, const ProcessNoise& noise = {}) {
  const Eigen::Vector3d twist(interval.speed_mps, 0, interval.yaw_rate_radps);
  return {se2_exp<double>(interval.dt_s * twist), process_covariance(interval, noise)};
}

/// First a, then b: Sigma = Ad(Z_b^-1) Sigma_a Ad(Z_b^-1)^T + Sigma_b.
Uncertain compose(const Uncertain& a, const Uncertain& b) {
  const Eigen::Matrix3d adjoint = se2_adjoint(inverse(b.motion));
  return {waymark::compose(a.motion, b.motion), adjoint * a.covariance * adjoint.transpose() + b.covariance};
}

Uncertain drive(double speed, double yaw_rate, const std::vector<double>& durations) {
  Uncertain all;
  for (const double dt : durations) all = compose(all, of_interval({speed, yaw_rate, dt, false}));
  return all;
}

const Interval kIntervals[] = {{10, 0, 0.04, false},  {10, 0.3, 0.04, false}, {-3, 0.5, 0.04, false},
                               {30, 0.1, 0.1, false}, {0.06, 1, 0.04, false}, {10, 0, 30, false},
                               {2, -0.9, 0.1, true},  {15, 0.2, 0.5, false},  {8, 0.1, 1, true, 30}};

}  // namespace

TEST_CASE("odometry noise: the covariance of an interval is that of its parts composed") {
  for (const Interval& whole : kIntervals) {
    for (const double share : {0.5, 0.01, 0.37, 0.999}) {
      INFO("v " << whole.speed_mps << " w " << whole.yaw_rate_radps << " dt " << whole.dt_s << " at "
                << share);
      Interval first = whole;
      Interval second = whole;
      first.dt_s = share * whole.dt_s;
      second.dt_s = whole.dt_s - first.dt_s;
      const Uncertain parts = compose(of_interval(first), of_interval(second));
      CHECK(relative_difference(parts.covariance, of_interval(whole).covariance) < 1e-9);
    }
  }
}

TEST_CASE(
    "odometry noise: what the readings leave open about distance, turn and a bend adds to the covariance") {
  Interval interval{.speed_mps = 10, .dt_s = 1};
  const Eigen::Matrix3d known = process_covariance(interval, {});
  interval.distance_sigma_m = 0.2;
  interval.turn_sigma_rad = 0.01;
  const Eigen::Matrix3d open = process_covariance(interval, {}) - known;
  CHECK(open(0, 0) == Approx(0.04));
  CHECK(open(2, 2) == Approx(1e-4));
  CHECK(open(1, 1) == Approx(1e-4 * 100.0 / 3));  // a turn at any time of the interval, 10 m long
  // The exact end of an even bend, 0.4 rad/s faster at the end, is v dw dt^2 / 12 beside the constant twist.
  interval = {.speed_mps = 10, .dt_s = 1, .yaw_rate_change_radps = 0.4};
  CHECK(process_covariance(interval, {})(1, 1) - known(1, 1) == Approx(std::pow(10 * 0.4 / 12, 2)));
}

TEST_CASE(
    "odometry noise: 1 km straight on at 10 m/s gives 1.1 % drift, nearly all of it through the heading") {
  const Uncertain all = drive(10, 0, std::vector<double>(2500, 0.04));
  CHECK(all.motion.position[0] == Approx(1000));
  const double variance = all.covariance(0, 0) + all.covariance(1, 1);
  CHECK(std::sqrt(variance) == Approx(11.0).epsilon(0.02));
  // Lateral variance through the heading: q L^3 / 3, with q the heading variance per metre at this
  // speed.
  const ProcessNoise noise;
  const double q = noise.heading_per_m + noise.heading_per_s / 10;
  CHECK(q * 1e9 / 3 > 0.9 * variance);
  CHECK(all.covariance(2, 2) == Approx(q * 1000).epsilon(1e-9));
}

TEST_CASE("odometry noise: the rate of the log does not matter") {
  for (const double yaw_rate : {0.0, 0.02}) {
    const Uncertain reference = drive(10, yaw_rate, std::vector<double>(2500, 0.04));
    for (const int rate : {1, 10, 50, 100}) {
      INFO(rate << " Hz");
      const Uncertain other =
          drive(10, yaw_rate, std::vector<double>(static_cast<std::size_t>(100 * rate), 1.0 / rate));
      CHECK(relative_difference(other.covariance, reference.covariance) < 1e-9);
    }
  }
}

TEST_CASE("odometry noise: splits at random instants do not matter") {
  std::mt19937_64 random(8);
  std::uniform_real_distribution<double> instant(0, 100);
  for (const double yaw_rate : {0.0, 0.05}) {
    const Uncertain reference = drive(10, yaw_rate, std::vector<double>(2500, 0.04));
    std::vector<double> cuts = {0, 100};
    for (int i = 1; i < 2500; ++i) cuts.push_back(0.04 * i);
    for (int i = 0; i < 100; ++i) cuts.push_back(instant(random));
    std::sort(cuts.begin(), cuts.end());
    std::vector<double> durations;
    for (std::size_t i = 1; i < cuts.size(); ++i) durations.push_back(cuts[i] - cuts[i - 1]);
    CHECK(relative_difference(drive(10, yaw_rate, durations).covariance, reference.covariance) < 1e-9);
  }
}

TEST_CASE("odometry noise: every covariance is symmetric and invertible, also for a split of a microsecond") {
  for (Interval interval : kIntervals) {
    for (const double dt : {1e-6, 1e-3, 0.04, 1.0, 60.0}) {
      interval.dt_s = dt;
      const Eigen::Matrix3d covariance = process_covariance(interval, {});
      CHECK((covariance - covariance.transpose()).norm() <= 1e-15 * covariance.norm());
      CHECK(covariance.allFinite());
      CHECK(Eigen::LLT<Eigen::Matrix3d>(covariance).info() == Eigen::Success);
    }
  }
}

TEST_CASE("odometry noise: a gap is as uncertain as its factor and the motions of a vehicle") {
  // short: the factor
  const Eigen::Matrix3d plain = process_covariance({10, 0.1, 2, false}, {});
  CHECK(relative_difference(process_covariance({10, 0.1, 2, true}, {}), 100 * plain) < 1e-14);
  // long: the integrals of Brownian bridges of speed and yaw rate, density gap_s^3 / 12
  const Eigen::Matrix3d long_gap = process_covariance({0, 0, 30, true, 30}, {});
  CHECK(long_gap(0, 0) == Approx(4 * 27000.0 / 12).epsilon(1e-3));
  CHECK(long_gap(2, 2) == Approx(0.04 * 27000.0 / 12).epsilon(1e-3));
}

TEST_CASE(
    "odometry noise: a gap does not depend on the noise of the sensors, so it cannot bend their estimate") {
  ProcessNoise poor;
  poor.longitudinal_per_m *= 25;
  poor.heading_per_s *= 270;
  const Interval gap{10, 0.1, 2, true, 2};
  CHECK(relative_difference(process_covariance(gap, poor), process_covariance(gap, {})) < 1e-14);
}

TEST_CASE("odometry noise: standstill information is at least 1e5 on every axis for any time") {
  for (const double dt : {1e-6, 1e-3, 0.04, 0.5, 1.0, 3.0, 10.0}) {
    const Eigen::Matrix3d covariance = standstill_covariance(dt, {});
    for (int i = 0; i < 3; ++i) {
      CHECK(covariance(i, i) > 0);
      CHECK(1 / covariance(i, i) >= 1e5 * (1 - 1e-12));
    }
  }
}

TEST_CASE("odometry noise: the paper's own covariance is 1.1 % of each edge with its floors") {
  const Eigen::Matrix3d edge = paper_covariance({20, 1.0, 1.0, false});
  CHECK(edge(0, 0) == Approx(0.22 * 0.22));
  CHECK(edge(1, 1) == Approx(0.22 * 0.22));
  CHECK(edge(2, 2) == Approx(0.011 * 0.011));
  const Eigen::Matrix3d slow = paper_covariance({0.1, 0, 0.04, false});
  CHECK(slow(0, 0) == 1e-5);
  CHECK(slow(2, 2) == 1e-6);
}

}  // namespace odometry_noise_test
