// Odometry that stops measuring while the vehicle drives on: its time is found, and the motion of the fixes stands in.
#include <cmath>
#include <functional>
#include <numbers>

#include <catch2/catch.hpp>

#include <waymark/tools/drive/mending/fix_motion.hpp>
#include <waymark/tools/drive/mending/frozen.hpp>
#include <waymark/tools/drive/nodes/timeline.hpp>

#include "winding_scene.hpp"

namespace frozen_test {

namespace {

using namespace waymark;
using namespace waymark::drive;

using Scene = testing::WindingScene;

double speed_at(double t) {
  return 10 + 2 * std::sin(0.3 * t);
}

double yaw_rate_at(double t) {
  return 0.1 * std::sin(0.2 * t);
}

/// 100 s of a winding way, without a stop.
Scene scene() {
  return testing::winding_scene(100, speed_at, yaw_rate_at);
}

/// The odometry repeats readings from 30 to 60 s.
Scene frozen_at(double speed, double yaw_rate) {
  Scene result = scene();
  for (std::size_t i = 300; i <= 600; ++i) {
    result.odometry[i].speed_mps = speed;
    result.odometry[i].yaw_rate_radps = yaw_rate;
  }
  return result;
}

/// The vehicle stands from 30 to 60 s, and its fixes show `position`.
Scene standing(const std::function<Eigen::Vector2d(int second)>& position) {
  Scene result = frozen_at(0, 0);
  const Eigen::Vector2d place = result.fixes[30].position;
  const Eigen::Vector2d driven = result.fixes[60].position - place;
  for (int second = 30; second <= 100; ++second) {
    Fix& fix = result.fixes[static_cast<std::size_t>(second)];
    fix.position =
        second <= 60 ? Eigen::Vector2d(place + position(second)) : Eigen::Vector2d(fix.position - driven);
  }
  return result;
}

double distance_of(const Scene& scene) {
  double distance = 0;
  for (const Interval& interval : build_timeline(scene.odometry, {}, {}).intervals)
    distance += interval.speed_mps * interval.dt_s;
  return distance;
}

}  // namespace

TEST_CASE("frozen: odometry that reads 0 while the fixes move is found with its time") {
  const Scene scene = frozen_at(0, 0);
  const std::vector<FrozenOdometry> found = find_frozen_odometry(scene.odometry, scene.fixes);
  REQUIRE(found.size() == 1);
  CHECK(found[0].from.seconds() == Approx(30).margin(0.11));
  CHECK(found[0].to.seconds() == Approx(60).margin(0.11));
  CHECK(found[0].with_turns);
  // the integral of the speed from 30 s to 60 s
  const double driven = 10 * 30 - 2 / 0.3 * (std::cos(18.0) - std::cos(9.0));
  CHECK(found[0].distance_m == Approx(driven).epsilon(0.05));
  CHECK_THAT(warning_of(found[0], Stamp::from_seconds(10)),
             Catch::Contains("repeats 0 m/s and its yaw rate from 20.0 s to 50.0 s after its start"));
}

TEST_CASE("frozen: the motion of the fixes stands in, and its intervals are bridged") {
  const double true_distance = distance_of(scene());
  Scene scene = frozen_at(0, 0);
  CHECK(distance_of(scene) < true_distance - 250);
  assume_motion_of_fixes(find_frozen_odometry(scene.odometry, scene.fixes), scene.fixes, scene.odometry);
  CHECK(distance_of(scene) == Approx(true_distance).epsilon(0.01));
  double turned = 0;
  for (std::size_t i = 300; i < 600; ++i) turned += 0.1 * scene.odometry[i].yaw_rate_radps;
  // the integral of the yaw rate from 30 s to 60 s
  CHECK(turned == Approx(-0.5 * (std::cos(12.0) - std::cos(6.0))).margin(0.05));
  const Timeline timeline = build_timeline(scene.odometry, {}, {});
  CHECK(timeline.intervals[450].bridged);
  CHECK_FALSE(timeline.intervals[100].bridged);
}

TEST_CASE("frozen: a yaw rate that is alive is kept") {
  Scene scene = frozen_at(0, 0);
  for (std::size_t i = 300; i <= 600; ++i)
    scene.odometry[i].yaw_rate_radps = yaw_rate_at(0.1 * static_cast<double>(i));
  const std::vector<FrozenOdometry> found = find_frozen_odometry(scene.odometry, scene.fixes);
  REQUIRE(found.size() == 1);
  CHECK_FALSE(found[0].with_turns);
  assume_motion_of_fixes(found, scene.fixes, scene.odometry);
  CHECK(scene.odometry[450].yaw_rate_radps == yaw_rate_at(45));
  CHECK(scene.odometry[450].speed_mps == Approx(speed_at(45)).margin(0.5));
}

TEST_CASE(
    "frozen: a speed that reads noise about 0 while the fixes move is found too, and a noisy stop is none") {
  const auto noise = [](std::size_t i) { return std::abs(0.1 * std::sin(2.3 * static_cast<double>(i))); };
  Scene failing = frozen_at(0, 0);
  for (std::size_t i = 300; i <= 600; ++i) {
    failing.odometry[i].speed_mps = noise(i);
    failing.odometry[i].yaw_rate_radps = yaw_rate_at(0.1 * static_cast<double>(i));
  }
  const std::vector<FrozenOdometry> found = find_frozen_odometry(failing.odometry, failing.fixes);
  REQUIRE(found.size() == 1);
  CHECK(found[0].from.seconds() == Approx(30).margin(2.1));
  CHECK(found[0].to.seconds() == Approx(60).margin(2.1));
  CHECK(found[0].at_rest);
  CHECK_THAT(warning_of(found[0], Stamp::from_seconds(10)),
             Catch::Contains("reads speeds below 0.5 m/s from "));

  Scene stop = standing([](int second) { return Eigen::Vector2d(std::sin(second), 0.2 * (second - 30)); });
  for (std::size_t i = 300; i <= 600; ++i) stop.odometry[i].speed_mps = noise(i);
  CHECK(find_frozen_odometry(stop.odometry, stop.fixes).empty());
}

TEST_CASE("frozen: while a gyro is alive, fixes that go away from a stop and half back prove nothing") {
  const auto bow = [](int second) {
    return Eigen::Vector2d(0, 300 * std::sin(0.85 * std::numbers::pi * (second - 30) / 30.0));
  };
  Scene scene = standing(bow);
  for (std::size_t i = 300; i <= 600; ++i)
    scene.odometry[i].yaw_rate_radps = 1e-3 * std::sin(2.7 * static_cast<double>(i));
  CHECK(find_frozen_odometry(scene.odometry, scene.fixes).empty());
  // A vehicle that turns has been where the fixes are.
  for (std::size_t i = 400; i <= 450; ++i) scene.odometry[i].yaw_rate_radps = 0.4;
  CHECK_FALSE(find_frozen_odometry(scene.odometry, scene.fixes).empty());
  // One that does not come back has gone.
  scene = frozen_at(0, 0);
  for (std::size_t i = 300; i <= 600; ++i)
    scene.odometry[i].yaw_rate_radps = yaw_rate_at(0.1 * static_cast<double>(i));
  CHECK(find_frozen_odometry(scene.odometry, scene.fixes).size() == 1);
}

TEST_CASE("frozen: fixes that wander away from a stop, and are back once the vehicle drives, prove nothing") {
  Scene scene = standing([](int second) { return Eigen::Vector2d(1.5 * (second - 30), 0); });
  for (std::size_t i = 300; i <= 600; ++i)
    scene.odometry[i].yaw_rate_radps = 1e-3 * std::sin(2.7 * static_cast<double>(i));
  CHECK(find_frozen_odometry(scene.odometry, scene.fixes).empty());
  // Fixes that go on from where they went to: the vehicle was there.
  for (std::size_t second = 61; second <= 100; ++second) scene.fixes[second].position.x() += 45;
  CHECK(find_frozen_odometry(scene.odometry, scene.fixes).size() == 1);
}

TEST_CASE("frozen: a moving vehicle does not repeat its readings, even if the fixes fit") {
  const Scene scene = frozen_at(10, 0.01);
  const std::vector<FrozenOdometry> found = find_frozen_odometry(scene.odometry, scene.fixes);
  REQUIRE(found.size() == 1);
  CHECK(found[0].speed_mps == 10);
  CHECK(found[0].from.seconds() == Approx(30));
}

TEST_CASE(
    "frozen: one speed and one turn that good fixes have in all are true, and one of two that they have is not") {
  const auto is_steady = [](double t) { return t >= 29.95 && t < 60; };
  const auto steady = [&](double turn) {
    Scene result = testing::winding_scene(
        100, [&](double t) { return is_steady(t) ? 10 : speed_at(t); },
        [&](double t) { return is_steady(t) ? turn : yaw_rate_at(t); });
    for (Fix& fix : result.fixes) fix.covariance = 4e-4 * Eigen::Matrix2d::Identity();
    return result;
  };
  for (const double turn : {0.0, 0.02, -0.2}) {
    Scene good = steady(turn);
    CHECK(find_frozen_odometry(good.odometry, good.fixes).empty());
    // Poor fixes cannot tell.
    Scene poor = good;
    for (Fix& fix : poor.fixes) fix.covariance = 9 * Eigen::Matrix2d::Identity();
    CHECK(find_frozen_odometry(poor.odometry, poor.fixes).size() == 1);
    // The vehicle bends otherwise, by 0.4 rad in 20 s.
    for (OdometrySample& sample : good.odometry)
      if (is_steady(sample.stamp.seconds())) sample.yaw_rate_radps = turn + 0.02;
    CHECK(find_frozen_odometry(good.odometry, good.fixes).size() == 1);
  }
}

TEST_CASE("frozen: wheels that turn alike for a minute are true, unless the fixes bend") {
  // A robot on straight lanes, with fixes of 0.9 m; its yaw rate is 0 at rest, as one from wheels is.
  const auto is_lane = [](double t) { return t > 39.95 && t < 100.05; };
  const auto speed = [&](double t) { return t < 10 ? 0 : is_lane(t) ? 1 : 1 + 0.2 * std::sin(t); };
  const auto turn = [&](double t) { return t < 10 || is_lane(t) ? 0 : 0.1 * std::sin(0.2 * t); };
  Scene robot = testing::winding_scene(200, speed, turn);
  for (Fix& fix : robot.fixes) fix.covariance = 0.81 * Eigen::Matrix2d::Identity();
  CHECK(find_frozen_odometry(robot.odometry, robot.fixes).empty());
  // The log repeats a reading where the vehicle drives half a circle.
  Scene bent = testing::winding_scene(
      200, speed, [&](double t) { return t > 50 && t < 70 ? std::numbers::pi / 20 : turn(t); });
  for (OdometrySample& sample : bent.odometry)
    if (is_lane(sample.stamp.seconds())) sample.yaw_rate_radps = 0;
  for (Fix& fix : bent.fixes) fix.covariance = 0.81 * Eigen::Matrix2d::Identity();
  CHECK(find_frozen_odometry(bent.odometry, bent.fixes).size() == 1);
}

TEST_CASE("frozen: a speed or a yaw rate that repeats itself while the other one is alive is found") {
  Scene speed = scene();
  Scene turns = scene();
  for (std::size_t i = 300; i <= 400; ++i) {
    speed.odometry[i].speed_mps = speed_at(30);
    turns.odometry[i].yaw_rate_radps = 0.05;
  }
  const std::vector<FrozenOdometry> of_speed = find_frozen_odometry(speed.odometry, speed.fixes);
  REQUIRE(of_speed.size() == 1);
  CHECK(of_speed[0].with_speed);
  CHECK_FALSE(of_speed[0].with_turns);
  const std::vector<FrozenOdometry> of_turns = find_frozen_odometry(turns.odometry, turns.fixes);
  REQUIRE(of_turns.size() == 1);
  CHECK_FALSE(of_turns[0].with_speed);
  CHECK(of_turns[0].with_turns);
  assume_motion_of_fixes(of_turns, turns.fixes, turns.odometry);
  CHECK(turns.odometry[350].speed_mps == speed_at(35));
  CHECK(turns.odometry[350].yaw_rate_radps == Approx(yaw_rate_at(35)).margin(0.03));
  CHECK_THAT(warning_of(of_turns[0], {}),
             Catch::Contains("repeats a yaw rate of 0.05 rad/s from 30.0 s to 40.0 s"));
}

TEST_CASE("frozen: a quantity that now and then repeats is not frozen until it repeats unusually long") {
  Scene coarse = scene();
  for (OdometrySample& sample : coarse.odometry)
    sample.speed_mps = std::round(sample.speed_mps / 0.02) * 0.02;
  CHECK(find_frozen_odometry(coarse.odometry, coarse.fixes).empty());
  for (std::size_t i = 300; i <= 400; ++i) coarse.odometry[i].speed_mps = coarse.odometry[300].speed_mps;
  CHECK(find_frozen_odometry(coarse.odometry, coarse.fixes).size() == 1);
}

TEST_CASE("frozen: a constant speed that the fixes have is cruise control") {
  const auto cruises = [](double t) { return t > 30 && t < 60 ? speed_at(30) : speed_at(t); };
  const Scene cruise = testing::winding_scene(100, cruises, yaw_rate_at);
  CHECK(find_frozen_odometry(cruise.odometry, cruise.fixes).empty());
}

TEST_CASE(
    "frozen: a constant speed in a roundabout is cruise control, though chords are shorter than its way") {
  const auto is_round = [](double t) { return t > 30 && t < 60; };
  const Scene round = testing::winding_scene(
      100, [&](double t) { return is_round(t) ? 5.56 : speed_at(t); },
      [&](double t) { return is_round(t) ? 0.3 + 0.01 * std::sin(t) : yaw_rate_at(t); });
  CHECK(find_frozen_odometry(round.odometry, round.fixes).empty());
}

TEST_CASE("frozen: a speed alone that repeats itself while there are no fixes is not doubted") {
  Scene tunnel = scene();
  for (std::size_t i = 300; i <= 400; ++i) tunnel.odometry[i].speed_mps = speed_at(30);
  REQUIRE(find_frozen_odometry(tunnel.odometry, tunnel.fixes).size() == 1);
  std::erase_if(tunnel.fixes,
                [](const Fix& fix) { return fix.stamp.seconds() > 29 && fix.stamp.seconds() < 41; });
  CHECK(find_frozen_odometry(tunnel.odometry, tunnel.fixes).empty());
  // A yaw rate that repeats itself as well is no cruise control, unless it never changes at all.
  for (std::size_t i = 300; i <= 400; ++i) tunnel.odometry[i].yaw_rate_radps = 0.05;
  CHECK(find_frozen_odometry(tunnel.odometry, tunnel.fixes).size() == 1);
  for (OdometrySample& sample : tunnel.odometry) sample.yaw_rate_radps = 0;
  CHECK(find_frozen_odometry(tunnel.odometry, tunnel.fixes).empty());
}

TEST_CASE("frozen: odometry of few digits repeats readings without a failure") {
  Scene scene;
  for (int i = 0; i <= 1000; ++i) {
    scene.odometry.push_back({.stamp = Stamp::from_seconds(0.1 * i), .speed_mps = i / 200 + 1.0});
    if (i % 10 != 0) continue;
    Fix fix;
    fix.stamp = Stamp::from_seconds(0.1 * i);
    fix.position.x() = 0.1 * i * (1 + i / 400.0);
    scene.fixes.push_back(fix);
  }
  for (std::size_t i = 0; i + 1 < scene.odometry.size(); i += 2) scene.odometry[i].yaw_rate_radps = 0;
  CHECK(find_frozen_odometry(scene.odometry, scene.fixes).empty());
}

TEST_CASE("frozen: a vehicle that stands is not doubted, whatever its fixes do") {
  const Scene still = standing([](int) { return Eigen::Vector2d(0, 0); });
  CHECK(find_frozen_odometry(still.odometry, still.fixes).empty());
  // multipath of 12 m to alternating sides
  const Scene wild =
      standing([](int s) { return Eigen::Vector2d(12 * std::cos(2.1 * s), 12 * std::sin(1.3 * s)); });
  CHECK(find_frozen_odometry(wild.odometry, wild.fixes).empty());
  // one jump of 60 m
  const Scene jump = standing([](int s) { return Eigen::Vector2d(s > 40 ? 60 : 0, 0); });
  CHECK(find_frozen_odometry(jump.odometry, jump.fixes).empty());
  // a slow drift of 0.8 m/s
  const Scene drift = standing([](int s) { return Eigen::Vector2d(0.8 * (s - 30), 0); });
  CHECK(find_frozen_odometry(drift.odometry, drift.fixes).empty());
}

TEST_CASE("frozen: a receiver that measures a standstill is believed") {
  Scene scene = frozen_at(0, 0);
  for (Fix& fix : scene.fixes) fix.speed_mps = 0.1;
  CHECK(find_frozen_odometry(scene.odometry, scene.fixes).empty());
}

TEST_CASE("frozen: withheld fixes take no part") {
  Scene scene = frozen_at(0, 0);
  for (std::size_t i = 25; i <= 65; ++i) scene.fixes[i].status = FixStatus::withheld;
  CHECK(find_frozen_odometry(scene.odometry, scene.fixes).empty());
}

TEST_CASE("frozen: a gap that fixes cover is filled with their motion, others and short ones stay") {
  const auto with_gap = [](double from, double to) {
    Scene made = scene();
    std::erase_if(made.odometry, [&](const OdometrySample& sample) {
      return sample.stamp.seconds() > from + 0.05 && sample.stamp.seconds() < to - 0.05;
    });
    return made;
  };
  const double true_distance = distance_of(scene());
  Scene covered = with_gap(30, 60);
  CHECK(fill_gaps(covered.odometry, covered.fixes, 0.5) == 1);
  CHECK(distance_of(covered) == Approx(true_distance).epsilon(0.01));
  CHECK(build_timeline(covered.odometry, {}, {}).intervals[310].bridged);

  Scene marked = with_gap(30, 60);  // -1 of a receiver that does not know its speed
  for (Fix& fix : marked.fixes) fix.speed_mps = -1;
  CHECK(fill_gaps(marked.odometry, marked.fixes, 0.5) == 1);
  CHECK(distance_of(marked) == Approx(true_distance).epsilon(0.01));

  Scene tunnel = with_gap(30, 60);
  std::erase_if(tunnel.fixes,
                [](const Fix& fix) { return fix.stamp.seconds() > 40 && fix.stamp.seconds() < 46; });
  CHECK(fill_gaps(tunnel.odometry, tunnel.fixes, 0.5) == 0);
  Scene brief = with_gap(30, 31.5);
  CHECK(fill_gaps(brief.odometry, brief.fixes, 0.5) == 0);
  Scene slow = with_gap(30, 33);
  CHECK(fill_gaps(slow.odometry, slow.fixes, 4) == 0);
}

}  // namespace frozen_test
