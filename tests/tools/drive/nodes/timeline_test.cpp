// Nodes in time and dead reckoning: nothing about how a drive was sampled or split may change the motion.
#include <cmath>
#include <numbers>
#include <random>

#include <catch2/catch.hpp>

#include <waymark/core/base/error.hpp>
#include <waymark/tools/drive/nodes/timeline.hpp>

namespace timeline_test {

namespace {

using namespace waymark;
using namespace waymark::drive;

Stamp at(double seconds) {
  return Stamp::from_seconds(seconds);
}

OdometrySample sample(double seconds, double speed, double yaw_rate) {
  return {.stamp = at(seconds), .speed_mps = speed, .yaw_rate_radps = yaw_rate};
}

Fix fix_at(double seconds, double grid_scale = 1) {
  Fix fix;
  fix.stamp = at(seconds);
  fix.grid_scale = grid_scale;
  return fix;
}

/// Ten seconds of a constant twist at a given rate.
std::vector<OdometrySample> constant_twist(int rate_hz, double speed, double yaw_rate) {
  std::vector<OdometrySample> odometry;
  for (int i = 0; i <= 10 * rate_hz; ++i)
    odometry.push_back(sample(static_cast<double>(i) / rate_hz, speed, yaw_rate));
  return odometry;
}

Eigen::Vector3d end_pose(const Timeline& timeline) {
  return dead_reckon(timeline, Eigen::Vector3d::Zero(), 0.05).back();
}

double total_s(const Timeline& timeline) {
  double sum = 0;
  for (const Interval& interval : timeline.intervals) sum += interval.dt_s;
  return sum;
}

}  // namespace

TEST_CASE("timeline: a constant twist gives the exact arc at any odometry rate") {
  const double speed = 12.5;
  const double yaw_rate = -0.7;  // more than one turn in ten seconds
  const Eigen::Vector3d exact(speed / yaw_rate * std::sin(10 * yaw_rate),
                              speed / yaw_rate * (1 - std::cos(10 * yaw_rate)), 10 * yaw_rate);
  for (const int rate : {1, 10, 25, 100}) {
    TimelineOptions options;
    options.gap_s = 2;
    const Timeline timeline = build_timeline(constant_twist(rate, speed, yaw_rate), {}, options);
    CHECK((end_pose(timeline) - exact).norm() < 1e-11);
  }
}

TEST_CASE(
    "timeline: splitting at arbitrary stamps changes neither heading nor time, and the end by a millimetre") {
  std::vector<OdometrySample> odometry;
  for (int i = 0; i <= 250; ++i) {
    const double t = 0.04 * i;
    odometry.push_back(sample(t, 10 + 3 * std::sin(t), 0.4 * std::cos(0.7 * t)));
  }
  std::vector<Fix> fixes;
  for (int i = 0; i < 97; ++i) fixes.push_back(fix_at(0.0137 + 0.1023 * i));
  const Timeline whole = build_timeline(odometry, {}, {});
  const Timeline split = build_timeline(odometry, fixes, {});
  CHECK(split.stamps.size() > whole.stamps.size() + 80);
  CHECK(end_pose(split)[2] == Approx(end_pose(whole)[2]).epsilon(1e-12));
  CHECK((end_pose(split) - end_pose(whole)).norm() < 1e-3);  // parts follow the linear motion more closely
  CHECK(total_s(split) == Approx(10.0).epsilon(1e-14));
  CHECK(split.intervals.size() + 1 == split.stamps.size());
  for (std::size_t i = 0; i < fixes.size(); ++i)
    CHECK(std::abs(seconds_between(split.stamps[split.fix_node[i]], fixes[i].stamp)) < 0.001);
}

TEST_CASE("timeline: a fix in an interval splits it, and speed and yaw rate are linear over both parts") {
  const std::vector<OdometrySample> odometry{sample(0, 1, 0.1), sample(0.1, 3, 0.3)};
  const Timeline timeline = build_timeline(odometry, std::vector<Fix>{fix_at(0.03)}, {});
  REQUIRE(timeline.stamps.size() == 3);
  CHECK(timeline.fix_node == std::vector<std::size_t>{1});
  // 1 m/s at 0 s, 1.6 m/s at the fix, 3 m/s at 0.1 s; the yaw rate is a tenth of it.
  const double mean[] = {1.3, 2.3};
  const double change[] = {0.6, 1.4};
  for (std::size_t i = 0; i < 2; ++i) {
    const Interval& interval = timeline.intervals[i];
    CHECK(interval.speed_mps == Approx(mean[i]));
    CHECK(interval.yaw_rate_radps == Approx(0.1 * mean[i]));
    CHECK(interval.speed_change_mps == Approx(change[i]));
    CHECK(interval.yaw_rate_change_radps == Approx(0.1 * change[i]));
    CHECK_FALSE(interval.bridged);
  }
  CHECK(timeline.intervals[0].dt_s == Approx(0.03));
  CHECK(timeline.intervals[1].dt_s == Approx(0.07));
}

TEST_CASE("timeline: what is not known of the motion between slow samples is as large as it says") {
  // White jerk: the acceleration wanders. Steps of 1 ms stand for the true motion, samples come at 1 Hz.
  std::mt19937 random(1);
  std::normal_distribution<double> jerk;
  constexpr int kSteps = 1000;
  constexpr int kSamples = 2000;
  constexpr double kStep_s = 1.0 / kSteps;
  std::vector<OdometrySample> odometry{sample(0, 15, 1.5)};
  std::vector<double> distance;
  double speed = 15;
  double acceleration = 0;
  for (int second = 1; second <= kSamples; ++second) {
    distance.push_back(0);
    for (int i = 0; i < kSteps; ++i) {
      distance.back() += kStep_s * (speed + 0.5 * kStep_s * acceleration);
      speed += kStep_s * acceleration;
      acceleration += std::sqrt(kStep_s) * jerk(random);
    }
    odometry.push_back(sample(second, speed, 0.1 * speed));
  }
  TimelineOptions options;
  options.gap_s = 2;
  const Timeline timeline = build_timeline(odometry, {}, options);
  double actual = 0;
  double told = 0;
  for (std::size_t i = 0; i < distance.size(); ++i) {
    const Interval& interval = timeline.intervals[i];
    actual += std::pow(distance[i] - interval.speed_mps, 2);
    told += std::pow(interval.distance_sigma_m, 2);
    CHECK(interval.turn_sigma_rad == Approx(0.1 * interval.distance_sigma_m));
  }
  CHECK(actual / kSamples == Approx(1.0 / 120).epsilon(0.1));
  CHECK(told / actual == Approx(1).epsilon(0.1));
}

TEST_CASE("timeline: even motion leaves nothing unknown, and halves know as much as the whole") {
  std::vector<OdometrySample> odometry;
  for (int i = 0; i <= 20; ++i) odometry.push_back(sample(0.5 * i, 5 + 0.7 * i, 0.02 * i));
  for (const Interval& interval : build_timeline(odometry, {}, {.gap_s = 2}).intervals) {
    CHECK(interval.distance_sigma_m < 1e-12);
    CHECK(interval.turn_sigma_rad < 1e-12);
  }
  odometry[10].speed_mps += 1;
  const Timeline whole = build_timeline(odometry, {}, {.gap_s = 2});
  const Timeline split = build_timeline(odometry, std::vector<Fix>{fix_at(5.1)}, {.gap_s = 2});
  REQUIRE(split.intervals.size() == whole.intervals.size() + 1);
  CHECK(std::hypot(split.intervals[10].distance_sigma_m, split.intervals[11].distance_sigma_m) ==
        Approx(whole.intervals[10].distance_sigma_m));
  // Beside a gap nothing is told, and a single interval has no neighbour that could tell.
  odometry.erase(odometry.begin() + 11, odometry.begin() + 16);
  CHECK(build_timeline(odometry, {}, {.gap_s = 2}).intervals[10].distance_sigma_m == 0);
  CHECK(build_timeline(std::span(odometry).first(2), {}, {.gap_s = 2}).intervals[0].distance_sigma_m == 0);
}

TEST_CASE("timeline: an epoch nearer than a millisecond shares the odometry's node") {
  const std::vector<OdometrySample> odometry{sample(0, 1, 0), sample(0.1, 1, 0), sample(0.2, 1, 0)};
  const auto nodes = [&](std::vector<double> stamps) {
    std::vector<Fix> fixes;
    for (const double stamp : stamps) fixes.push_back(fix_at(stamp));
    return build_timeline(odometry, fixes, {});
  };
  CHECK(nodes({0.0995, 0.1005}).fix_node == std::vector<std::size_t>{1, 1});
  CHECK(nodes({0.0995, 0.1005}).stamps.size() == 3);
  CHECK(nodes({0.101}).stamps.size() == 4);         // exactly the limit: its own node
  CHECK(nodes({0.15, 0.15}).stamps.size() == 4);    // two receivers at one epoch
  CHECK(nodes({0.15, 0.1503}).stamps.size() == 4);  // and almost at one epoch
  CHECK(nodes({-0.0005, 0.2005}).fix_node == std::vector<std::size_t>{0, 2});
  TimelineOptions exact;
  exact.snap_s = 0;
  CHECK(build_timeline(odometry, std::vector<Fix>{fix_at(0.1), fix_at(0.1001)}, exact).stamps.size() == 4);
}

TEST_CASE("timeline: a gap is bridged with the mean twist, or refused") {
  std::vector<OdometrySample> odometry = constant_twist(10, 8, 0.2);
  odometry.erase(odometry.begin() + 40, odometry.begin() + 70);  // 3.9 s to 7.0 s
  const std::vector<Fix> fixes{fix_at(5)};
  const Timeline timeline = build_timeline(odometry, fixes, {});
  int bridged = 0;
  for (const Interval& interval : timeline.intervals) bridged += interval.bridged ? 1 : 0;
  CHECK(bridged == 2);  // both parts of the split gap
  const Timeline whole = build_timeline(constant_twist(10, 8, 0.2), {}, {});
  CHECK((end_pose(timeline) - end_pose(whole)).norm() < 1e-11);

  TimelineOptions strict;
  strict.gap_policy = GapPolicy::error;
  CHECK_THROWS_WITH(build_timeline(odometry, fixes, strict),
                    Catch::Contains("gap of 3.100 s") && Catch::Contains("3.900 s after its start"));
}

TEST_CASE("timeline: standstill is the identity whatever the gyro says, and reversing is not") {
  const Eigen::Vector3d start(3, -4, 1);
  const Timeline still = build_timeline(constant_twist(10, 0.04, 0.01), {}, {});
  CHECK(dead_reckon(still, start, 0.05).back() == start);
  CHECK(dead_reckon(still, start, 0.03).back() != start);

  const Timeline spins = build_timeline(constant_twist(10, 0, 0.3), {}, {});  // a robot on the spot
  CHECK((dead_reckon(spins, start, 0.05).back() - start - Eigen::Vector3d(0, 0, 3)).norm() < 1e-9);

  const Timeline back = build_timeline(constant_twist(10, -2, 0), {}, {});
  const Eigen::Vector3d end = dead_reckon(back, Eigen::Vector3d(0, 0, std::numbers::pi / 2), 0.05).back();
  CHECK(end[1] == Approx(-20));
  CHECK(std::abs(end[0]) < 1e-12);
}

TEST_CASE("timeline: dead reckoning does not wrap headings") {
  const Timeline timeline = build_timeline(constant_twist(10, 5, 1.5), {}, {});
  CHECK(end_pose(timeline)[2] == Approx(15));
}

TEST_CASE("timeline: speeds are multiplied by the grid scale of the nearest fix") {
  const std::vector<Fix> fixes{fix_at(2, 0.9996), fix_at(8, 1.0002)};
  const Timeline timeline = build_timeline(constant_twist(10, 10, 0), fixes, {});
  CHECK(timeline.intervals.front().speed_mps == Approx(9.996).epsilon(1e-12));
  CHECK(timeline.intervals.back().speed_mps == Approx(10.002).epsilon(1e-12));
  CHECK(end_pose(timeline)[0] == Approx(50 * 0.9996 + 50 * 1.0002).epsilon(1e-12));
}

TEST_CASE("timeline: the antenna at a fix turns with the body") {
  std::vector<Fix> fixes{fix_at(2.05), fix_at(5)};
  fixes[1].antenna_m = {2, 0.5};
  const Timeline timeline = build_timeline(constant_twist(10, 5, 0.3), fixes, {});
  const auto poses = dead_reckon(timeline, {1, 2, 3}, 0.05);
  const auto antennas = antenna_at_fixes(timeline, poses, fixes);
  REQUIRE(antennas.size() == 2);
  const Eigen::Vector3d body = poses[timeline.fix_node[1]];
  CHECK(antennas[1][0] == Approx(body[0] + 2 * std::cos(body[2]) - 0.5 * std::sin(body[2])));
  CHECK(antennas[1][1] == Approx(body[1] + 2 * std::sin(body[2]) + 0.5 * std::cos(body[2])));
  CHECK(antennas[1][2] == body[2]);
}

TEST_CASE("timeline: what cannot be placed in time is refused") {
  const std::vector<OdometrySample> odometry = constant_twist(10, 1, 0);
  CHECK_THROWS_AS(build_timeline(std::vector{odometry[0]}, {}, {}), InputError);
  CHECK_THROWS_AS(build_timeline(odometry, std::vector<Fix>{fix_at(-0.5)}, {}), InputError);
  CHECK_THROWS_AS(build_timeline(odometry, std::vector<Fix>{fix_at(10.5)}, {}), InputError);
  CHECK_THROWS_AS(build_timeline(odometry, std::vector<Fix>{fix_at(5), fix_at(4)}, {}), UsageError);
  CHECK_THROWS_AS(build_timeline(std::vector{odometry[1], odometry[1]}, {}, {}), UsageError);
}

}  // namespace timeline_test
