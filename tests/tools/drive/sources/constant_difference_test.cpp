// Receivers that differ all drive long are named, with what they differ by and in which axes.
#include <catch2/catch.hpp>

#include <array>
#include <cmath>
#include <random>
#include <span>

#include <waymark/tools/drive/comparison/constant_difference.hpp>
#include <waymark/types_se2/se2.hpp>

namespace constant_difference_test {

using namespace waymark;
using namespace waymark::drive;

namespace {

struct Scene {
  std::vector<Fix> fixes;  ///< two receivers at 1 Hz
  std::vector<Eigen::Vector3d> poses;
};

/// 10 minutes in a circle. Both receivers err by 2 m for 30 s at a time and claim 2.4 m.
Scene circle(const Eigen::Vector2d& in_frame, const Eigen::Vector2d& in_body) {
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal(0, 2);
  Scene scene;
  std::array<Eigen::Vector2d, 2> error{};
  for (int t = 0; t < 600; ++t) {
    for (int source = 0; source < 2; ++source) {
      Eigen::Vector2d& own = error[static_cast<std::size_t>(source)];
      if (t % 30 == 0) own = {normal(random), normal(random)};
      const double heading = 0.02 * t;
      const Eigen::Vector3d pose(500 * std::sin(heading), -500 * std::cos(heading), heading);
      Fix fix;
      fix.stamp = Stamp::from_seconds(t + 0.3 * source);
      fix.source = source;
      fix.covariance = 2.4 * 2.4 * Eigen::Matrix2d::Identity();
      fix.position = pose.head<2>() + own;
      if (source == 1) fix.position += in_frame + rotate(heading, in_body);
      scene.fixes.push_back(fix);
      scene.poses.push_back(pose);
    }
  }
  return scene;
}

}  // namespace

TEST_CASE("constant difference: another datum is told in the axes of the frame") {
  const Scene scene = circle({8, -6}, {0, 0});
  const std::vector<ConstantDifference> found = compare_receivers(scene.fixes, scene.poses).differ;
  REQUIRE(found.size() == 1);
  CHECK_FALSE(found[0].in_body);
  CHECK(found[0].turned);
  CHECK((found[0].second_m - Eigen::Vector2d(8, -6)).norm() < 2.5);  // 20 errors of 2 m for each receiver
  const std::array<std::string, 2> names{"front", "rear"};
  const std::string warning = warning_of(found[0], names);
  CHECK_THAT(warning, Catch::StartsWith("rear is ") && Catch::Contains("to the east") &&
                          Catch::Contains("to the south") && Catch::Contains("another datum"));
}

TEST_CASE("constant difference: an antenna elsewhere is told in the axes of the vehicle") {
  const Scene scene = circle({0, 0}, {-9, 1});
  const std::vector<ConstantDifference> found = compare_receivers(scene.fixes, scene.poses).differ;
  REQUIRE(found.size() == 1);
  CHECK(found[0].in_body);
  CHECK((found[0].second_m - Eigen::Vector2d(-9, 1)).norm() < 2.5);
  const std::array<std::string, 2> names{"front", "rear"};
  CHECK_THAT(warning_of(found[0], names), Catch::Contains("m behind and") && Catch::Contains("antenna: ["));
}

TEST_CASE("constant difference: receivers that agree within their claims are not named") {
  const Scene alike = circle({0, 0}, {0, 0});
  CHECK(compare_receivers(alike.fixes, alike.poses).differ.empty());
  const Scene near = circle({2, 2}, {0, 0});
  CHECK(compare_receivers(near.fixes, near.poses).differ.empty());
}

TEST_CASE("constant difference: two minutes do not tell errors that last from a difference that stays") {
  const Scene scene = circle({8, -6}, {0, 0});
  const auto differs_after = [&](std::size_t minutes) {
    const std::size_t fixes = 2 * 60 * minutes;
    return !compare_receivers(std::span(scene.fixes).first(fixes), std::span(scene.poses).first(fixes))
                .differ.empty();
  };
  CHECK_FALSE(differs_after(2));
  CHECK(differs_after(8));
  // Nor do they agree, which would be a voice against a third one.
  CHECK(
      compare_receivers(std::span(scene.fixes).first(240), std::span(scene.poses).first(240)).agree.empty());
}

TEST_CASE("constant difference: a straight way does not tell an antenna from a datum") {
  Scene scene = circle({0, 0}, {0, 0});
  for (std::size_t i = 0; i < scene.fixes.size(); ++i) {
    const double x = 10 * seconds_between(Stamp{}, scene.fixes[i].stamp);
    scene.fixes[i].position +=
        Eigen::Vector2d(x + (scene.fixes[i].source == 1 ? 8 : 0), 0) - scene.poses[i].head<2>();
    scene.poses[i] = {x, 0, 0};
  }
  const std::vector<ConstantDifference> found = compare_receivers(scene.fixes, scene.poses).differ;
  REQUIRE(found.size() == 1);
  CHECK_FALSE(found[0].turned);
  const std::array<std::string, 2> names{"front", "rear"};
  CHECK_THAT(warning_of(found[0], names, "for minutes"), Catch::Contains("for minutes") &&
                                                             Catch::Contains("another datum") &&
                                                             Catch::Contains("antenna: ["));
}

TEST_CASE("constant difference: what grows with the speed is a clock, and its lateness is told") {
  Scene scene = circle({0, 0}, {0, 0});
  double way = 0;
  for (std::size_t i = 0; i < scene.fixes.size(); ++i) {
    const double t = seconds_between(Stamp{}, scene.fixes[i].stamp);
    const double speed = 10 + 8 * std::sin(0.05 * t);  // 2 to 18 m/s
    if (i > 0) way += speed * seconds_between(scene.fixes[i - 1].stamp, scene.fixes[i].stamp);
    const double heading = way / 200;
    const Eigen::Vector3d pose(200 * std::sin(heading), -200 * std::cos(heading), heading);
    scene.fixes[i].position += pose.head<2>() - scene.poses[i].head<2>();
    if (scene.fixes[i].source == 1)
      scene.fixes[i].position -= rotate(heading, Eigen::Vector2d(0.8 * speed, 0));
    scene.poses[i] = pose;
  }
  const std::vector<ConstantDifference> found = compare_receivers(scene.fixes, scene.poses).differ;
  REQUIRE(found.size() == 1);
  REQUIRE(found[0].late_s);
  CHECK(*found[0].late_s == Approx(0.8).margin(0.3));  // 10 errors of 2 m in each half, 14 m/s apart
  const std::array<std::string, 2> names{"front", "rear"};
  CHECK_THAT(warning_of(found[0], names), Catch::StartsWith("the fixes of rear are 0.") &&
                                              Catch::Contains("later than those of front") &&
                                              Catch::Contains("'delay' of rear"));
  // An antenna that is elsewhere is so at any speed.
  for (std::size_t i = 0; i < scene.fixes.size(); ++i) {
    const double heading = scene.poses[i][2];
    if (scene.fixes[i].source != 1) continue;
    const double t = seconds_between(Stamp{}, scene.fixes[i].stamp);
    scene.fixes[i].position += rotate(heading, Eigen::Vector2d(0.8 * (10 + 8 * std::sin(0.05 * t)) - 9, 0));
  }
  const std::vector<ConstantDifference> antenna = compare_receivers(scene.fixes, scene.poses).differ;
  REQUIRE(antenna.size() == 1);
  CHECK_FALSE(antenna[0].late_s);
}

TEST_CASE("constant difference: of three the one that differs from two that agree is outvoted") {
  ComparedReceivers compared{.differ = {{.first = 0, .second = 2}, {.first = 1, .second = 2}},
                             .agree = {{0, 1}}};
  const std::array<std::size_t, 3> apart{0, 1, 2};
  CHECK(outvoted(compared, apart) == std::vector<int>{2});
  // Two with common errors are one voice, and nobody knows which of the two is wrong.
  const std::array<std::size_t, 3> together{0, 0, 1};
  CHECK(outvoted(compared, together).empty());
  // All three differ.
  compared.differ.push_back({.first = 0, .second = 1});
  compared.agree.clear();
  CHECK(outvoted(compared, apart).empty());
  // Two and two: nobody knows.
  const std::array<std::size_t, 4> four{0, 1, 2, 3};
  const ComparedReceivers camps{.differ = {{.first = 0, .second = 2},
                                           {.first = 0, .second = 3},
                                           {.first = 1, .second = 2},
                                           {.first = 1, .second = 3}},
                                .agree = {{0, 1}, {2, 3}}};
  CHECK(outvoted(camps, four).empty());
  // Three and two: the two are wrong.
  ComparedReceivers majority = camps;
  majority.agree.insert(majority.agree.end(), {{0, 4}, {1, 4}});
  majority.differ.insert(majority.differ.end(), {{.first = 2, .second = 4}, {.first = 3, .second = 4}});
  const std::array<std::size_t, 5> five{0, 1, 2, 3, 4};
  CHECK(outvoted(majority, five) == std::vector<int>{2, 3});
  // A clock is no place.
  compared.agree = {{0, 1}};
  compared.differ = {{.first = 0, .second = 2, .late_s = 0.5}, {.first = 1, .second = 2, .late_s = 0.5}};
  CHECK(outvoted(compared, apart).empty());
}

}  // namespace constant_difference_test
