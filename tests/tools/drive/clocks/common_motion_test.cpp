// Whether two series are of one motion: what resembles each other by chance is not taken for it.
#include <cmath>
#include <optional>
#include <random>
#include <utility>
#include <vector>

#include <catch2/catch.hpp>

#include <waymark/tools/drive/clocks/common_motion.hpp>
#include <waymark/tools/drive/clocks/lag_search.hpp>

namespace common_motion_test {

using namespace waymark;
using namespace waymark::drive;

namespace {

constexpr int kSeconds = 90;

/// A walk of steps of 0.5 each second, as speeds are.
class Walk {
 public:
  explicit Walk(unsigned seed) : random_(seed) {}
  double next() { return value_ += 0.5 * normal_(random_); }
  double noise(double sigma) { return sigma * normal_(random_); }

 private:
  std::mt19937 random_;
  std::normal_distribution<double> normal_;
  double value_ = 0;
};

}  // namespace

TEST_CASE("common motion: two walks that have nothing in common correlate, but do not score") {
  constexpr int kPairs = 500;
  int correlate = 0;
  int score = 0;
  for (unsigned pair = 0; pair < kPairs; ++pair) {
    Walk one(2 * pair);
    Walk other(2 * pair + 1);
    CommonMotion common;
    for (int i = 0; i < kSeconds; ++i) common.add(one.next(), other.next(), i > 0);
    correlate += common.correlation() > 0.5;
    score += common.score() > 6;
  }
  // Walks correlate whatever their length (Yule 1926). Twice the score is chi-square of one degree of freedom, and
  // half of the slopes are negative: 0.03 % exceed 6.
  CHECK(correlate > kPairs / 10);
  CHECK(score <= 2);
}

TEST_CASE("common motion: the score is that of the noise against the steps") {
  // What is new each second: 0.5 without the other series, with it white noise.
  constexpr double kNoise = 0.05;
  double total = 0;
  constexpr int kWalks = 50;
  for (unsigned seed = 0; seed < kWalks; ++seed) {
    Walk walk(seed);
    CommonMotion common;
    for (int i = 0; i < kSeconds; ++i) {
      const double speed = walk.next();
      common.add(1.02 * speed, speed + walk.noise(kNoise), i > 0);
    }
    CHECK(common.correlation() > 0.97);
    total += common.score() / kWalks;
  }
  const double theory = -0.5 * (kSeconds - 1) * std::log(kNoise * kNoise / (0.25 + 2 * kNoise * kNoise));
  CHECK(total == Approx(theory).epsilon(0.05));
}

TEST_CASE("common motion: an opposite one, a constant one and none at all do not score") {
  CommonMotion nothing;
  CHECK(nothing.score() == 0);
  CHECK(nothing.correlation() == 0);
  Walk walk(1);
  CommonMotion opposite;
  CommonMotion constant;
  for (int i = 0; i < kSeconds; ++i) {
    const double speed = walk.next();
    opposite.add(-speed, speed, i > 0);
    constant.add(1, speed, i > 0);
  }
  CHECK(opposite.score() == 0);
  CHECK(opposite.correlation() == Approx(-1));
  CHECK(constant.score() == 0);
}

TEST_CASE("common motion: an offset is found in hours of readings, of which some are taken, and at 10 Hz") {
  const auto [seconds, interval_s] = GENERATE(std::pair{12000, 1.0}, std::pair{300, 0.1});
  constexpr double kLate_s = 5;
  Walk walk(3);
  std::vector<OdometrySample> odometry;
  GnssMotion speeds{"speed", {}};
  double speed = 20;
  for (int i = 0; i * interval_s < seconds; ++i) {
    const Stamp stamp = Stamp::from_seconds(i * interval_s);
    speed = std::abs(20 + walk.next());
    odometry.push_back({stamp.later(kLate_s), speed, 0});
    speeds.stretches.push_back({stamp, stamp.later(interval_s), speed + walk.noise(0.05)});
  }
  const std::optional<Lag> lag = LagSearch(odometry, speeds, {}).find(0);
  REQUIRE(lag);
  CHECK(lag->late_s == Approx(kLate_s).margin(0.5));
}

}  // namespace common_motion_test
