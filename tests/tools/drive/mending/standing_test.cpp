// A vehicle that stands while its speed reads noise that adds up to a way.
#include <catch2/catch.hpp>

#include <cmath>
#include <functional>
#include <random>

#include <waymark/tools/drive/mending/standing.hpp>

namespace standing_test {

using namespace waymark;
using namespace waymark::drive;

namespace {

/// 60 s of speeds at a rate.
std::vector<OdometrySample> speeds(double rate_hz, const std::function<double(double)>& speed) {
  std::vector<OdometrySample> odometry;
  for (int i = 0; i < static_cast<int>(60 * rate_hz); ++i)
    odometry.push_back({.stamp = Stamp::from_seconds(i / rate_hz), .speed_mps = speed(i / rate_hz)});
  return odometry;
}

/// Fixes of 1 Hz along the x axis, exact.
std::vector<Fix> fixes_at(const std::function<double(double)>& place) {
  std::vector<Fix> fixes;
  for (int i = 0; i < 60; ++i) {
    Fix fix;
    fix.stamp = Stamp::from_seconds(i);
    fix.position.x() = place(i);
    fix.covariance *= 0.04;
    fixes.push_back(fix);
  }
  return fixes;
}

/// Noise of 0.1 m/s about a speed.
class Noisy {
 public:
  double operator()(double speed) { return std::abs(speed + normal_(random_)); }

 private:
  std::mt19937_64 random_{3};
  std::normal_distribution<double> normal_{0, 0.1};
};

}  // namespace

TEST_CASE("standing: noise without a sign between two ways is a stop") {
  for (const double rate_hz : {5.0, 10.0, 50.0}) {
    Noisy noisy;
    const auto odometry = speeds(rate_hz, [&](double t) { return noisy(t < 20 || t > 40 ? 5 : 0); });
    const auto fixes = fixes_at([](double t) { return 5 * (t < 20 ? t : std::max(20.0, t - 20)); });
    const std::vector<Standing> found = find_standing(odometry, fixes);
    REQUIRE(found.size() == 1);
    CHECK(odometry[found[0].first].stamp.seconds() == Approx(20).margin(0.25));
    CHECK(odometry[found[0].last].stamp.seconds() == Approx(40).margin(0.25));
  }
}

TEST_CASE("standing: a few readings below 0 give noise no sign") {
  Noisy noisy;
  int reading = 0;
  const auto odometry = speeds(10, [&](double t) {
    if (t < 20 || t > 40) return noisy(5);
    return ++reading % 20 == 0 ? -0.03 : noisy(0);
  });
  const auto fixes = fixes_at([](double t) { return 5 * (t < 20 ? t : std::max(20.0, t - 20)); });
  CHECK(find_standing(odometry, fixes).size() == 1);
}

TEST_CASE("standing: a vehicle that creeps does not stand") {
  const auto at_rest = fixes_at([](double) { return 0; });
  Noisy noisy;
  CHECK(find_standing(speeds(25, [&](double) { return noisy(0.4); }), at_rest).empty());
  // stop and go: up to 0.4 m/s every 4 s
  CHECK(find_standing(speeds(10, [](double t) { return 0.2 - 0.2 * std::cos(1.57 * t); }), at_rest).empty());
  CHECK(find_standing(speeds(25, [](double) { return 0.0; }), at_rest).empty());
}

TEST_CASE("standing: where readings of a traffic jam look like noise, the fixes decide") {
  for (const double speed : {0.1, 0.15, 0.2}) {
    Noisy noisy;
    const auto odometry = speeds(25, [&](double) { return noisy(speed); });
    CHECK(find_standing(odometry, fixes_at([&](double t) { return speed * t; })).empty());
    CHECK(find_standing(odometry, {}).empty());
  }
  // a speed in steps of 1 km/h flickers between 0 and 0.28 m/s
  const auto steps = speeds(25, [](double t) { return std::fmod(t, 0.12) < 0.06 ? 0.0 : 0.278; });
  CHECK(find_standing(steps, fixes_at([](double) { return 0; })).empty());
}

TEST_CASE("standing: noise with a sign adds up to nothing, and slow readings tell nothing") {
  const auto at_rest = fixes_at([](double) { return 0; });
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal(0, 0.1);
  CHECK(find_standing(speeds(25, [&](double) { return normal(random); }), at_rest).empty());
  CHECK(find_standing(speeds(25, [](double) { return -0.3; }), at_rest).empty());  // slips, but is no noise
  Noisy noisy;
  CHECK(find_standing(speeds(2, [&](double) { return noisy(0); }), at_rest).empty());
}

}  // namespace standing_test
