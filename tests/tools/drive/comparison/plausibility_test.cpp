// Wrong units and signs of the odometry are named; right ones are not.
#include <cmath>
#include <random>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <catch2/catch.hpp>

#include <waymark/tools/drive/comparison/plausibility.hpp>
#include <waymark/types_se2/se2.hpp>

namespace plausibility_test {

using namespace waymark;
using namespace waymark::drive;

namespace {

struct Scene {
  std::vector<Fix> fixes;
  std::vector<Eigen::Vector3d> antenna;
};

/// Fixes at 1 Hz on a winding way at 10 m/s; the odometry's speed and yaw rate are the true ones times a
/// factor.
Scene scene(double speed_factor, double yaw_factor, int seconds = 60) {
  Scene result;
  Pose2<double> truth;
  Pose2<double> reckoned;
  for (int k = 0; k < seconds; ++k) {
    Fix fix;
    fix.stamp = Stamp::from_seconds(k);
    fix.position = truth.position;
    result.fixes.push_back(fix);
    result.antenna.push_back(reckoned.vector());
    const double turn = k / 10 % 2 == 0 ? 0.2 : -0.2;
    truth = compose(truth, se2_exp<double>(Eigen::Vector3d(10, 0, turn)));
    reckoned = compose(reckoned, se2_exp<double>(Eigen::Vector3d(10 * speed_factor, 0, turn * yaw_factor)));
  }
  return result;
}

/// Fixes at 1 Hz; the odometry has another yaw rate on the same way.
template <typename Turn, typename Read>
Scene scene_of(double speed_mps, int seconds, const Turn& turn_at, const Read& read_at) {
  Scene result;
  Pose2<double> truth;
  Pose2<double> reckoned;
  for (int k = 0; k < seconds; ++k) {
    Fix fix;
    fix.stamp = Stamp::from_seconds(k);
    fix.position = truth.position;
    result.fixes.push_back(fix);
    result.antenna.push_back(reckoned.vector());
    truth = compose(truth, se2_exp<double>(Eigen::Vector3d(speed_mps, 0, turn_at(k))));
    reckoned = compose(reckoned, se2_exp<double>(Eigen::Vector3d(speed_mps, 0, read_at(k))));
  }
  // headings are not wrapped
  for (std::size_t k = 1; k < result.antenna.size(); ++k)
    result.antenna[k][2] = result.antenna[k - 1][2] + read_at(static_cast<int>(k) - 1);
  return result;
}

std::vector<std::string> warnings(const Scene& scene) {
  return compare_odometry_with_fixes(scene.fixes, scene.antenna).warnings;
}

}  // namespace

TEST_CASE("plausibility: odometry that agrees with the fixes is not complained about") {
  CHECK(warnings(scene(1, 1)).empty());
  CHECK(warnings(scene(1.02, 0.9)).empty());
}

TEST_CASE("plausibility: a speed in km/h read as m/s is named with its factor") {
  const auto said = warnings(scene(3.6, 1));
  REQUIRE(said.size() == 1);
  CHECK_THAT(said[0], Catch::StartsWith(
                          "the odometry's distance between fixes is 3.60 times the distance of the fixes"));
  CHECK(warnings(scene(1 / 3.6, 1)).size() == 1);
}

TEST_CASE("plausibility: a yaw rate of the wrong sign is named") {
  const auto said = warnings(scene(1, -1));
  REQUIRE(said.size() == 1);
  CHECK_THAT(said[0], Catch::StartsWith("the odometry turns against the fixes (correlation -1.00"));
}

TEST_CASE("plausibility: a few fixes are no evidence") {
  CHECK(warnings(scene(3.6, -1, 8)).empty());
}

TEST_CASE("plausibility: a yaw rate in deg/s read as rad/s is named with its factor, and the reverse") {
  constexpr double kDegrees = 57.29577951308232;
  const auto large = warnings(scene(1, kDegrees));
  REQUIRE(large.size() == 1);
  CHECK_THAT(large[0], Catch::StartsWith("the odometry's turns are 57.") && Catch::Contains("'unit: deg/s'"));
  const auto small = warnings(scene(1, 1 / kDegrees));
  REQUIRE(small.size() == 1);
  CHECK_THAT(small[0],
             Catch::StartsWith("the odometry's turns are 0.017") && Catch::Contains("'unit: rad/s'"));
  const auto both = warnings(scene(1, -kDegrees));
  REQUIRE(both.size() == 1);
  CHECK_THAT(both[0], Catch::EndsWith("and 'convention: cw'"));
  CHECK_THAT(warnings(scene(1, 2)).at(0), Catch::Contains("check the unit and the scale of the yaw rate"));
}

TEST_CASE("plausibility: a scale error of 5 % is named if the fixes show it") {
  const auto said = warnings(scene(1.05, 1, 400));
  REQUIRE(said.size() == 1);
  CHECK_THAT(said[0], Catch::StartsWith("the odometry's distances are 1.050 times those of the fixes"));
  CHECK_THAT(warnings(scene(0.95, 1, 400)).at(0), Catch::Contains("0.950 times"));
  CHECK(warnings(scene(1.02, 1, 400)).empty());
  // fixes with an error of 15 m per axis do not show it
  Scene noisy = scene(1.05, 1, 400);
  for (std::size_t i = 0; i < noisy.fixes.size(); ++i)
    noisy.fixes[i].position += 15 * Eigen::Vector2d(std::sin(2.3 * double(i)), std::cos(3.1 * double(i)));
  CHECK(warnings(noisy).empty());
}

TEST_CASE("plausibility: a way that a gyro bends has shorter chords, and the right scale") {
  const auto winds = [](int k) { return 0.02 * std::sin(0.05 * k); };
  const auto biased = [&](int k) { return winds(k) + 0.05; };
  CHECK(warnings(scene_of(4, 1500, winds, biased)).empty());
  // A true error of scale is still found.
  Scene wrong = scene_of(4, 1500, winds, biased);
  for (Eigen::Vector3d& pose : wrong.antenna) pose.head<2>() *= 1.05;
  REQUIRE(warnings(wrong).size() == 1);
  CHECK_THAT(warnings(wrong)[0], Catch::Contains("1.050 times"));
}

TEST_CASE("plausibility: laps with a dead gyro have shorter chords, and the right scale") {
  const auto laps = [](int k) { return k % 15 < 6 ? 0.0 : 0.35; };
  const auto dead = [](int) { return 0.0; };
  CHECK_THAT(fmt::format("{}", fmt::join(warnings(scene_of(14, 480, laps, dead)), "\n")),
             !Catch::Contains("distances are"));
}

TEST_CASE("plausibility: noise that makes turns of a vehicle that hardly turns is no other unit") {
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal(0, 1);
  const auto winds = [](int k) { return 0.03 * std::sin(0.07 * k); };
  Scene straight = scene_of(5, 1500, winds, winds);
  std::size_t named = 0;
  for (int drive = 0; drive < 20; ++drive) {
    Scene noisy = straight;
    for (Fix& fix : noisy.fixes) fix.position += 1.0 * Eigen::Vector2d(normal(random), normal(random));
    for (const std::string& warning : warnings(noisy))
      named += warning.find("turns are") != std::string::npos;
  }
  CHECK(named == 0);
  Scene doubled = scene_of(
      5, 1500, [](int k) { return 0.1 * std::sin(0.07 * k); },
      [](int k) { return 0.2 * std::sin(0.07 * k); });
  CHECK_THAT(warnings(doubled).at(0), Catch::Contains("turns are 2"));
}

TEST_CASE("plausibility: slow U-turns between straight lanes show no other size of turns") {
  constexpr double kPi = 3.14159265358979;
  constexpr double kRate_Hz = 5;
  constexpr double kRadius_m = 5;
  for (const double turning_mps : {1.5, 2.0, 2.5}) {
    const int turn = static_cast<int>(std::lround(kRate_Hz * kPi * kRadius_m / turning_mps));
    Scene field;
    Eigen::Vector3d pose = Eigen::Vector3d::Zero();
    for (int lane = 0, k = 0; lane < 24; ++lane) {
      for (int step = 0; step < 60 + turn; ++step, ++k) {
        Fix fix;
        fix.stamp = Stamp::from_seconds(k / kRate_Hz);
        fix.position = pose.head<2>();
        field.fixes.push_back(fix);
        field.antenna.push_back(pose);
        const bool turns = step >= 60;
        const double way_m = (turns ? turning_mps : 5.0) / kRate_Hz;
        const double by = turns ? (lane % 2 == 0 ? kPi : -kPi) / turn : 0;
        pose += Eigen::Vector3d(way_m * std::cos(pose[2] + by / 2), way_m * std::sin(pose[2] + by / 2), by);
      }
    }
    CHECK(warnings(field).empty());
  }
}

TEST_CASE("plausibility: fixes with an error of 10 m do not lengthen the way of a slow vehicle") {
  Scene slow = scene(1, 1, 400);
  for (std::size_t i = 0; i < slow.fixes.size(); ++i) {
    slow.fixes[i].position *= 0.1;  // 1 m/s
    slow.antenna[i].head<2>() *= 0.1;
    slow.fixes[i].position += 10 * Eigen::Vector2d(std::sin(2.3 * double(i)), std::cos(3.1 * double(i)));
  }
  CHECK(warnings(slow).empty());
}

TEST_CASE("plausibility: a jump that lasts is named with its size and time, a single wrong fix is not") {
  Scene jump = scene(1, 1, 200);
  for (std::size_t i = 80; i < 120; ++i) jump.fixes[i].position.y() += 200;
  const auto said = warnings(jump);
  REQUIRE(said.size() == 1);
  CHECK_THAT(said[0], Catch::Contains("by 200 m at 80.0 s after the first fix, and back after 40 s;") &&
                          Catch::Contains("the 40 fixes between are left out"));
  for (std::size_t i = 120; i < 200; ++i) jump.fixes[i].position.y() += 200;
  const auto stays = warnings(jump);
  REQUIRE(stays.size() == 1);
  CHECK_THAT(stays[0], Catch::Contains("by 200 m at 80.0 s after the first fix, and stay there for 119 s, "
                                       "until the end;"));
  Scene single = scene(1, 1, 200);
  single.fixes[80].position.y() += 200;
  CHECK(warnings(single).empty());
}

TEST_CASE("plausibility: jumps to the side and back are no bends that the odometry misses") {
  Scene straight;
  for (int k = 0; k < 700; ++k) {
    Fix fix;
    fix.stamp = Stamp::from_seconds(k);
    const bool aside = k % 150 >= 100 && k % 150 < 130;
    fix.position = {25.0 * k, aside ? 60.0 : 0.0};
    straight.fixes.push_back(fix);
    straight.antenna.emplace_back(25.0 * k, 0, 0);
  }
  const auto said = warnings(straight);
  REQUIRE_FALSE(said.empty());
  CHECK_THAT(said[0],
             Catch::StartsWith("the fixes jump by 60 m at 100.0 s after the first fix, and back after 30 s"));
}

TEST_CASE("plausibility: fixes that jump as the vehicle starts are named") {
  Scene start;
  double way = 0;
  for (int k = 0; k < 200; ++k) {
    if (k > 80) way += std::min(10.0, 0.5 * (k - 80));
    Fix fix;
    fix.stamp = Stamp::from_seconds(k);
    fix.position = {way, k > 80 && k < 130 ? 200.0 : 0.0};
    start.fixes.push_back(fix);
    start.antenna.emplace_back(way, 0, 0);
  }
  const auto said = warnings(start);
  REQUIRE(said.size() == 1);
  CHECK_THAT(said[0], Catch::StartsWith("the fixes jump by 200 m at 81.0 s"));
}

TEST_CASE("plausibility: after a slow way the direction of a long step is not known") {
  // A fix in 5 s. The vehicle creeps 1 m in 10 s, and then drives 60 m between two fixes.
  Scene slow;
  double way = 0;
  for (int k = 0; k < 60; ++k) {
    if (k > 0) way += k % 12 < 4 ? 0.5 : 60;
    Fix fix;
    fix.stamp = Stamp::from_seconds(5 * k);
    fix.position = {way + 2 * std::sin(2.3 * k), 2 * std::cos(3.1 * k)};
    slow.fixes.push_back(fix);
    slow.antenna.emplace_back(way, 0, 0);
  }
  CHECK(warnings(slow).empty());
}

TEST_CASE("plausibility: who is wrong after a gap cannot be told if the fixes do not come back") {
  Scene whole = scene(1, 1, 300);
  Scene gap;
  for (std::size_t i = 0; i < whole.fixes.size(); ++i) {
    if (i >= 140 && i < 155) continue;
    Fix fix = whole.fixes[i];
    fix.position += Eigen::Vector2d(std::sin(2.3 * double(i)), std::cos(3.1 * double(i)));
    if (i >= 155) fix.position.y() += 60;
    gap.fixes.push_back(fix);
    gap.antenna.push_back(whole.antenna[i]);
  }
  CHECK(warnings(gap).empty());
  for (std::size_t i = 185; i < gap.fixes.size(); ++i) gap.fixes[i].position.y() -= 60;
  const auto said = warnings(gap);
  REQUIRE(said.size() == 1);
  CHECK_THAT(said[0], Catch::StartsWith("the fixes jump by") && Catch::Contains("and back after"));
}

TEST_CASE("plausibility: a poor gyro on a fast road after slow streets makes no jump of the fixes") {
  int drives_with_jumps = 0;
  for (unsigned seed = 1; seed <= 40; ++seed) {
    std::mt19937_64 random(seed);
    std::normal_distribution<double> normal;
    Scene drive;
    Pose2<double> truth;
    Pose2<double> reckoned;
    for (int k = 0; k < 1200; ++k) {
      Fix fix;
      fix.stamp = Stamp::from_seconds(k);
      fix.position = truth.position + Eigen::Vector2d(normal(random), normal(random));
      fix.covariance.setIdentity();
      drive.fixes.push_back(fix);
      drive.antenna.push_back(reckoned.vector());
      const double speed = k < 800 ? 5 : 25;
      const double turn = 0.02 * std::sin(0.01 * k);
      truth = compose(truth, se2_exp<double>(Eigen::Vector3d(speed, 0, turn)));
      reckoned = compose(reckoned, se2_exp<double>(Eigen::Vector3d(speed, 0, turn + 0.02 * normal(random))));
    }
    drives_with_jumps += warnings(drive).empty() ? 0 : 1;
  }
  CHECK(drives_with_jumps <= 4);  // judged by the time alone: 17
}

TEST_CASE(
    "plausibility: an odometry that a tunnel has turned by the bias of its gyro makes no jump of the fixes") {
  const auto winds = [](int k) { return 0.01 * std::sin(0.02 * k); };
  for (const double bias : {-0.008, 0.003, 0.006}) {
    INFO("bias " << bias << " rad/s");
    const Scene whole = scene_of(25, 1800, winds, [&](int k) { return winds(k) + bias; });
    Scene tunnels;
    std::mt19937_64 random(7);
    std::normal_distribution<double> normal;
    for (std::size_t k = 0; k < whole.fixes.size(); ++k) {
      if (k % 300 >= 200 && k % 300 < 200 + k / 15) continue;  // of 13 to 100 s
      Fix fix = whole.fixes[k];
      fix.position += Eigen::Vector2d(normal(random), normal(random));
      fix.covariance.setIdentity();
      tunnels.fixes.push_back(fix);
      tunnels.antenna.push_back(whole.antenna[k]);
    }
    CHECK(warnings(tunnels).empty());
  }
}

TEST_CASE("plausibility: of another receiver the jumps are named, unless the odometry is in a wrong unit") {
  const std::vector<std::string> names = {"front", "roof"};
  for (const double speed_factor : {1.0, 3.6}) {
    Scene both = scene(speed_factor, 1, 200);
    Scene roof = both;
    for (std::size_t i = 0; i < roof.fixes.size(); ++i) {
      roof.fixes[i].source = 1;
      if (i >= 80 && i < 120) roof.fixes[i].position.y() += 200;
    }
    both.fixes.insert(both.fixes.end(), roof.fixes.begin(), roof.fixes.end());
    both.antenna.insert(both.antenna.end(), roof.antenna.begin(), roof.antenna.end());
    const auto said = compare_odometry_with_fixes(both.fixes, both.antenna, {}, names).warnings;
    REQUIRE(said.size() == 1);
    if (speed_factor == 1)
      CHECK_THAT(said[0],
                 Catch::StartsWith("roof: the fixes jump by 200 m at 80.0 s after the first fix, and back"));
    else
      CHECK_THAT(said[0], Catch::Contains("check the unit of the speed"));
  }
}

TEST_CASE("plausibility: an impossible acceleration is named without any fix") {
  std::vector<OdometrySample> odometry(100);
  for (OdometrySample& sample : odometry) sample = {.stamp = {}, .speed_mps = 10, .yaw_rate_radps = 1.6};
  CHECK(warning_of_accelerations(odometry).empty());  // 16 m/s^2: a racing car
  for (std::size_t i = 0; i < 6; ++i) odometry[i].yaw_rate_radps *= 57.3;
  CHECK_THAT(warning_of_accelerations(odometry), Catch::Contains("in 6 % of the driving"));
}

}  // namespace plausibility_test
