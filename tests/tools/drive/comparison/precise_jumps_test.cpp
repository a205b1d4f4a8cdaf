// A phase solution with wrong ambiguities keeps its claim of centimetres; its jump is found, whatever the odometry's
// scale and heading, and nothing else is taken for one.
#include <algorithm>
#include <cmath>
#include <random>

#include <catch2/catch.hpp>

#include <waymark/tools/drive/comparison/precise_jumps.hpp>
#include <waymark/types_se2/se2.hpp>

namespace precise_jumps_test {

using namespace waymark;
using namespace waymark::drive;

namespace {

/// 400 fixes at 1 Hz with an error of 6 mm that claim 2 cm, of an antenna ahead of the vehicle; it turns sharply now
/// and then, and stands for a while. The odometry has a scale that is 2 % wrong, another frame, and drifts.
ReckonedFixes receiver(double antenna_ahead_m, double speed_scale = 1.02) {
  std::mt19937 random(3);
  std::normal_distribution<double> noise_m(0, 0.006);
  ReckonedFixes result;
  Pose2<double> truth;
  Pose2<double> reckoned(5, -3, 1.2);
  for (int k = 0; k < 400; ++k) {
    Fix fix;
    fix.stamp = Stamp::from_seconds(k);
    fix.position = compose(truth, Pose2<double>(antenna_ahead_m, 0, 0)).position +
                   Eigen::Vector2d(noise_m(random), noise_m(random));
    fix.covariance = Eigen::Matrix2d::Identity() * 0.02 * 0.02;
    fix.accuracy_claimed = true;
    result.fixes.push_back(fix);
    result.antenna.push_back(reckoned.vector());
    const double speed_mps = k > 200 && k < 230 ? 0 : k % 40 < 5 ? 4 : 12;
    const double turn_rad = speed_mps == 4 ? (k / 40 % 2 == 0 ? 0.3 : -0.3) : 0;
    truth = compose(truth, se2_exp<double>(Eigen::Vector3d(speed_mps, 0, turn_rad)));
    reckoned =
        compose(reckoned, se2_exp<double>(Eigen::Vector3d(speed_mps * speed_scale, 0, turn_rad + 0.001)));
  }
  return result;
}

void move(ReckonedFixes& receiver, std::size_t first, std::size_t last, const Eigen::Vector2d& by) {
  for (std::size_t i = first; i < last; ++i) receiver.fixes[i].position += by;
}

const Eigen::Vector2d kWrong_m(0.6, -0.5);

}  // namespace

TEST_CASE("precise jumps: a wrong phase solution is found by its steps there and back") {
  const double antenna_ahead_m = GENERATE(0.0, 0.2);
  const std::size_t first = GENERATE(100U, 215U);  // while it drives, and while it stands
  ReckonedFixes wrong = receiver(antenna_ahead_m);
  move(wrong, first, 300, kWrong_m);
  const std::vector<Jump> found = precise_jumps_of(wrong);
  REQUIRE(found.size() == 2);
  CHECK(found[0].first == first);
  CHECK((found[0].by - kWrong_m).norm() < 0.1);
  CHECK(found[0].claimed_m == Approx(0.02));
  CHECK(found[1].first == 300);
  CHECK((found[1].by + kWrong_m).norm() < 0.1);
}

TEST_CASE("precise jumps: the fixes between are wrong, those of the rest are not") {
  ReckonedFixes wrong = receiver(0);
  move(wrong, 100, 200, kWrong_m);
  const std::vector<Jump> jumps = jumps_of(wrong);
  REQUIRE(jumps.size() == 2);
  CHECK(jumps[0].undone);
  CHECK(jumps[0].end == 200);
  CHECK_FALSE(jumps[1].undone);
}

TEST_CASE("precise jumps: one within the time of a large jump and back leaves those a pair") {
  ReckonedFixes wrong = receiver(0);
  move(wrong, 100, 200, {60, 0});
  move(wrong, 150, 400, kWrong_m);
  const std::vector<Jump> jumps = jumps_of(wrong);
  const auto large =
      std::find_if(jumps.begin(), jumps.end(), [](const Jump& jump) { return jump.first == 100; });
  REQUIRE(large != jumps.end());
  CHECK(large->undone);
  CHECK(large->end == 200);
}

TEST_CASE("precise jumps: an antenna whose place is not stated makes none in sharp turns") {
  CHECK(precise_jumps_of(receiver(0)).empty());
  CHECK(precise_jumps_of(receiver(1.8)).empty());
  CHECK(precise_jumps_of(receiver(-2.5, 0.9)).empty());
}

TEST_CASE("precise jumps: fixes that claim as much as they move, or nothing, make none") {
  ReckonedFixes told = receiver(0);
  move(told, 100, 200, kWrong_m);
  ReckonedFixes silent = told;
  for (std::size_t i = 100; i < 200; ++i)
    told.fixes[i].covariance = Eigen::Matrix2d::Identity();  // a float solution
  CHECK(precise_jumps_of(told).empty());
  for (Fix& fix : silent.fixes) fix.accuracy_claimed = false;
  CHECK(precise_jumps_of(silent).empty());
}

TEST_CASE("precise jumps: a single wrong fix is left to the tails of the model") {
  ReckonedFixes single = receiver(0);
  move(single, 150, 151, kWrong_m);
  CHECK(precise_jumps_of(single).empty());
}

}  // namespace precise_jumps_test
