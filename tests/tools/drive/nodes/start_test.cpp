// The starts, on synthetic drives whose truth is known.
#include <algorithm>
#include <cmath>
#include <ctime>
#include <functional>
#include <numbers>
#include <random>

#include <catch2/catch.hpp>

#include <waymark/core/base/error.hpp>
#include <waymark/tools/drive/nodes/start.hpp>
#include <waymark/types_se2/se2.hpp>

namespace start_test {

namespace {

using namespace waymark;
using namespace waymark::drive;

constexpr double kDegree = std::numbers::pi / 180;
constexpr double kStandstill = 0.05;

/// Speed and yaw rate at a time.
using Motion = std::function<std::pair<double, double>(double)>;

struct Settings {
  double duration_s = 600;
  double rate_hz = 10;
  double gyro_bias_radps = 0;
  double fix_period_s = 1;
  double fix_sigma_m = 2;
  double first_heading_rad = 2.5;
  Eigen::Vector2d antenna_m{0, 0};
};

/// A drive with its truth: odometry = truth + bias, fixes = truth + noise.
struct SyntheticDrive {
  Timeline timeline;
  std::vector<Fix> fixes;
  std::vector<Eigen::Vector3d> truth;  ///< of the nodes, unwrapped

  [[nodiscard]] Start anchored() const { return anchored_start(timeline, fixes, kStandstill); }
};

SyntheticDrive simulate(const Motion& motion, const Settings& settings) {
  std::vector<OdometrySample> odometry;
  const auto samples = static_cast<int>(settings.duration_s * settings.rate_hz);
  for (int i = 0; i <= samples; ++i) {
    const double t = i / settings.rate_hz;
    const auto [speed, yaw_rate] = motion(t);
    odometry.push_back({.stamp = Stamp::from_seconds(t), .speed_mps = speed, .yaw_rate_radps = yaw_rate});
  }
  SyntheticDrive drive;
  for (int i = 0; i * settings.fix_period_s < settings.duration_s; ++i) {
    Fix fix;
    fix.stamp = Stamp::from_seconds(i * settings.fix_period_s);
    fix.antenna_m = settings.antenna_m;
    drive.fixes.push_back(fix);
  }
  drive.timeline = build_timeline(odometry, drive.fixes, {});
  drive.truth = dead_reckon(drive.timeline, {5000, -3000, settings.first_heading_rad}, kStandstill);
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal;
  for (std::size_t i = 0; i < drive.fixes.size(); ++i) {
    const Eigen::Vector3d& pose = drive.truth[drive.timeline.fix_node[i]];
    const Eigen::Vector2d noise(normal(random), normal(random));
    drive.fixes[i].position =
        pose.head<2>() + rotate(pose[2], settings.antenna_m) + settings.fix_sigma_m * noise;
  }
  for (Interval& interval : drive.timeline.intervals) interval.yaw_rate_radps += settings.gyro_bias_radps;
  return drive;
}

/// City driving: bends both ways, and with `stop` a halt of 40 s in every 200 s.
Motion city(bool stop) {
  return [stop](double t) -> std::pair<double, double> {
    if (stop && std::fmod(t, 200) > 160) return {0, 0};
    return {12 + 4 * std::sin(0.05 * t), 0.12 * std::sin(0.11 * t) + 0.02};
  };
}

double worst_heading_deg(const SyntheticDrive& drive, const Start& start) {
  double worst = 0;
  for (std::size_t i = 0; i < start.poses.size(); ++i)
    worst = std::max(worst, std::abs(wrap_angle(start.poses[i][2] - drive.truth[i][2])));
  return worst / kDegree;
}

double worst_position_m(const SyntheticDrive& drive, const Start& start) {
  double worst = 0;
  for (std::size_t i = 0; i < start.poses.size(); ++i)
    worst = std::max(worst, (start.poses[i] - drive.truth[i]).head<2>().norm());
  return worst;
}

/// The start's own winding between two nodes: headings followed from node to node, never by a large step.
double unwound_turn(const Start& start, std::size_t from, std::size_t to) {
  double turn = 0;
  for (std::size_t i = from; i < to; ++i) turn += wrap_angle(start.poses[i + 1][2] - start.poses[i][2]);
  return turn;
}

double winding_error_deg(const SyntheticDrive& drive, const Start& start) {
  double worst = 0;
  double turn = 0;
  for (std::size_t i = 0; i + 1 < start.poses.size(); ++i) {
    turn += wrap_angle(start.poses[i + 1][2] - start.poses[i][2]);
    worst = std::max(worst, std::abs(turn - (drive.truth[i + 1][2] - drive.truth[0][2])));
  }
  return worst / kDegree;
}

}  // namespace

TEST_CASE("start: a gyro bias of 0.35 deg/s over 40 minutes does not matter, with standstill or without") {
  for (const bool stop : {true, false}) {
    Settings settings;
    settings.duration_s = 2400;
    settings.gyro_bias_radps = 0.35 * kDegree;
    const SyntheticDrive drive = simulate(city(stop), settings);
    const Start start = drive.anchored();
    CHECK(start.gyro_bias_radps == Approx(0.35 * kDegree).margin(0.01 * kDegree));
    CHECK(worst_heading_deg(drive, start) < 10);
    CHECK(winding_error_deg(drive, start) < 15);
    CHECK(worst_position_m(drive, start) < 15);
    CHECK(start.note.empty());
  }
}

TEST_CASE("start: a bias that wanders while driving is followed piecewise") {
  Settings settings;
  settings.duration_s = 2400;
  SyntheticDrive drive = simulate(city(false), settings);
  for (std::size_t i = 0; i < drive.timeline.intervals.size(); ++i) {
    const double t = drive.timeline.stamps[i].seconds();
    drive.timeline.intervals[i].yaw_rate_radps += (0.1 + 0.3 * std::sin(t / 400)) * kDegree;
  }
  const Start start = drive.anchored();
  CHECK(worst_heading_deg(drive, start) < 15);
  CHECK(winding_error_deg(drive, start) < 20);
}

TEST_CASE("start: windings across a stop come from the odometry") {
  // Two full turns in a roundabout right before a stop of two minutes, no fix during all of it.
  const Motion motion = [](double t) -> std::pair<double, double> {
    if (t > 200 && t <= 240) return {6, 2 * 2 * std::numbers::pi / 40};
    if (t > 240 && t < 360) return {0, 0};
    return {14, 0.05 * std::sin(0.07 * t)};
  };
  Settings settings;
  settings.gyro_bias_radps = 0.1 * kDegree;
  SyntheticDrive drive = simulate(motion, settings);
  for (Fix& fix : drive.fixes)
    if (fix.stamp.seconds() > 195 && fix.stamp.seconds() < 370) fix.status = FixStatus::rejected;
  const Start start = drive.anchored();
  CHECK(winding_error_deg(drive, start) < 20);
  CHECK(unwound_turn(start, 0, start.poses.size() - 1) ==
        Approx(drive.truth.back()[2] - drive.truth.front()[2]).margin(0.2));
}

TEST_CASE("start: headings are wrapped to half a turn either way") {
  const SyntheticDrive drive = simulate([](double) { return std::pair(8.0, 0.2); }, {});
  for (const Start& start :
       {drive.anchored(), dead_reckoning_start(drive.timeline, drive.fixes, kStandstill)})
    for (const Eigen::Vector3d& pose : start.poses)
      REQUIRE((pose[2] > -std::numbers::pi && pose[2] <= std::numbers::pi));
}

TEST_CASE("start: reversing is not a turn") {
  const Motion motion = [](double t) -> std::pair<double, double> {
    return {std::fmod(t, 120) > 90 ? -3.0 : 10.0, 0.06 * std::sin(0.09 * t)};
  };
  const SyntheticDrive drive = simulate(motion, {});
  CHECK(worst_heading_deg(drive, drive.anchored()) < 15);
  const SyntheticDrive backwards = simulate([](double) { return std::pair(-3.0, 0.01); }, {});
  CHECK(worst_heading_deg(backwards, backwards.anchored()) < 15);
}

TEST_CASE("start: a parked beginning takes the heading of the first metres") {
  const Motion motion = [](double t) -> std::pair<double, double> {
    return t < 300 ? std::pair(0.0, 0.0) : std::pair(10.0, 0.08 * std::sin(0.1 * t));
  };
  Settings settings;
  settings.gyro_bias_radps = 0.35 * kDegree;
  const SyntheticDrive drive = simulate(motion, settings);
  const Start start = drive.anchored();
  CHECK(worst_heading_deg(drive, start) < 10);
  CHECK(start.poses[0][2] == Approx(start.poses[2000][2]).margin(1e-12));
}

TEST_CASE("start: wild fixes and lost fixes do not turn the start") {
  SyntheticDrive drive = simulate(city(true), {});
  for (std::size_t i = 0; i < drive.fixes.size(); ++i) {
    if (i % 7 == 3) drive.fixes[i].position += Eigen::Vector2d(150, -110);  // 186 m
    if (i >= 300 && i < 312) drive.fixes[i].position += Eigen::Vector2d(-90, 160);
    if (i % 10 < 5) drive.fixes[i].status = FixStatus::rejected;
  }
  const Start start = drive.anchored();
  CHECK(worst_heading_deg(drive, start) < 20);
  CHECK(winding_error_deg(drive, start) < 25);
}

TEST_CASE("start: a straight drive with coarse fixes") {
  SyntheticDrive drive = simulate([](double) { return std::pair(20.0, 0.0); }, {});
  for (Fix& fix : drive.fixes) fix.position = 11 * (fix.position / 11).array().round();
  CHECK(worst_heading_deg(drive, drive.anchored()) < 5);
}

TEST_CASE("start: rare fixes get longer windows") {
  Settings settings;
  settings.fix_period_s = 45;
  settings.duration_s = 1800;
  settings.gyro_bias_radps = 0.05 * kDegree;
  const SyntheticDrive drive = simulate(city(false), settings);
  const Start start = drive.anchored();
  CHECK(start.windows > 3);
  CHECK(worst_heading_deg(drive, start) < 15);
}

TEST_CASE("start: the antenna's lever arm is taken off") {
  Settings settings;
  settings.antenna_m = {30, 5};  // absurd, so that it shows
  settings.fix_sigma_m = 0.1;
  const SyntheticDrive drive = simulate(city(false), settings);
  CHECK(worst_position_m(drive, drive.anchored()) < 3);
  const Start start = dead_reckoning_start(drive.timeline, drive.fixes, kStandstill);
  CHECK((start.poses[0] - drive.truth[0]).head<2>().norm() < 3);
}

TEST_CASE("start: two fixes are enough for a start, one is said to be a guess") {
  SyntheticDrive drive = simulate([](double) { return std::pair(10.0, 0.01); }, {});
  for (std::size_t i = 0; i < drive.fixes.size(); ++i)
    if (i != 100 && i != 160) drive.fixes[i].status = FixStatus::rejected;
  const Start two = drive.anchored();
  CHECK(two.windows == 0);
  CHECK_THAT(two.note, Catch::Contains("one alignment of the whole drive"));
  CHECK(worst_heading_deg(drive, two) < 5);

  drive.fixes[160].status = FixStatus::rejected;
  const Start one = drive.anchored();
  CHECK_THAT(one.note, Catch::Contains("do not determine the heading"));
  drive.fixes[100].heading_rad = drive.truth[drive.timeline.fix_node[100]][2];
  const Start course = drive.anchored();
  CHECK_THAT(course.note, Catch::Contains("course"));
  CHECK(worst_heading_deg(drive, course) < 5);
}

TEST_CASE("start: a drive that never moves starts at its fixes and says so") {
  const SyntheticDrive drive = simulate([](double) { return std::pair(0.0, 0.0); }, {});
  const Start start = drive.anchored();
  CHECK_THAT(start.note, Catch::Contains("do not determine the heading"));
  CHECK(worst_position_m(drive, start) < 1);
  CHECK_FALSE(dead_reckoning_start(drive.timeline, drive.fixes, kStandstill).note.empty());
}

TEST_CASE("start: the paper's start lies on the first accepted fix along its first long chord") {
  Settings settings;
  settings.fix_sigma_m = 0;
  SyntheticDrive drive = simulate(city(true), settings);
  drive.fixes[0].status = FixStatus::rejected;
  drive.fixes[0].position += Eigen::Vector2d(500, 0);
  const Start start = dead_reckoning_start(drive.timeline, drive.fixes, kStandstill);
  CHECK(worst_heading_deg(drive, start) < 1e-6);
  CHECK(worst_position_m(drive, start) < 1e-6);
  CHECK(start.note.empty());

  drive.fixes[1].heading_rad = drive.truth[drive.timeline.fix_node[1]][2] + 0.5;
  const Start course = dead_reckoning_start(drive.timeline, drive.fixes, kStandstill);
  CHECK(worst_heading_deg(drive, course) == Approx(0.5 / kDegree));
  CHECK(make_start(drive.timeline, drive.fixes, kStandstill, {StartMethod::dead_reckoning}).poses ==
        course.poses);
}

TEST_CASE("start: headings follow the fixes where the gyro is dead") {
  // laps of two straight ways and two half circles, with every yaw rate lost
  const Motion laps = [](double t) -> std::pair<double, double> {
    const double phase = std::fmod(t, 28);
    return {10, phase < 7 || (phase >= 14 && phase < 21) ? 0 : std::numbers::pi / 7};
  };
  SyntheticDrive drive = simulate(laps, {.duration_s = 400, .fix_sigma_m = 0.5});
  for (Interval& interval : drive.timeline.intervals) interval.yaw_rate_radps = 0;
  const auto misses_rad = [&](const Start& start) {
    std::vector<double> misses;
    for (std::size_t i = 0; i < drive.truth.size(); ++i)
      misses.push_back(std::abs(wrap_angle(start.poses[i][2] - drive.truth[i][2])));
    std::nth_element(misses.begin(), misses.begin() + std::ssize(misses) * 9 / 10, misses.end());
    return misses[static_cast<std::size_t>(std::ssize(misses) * 9 / 10)];
  };
  CHECK(misses_rad(start_along_fixes(drive.timeline, drive.fixes, kStandstill)) < 0.5);
  CHECK(misses_rad(drive.anchored()) > 1);
}

TEST_CASE("start: without an accepted fix there is no start") {
  SyntheticDrive drive = simulate(city(true), {});
  for (Fix& fix : drive.fixes) fix.status = FixStatus::rejected;
  CHECK_THROWS_AS(drive.anchored(), InputError);
  CHECK_THROWS_AS(dead_reckoning_start(drive.timeline, drive.fixes, kStandstill), InputError);
  drive.fixes.pop_back();
  CHECK_THROWS_AS(drive.anchored(), UsageError);
}

TEST_CASE("start: the start is deterministic and quick on an hour at 25 Hz") {
  Settings settings;
  settings.duration_s = 4200;
  settings.rate_hz = 25;
  settings.gyro_bias_radps = 0.2 * kDegree;
  const SyntheticDrive drive = simulate(city(true), settings);
  REQUIRE(drive.truth.size() == 105001);
  const std::clock_t before = std::clock();
  const Start start = drive.anchored();
  const double cpu_s = static_cast<double>(std::clock() - before) / CLOCKS_PER_SEC;
  CHECK(start.poses == drive.anchored().poses);
  INFO(cpu_s << " s");
#ifdef NDEBUG
  CHECK(cpu_s < 1);  // takes some 30 ms; debug and sanitizer builds prove nothing about speed
#endif
}

}  // namespace start_test
