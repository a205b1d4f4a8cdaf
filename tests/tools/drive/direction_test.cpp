// Turns from headings and courses: values follow from how the readings were made.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>

#include <waymark/tools/drive/logs/parts/direction.hpp>
#include <waymark/tools/drive/nodes/timeline.hpp>
#include <waymark/types_se2/se2.hpp>

namespace direction_test {

using namespace waymark;
using namespace waymark::drive;
using std::numbers::pi;

namespace {

TimeSeries series(double rate, double length_s, const std::function<double(double)>& value) {
  TimeSeries result;
  for (int i = 0; i <= std::lround(length_s * rate); ++i) {
    result.stamps.push_back(Stamp::from_seconds(i / rate));
    result.values.push_back(value(i / rate));
  }
  return result;
}

/// Drives at 8 m/s, brakes to a rest from 20 s to 30 s at 2 m/s^2, and drives on.
double speed_at(double t) {
  if (t < 16 || t > 34) return 8;
  if (t < 20) return 2 * (20 - t);
  return t < 30 ? 0 : 2 * (t - 30);
}

double turn_between(const TimeSeries& angle, double from, double to) {
  return mean_slope(angle, Stamp::from_seconds(from), Stamp::from_seconds(to)) * (to - from);
}

}  // namespace

TEST_CASE(
    "direction: a heading that leaps at rest in both senses is a course, one that turns on the spot is none") {
  constexpr double kLength = 250;  // five stops
  std::mt19937 random(1);
  std::uniform_real_distribution<double> any(-pi, pi);
  const auto speed_in = [](double t) { return speed_at(std::fmod(t, 50)); };
  const TimeSeries speed = series(10, kLength, speed_in);
  const auto of_receiver =
      series(1, kLength, [&](double t) { return speed_in(t) < 0.05 ? any(random) : 0.3; });
  const auto leaps = leaps_at_rest(of_receiver, speed, 0.5);
  REQUIRE(leaps);
  CHECK(leaps->leaps > 20);
  CHECK(leaps->largest_rad <= pi);
  const auto of_zeros = series(1, kLength, [&](double t) { return speed_in(t) < 0.05 ? 0 : 2.0; });
  CHECK(leaps_at_rest(of_zeros, speed, 0.5)->largest_rad == Approx(2));
  // It turns by 10 rad at a stop, and back at the next one.
  const auto of_robot = series(1, kLength, [](double t) {
    const double turned = std::clamp(std::fmod(t, 50) - 20, 0.0, 10.0);
    return wrap_angle(std::fmod(t, 100) < 50 ? turned : 10 - turned);
  });
  CHECK_FALSE(leaps_at_rest(of_robot, speed, 0.5));
  const auto of_compass = series(1, kLength, [&](double) { return 0.3 + 0.1 * any(random); });
  CHECK_FALSE(leaps_at_rest(of_compass, speed, 0.5));
}

TEST_CASE("direction: the turn over a stop belongs to the way, none to the rest, and the rest is no gap") {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> any(-pi, pi);
  const TimeSeries speed = series(10, 50, speed_at);
  const auto course = series(1, 50, [&](double t) {
    return speed_at(t) < 1 ? any(random) : t < 25 ? 0.2 : 0.9;
  });
  const Direction direction = turns_of_course(course, speed, 0.5);
  CHECK(turn_between(direction.angle, 10, 40) == Approx(0.7));
  CHECK(turn_between(direction.angle, 20, 30) == Approx(0).margin(1e-9));
  for (std::size_t i = 1; i < direction.angle.stamps.size(); ++i)
    CHECK(seconds_between(direction.angle.stamps[i - 1], direction.angle.stamps[i]) < 1.01);
  // From 18 m of creeping at 1.8 m/s nothing is concluded.
  const TimeSeries creeping = series(10, 50, [](double t) { return t > 20 && t < 30 ? 1.8 : 8.0; });
  const Direction silent = turns_of_course(course, creeping, 0.5);
  CHECK_FALSE(value_at(silent.angle, Stamp::from_seconds(25), 2.5));
}

TEST_CASE("direction: a drive that begins and ends at rest has its heading there") {
  const TimeSeries speed = series(10, 50, [](double t) { return t < 10 || t > 40 ? 0 : 8.0; });
  const auto course = series(1, 50, [](double t) { return t < 10 || t > 40 ? 0 : 0.4; });
  const Direction direction = turns_of_course(course, speed, 0.5);
  CHECK(direction.angle.stamps.front() <= Stamp::from_seconds(1));
  CHECK(direction.angle.stamps.back() >= Stamp::from_seconds(49));
  CHECK(turn_between(direction.angle, 0, 50) == Approx(0).margin(1e-12));
}

TEST_CASE("direction: the course of a vehicle that reverses is its heading turned round") {
  const TimeSeries speed = series(10, 20, [](double) { return -5.0; });
  const Direction direction = turns_of_course(series(1, 20, [](double) { return 0.5; }), speed, 0.5);
  CHECK(std::abs(wrap_angle(direction.angle.values.front() - 0.5)) == Approx(pi));
}

TEST_CASE(
    "direction: turns err by the noise of the readings, in a course by that of the velocity over the speed") {
  constexpr double kSigma = 0.02;
  std::mt19937 random(3);
  std::normal_distribution<double> noise(0, 1);
  const auto heading = series(5, 2000, [&](double t) { return 0.01 * t + kSigma * noise(random); });
  // kSigma^2 in each interval of 0.2 s. The median of 10,000 differences is known to 2 %, its square to 4 %; the
  // line between readings that bend by noise adds 5 %.
  const double expected = kSigma * kSigma / 0.2;
  double mean = 0;
  const Direction turns = turns_of_heading(heading);
  for (const double value : turns.turn_variance_per_s.values) mean += value / 10'001;
  CHECK(mean == Approx(1.05 * expected).epsilon(0.06));

  const auto speed_of = [](double t) { return t < 1000 ? 5.0 : 20.0; };
  const TimeSeries speed = series(5, 2000, speed_of);
  const auto course = series(5, 2000, [&](double t) { return 0.2 / speed_of(t) * noise(random); });
  const Direction motion = turns_of_course(course, speed, 0.5);
  double slow = 0;
  double fast = 0;
  for (std::size_t i = 0; i < motion.turn_variance_per_s.values.size(); ++i)
    (i < 5000 ? slow : fast) += motion.turn_variance_per_s.values[i] / 5000;
  CHECK(slow / fast == Approx(16).epsilon(0.1));
}

TEST_CASE("direction: the error of a reading is in the interval after it") {
  const OdometrySample left{.stamp = {0}, .speed_mps = 5, .turn_variance_per_s = 1e-3};
  const OdometrySample right{.stamp = Stamp::from_seconds(0.2), .speed_mps = 5, .turn_variance_per_s = 3e-3};
  CHECK(motion_between(left, right, 1, 0.5).turn_sigma_rad == Approx(std::sqrt(2e-3 * 0.2)));
}

}  // namespace direction_test
