// A ferry, a train, a tow truck: the wheels stand, and afterwards the vehicle is elsewhere.
#include <catch2/catch.hpp>

#include <algorithm>

#include <waymark/tools/drive/mending/carried.hpp>

#include "winding_scene.hpp"

namespace carried_test {

using namespace waymark;
using namespace waymark::drive;
using waymark::testing::winding_scene;
using waymark::testing::WindingScene;

namespace {

/// 300 s at 8 m/s with a stop from 100 to 160 s, in which there is no fix. Then all fixes are elsewhere.
WindingScene scene(const Eigen::Vector2d& carried_m) {
  WindingScene result = winding_scene(
      300, [](double t) { return t >= 100 && t <= 160 ? 0.0 : 8.0; }, [](double) { return 0.02; });
  std::erase_if(result.fixes,
                [](const Fix& fix) { return fix.stamp.seconds() > 101 && fix.stamp.seconds() < 159; });
  for (Fix& fix : result.fixes) {
    fix.covariance = Eigen::Matrix2d::Identity();
    if (fix.stamp.seconds() > 101) fix.position += carried_m;
  }
  return result;
}

}  // namespace

TEST_CASE("carried: a stop without fixes, after which all fixes are elsewhere") {
  const WindingScene made = scene({3000, -4000});
  const std::vector<Carried> found = find_carried(made.odometry, made.fixes);
  REQUIRE(found.size() == 1);
  CHECK(made.odometry[found[0].first].stamp.seconds() == Approx(101).margin(0.11));
  CHECK(made.odometry[found[0].last].stamp.seconds() == Approx(159).margin(0.11));
  CHECK(found[0].distance_m == Approx(5000).epsilon(0.01));
  CHECK_THAT(warning_of(found[0], made.odometry, Stamp{}),
             Catch::Contains("carried (ferry, train, tow truck)"));
}

TEST_CASE(
    "carried: a stop without fixes is no carrying if the fixes after it are where the odometry has them") {
  CHECK(find_carried(scene({0, 0}).odometry, scene({0, 0}).fixes).empty());
  // a receiver that wakes up 60 m off
  CHECK(find_carried(scene({60, 0}).odometry, scene({60, 0}).fixes).empty());
}

TEST_CASE("carried: one wrong fix after a stop carries nothing") {
  WindingScene made = scene({0, 0});
  const auto first = std::find_if(made.fixes.begin(), made.fixes.end(),
                                  [](const Fix& fix) { return fix.stamp.seconds() > 101; });
  first->position += Eigen::Vector2d(0, 2000);
  CHECK(find_carried(made.odometry, made.fixes).empty());
}

TEST_CASE("carried: wheels that turn without fixes were driven, and a gap of the odometry is no rest") {
  WindingScene made = scene({3000, -4000});
  for (OdometrySample& sample : made.odometry) sample.speed_mps = 8;
  CHECK(find_carried(made.odometry, made.fixes).empty());
  made = scene({3000, -4000});
  std::erase_if(made.odometry, [](const OdometrySample& sample) {
    return sample.stamp.seconds() > 100.5 && sample.stamp.seconds() < 159.5;
  });
  CHECK(find_carried(made.odometry, made.fixes).empty());
}

TEST_CASE("carried: receivers that claim little must be carried further") {
  WindingScene made = scene({300, -400});
  CHECK(find_carried(made.odometry, made.fixes).size() == 1);
  for (Fix& fix : made.fixes) fix.covariance *= 60 * 60;
  CHECK(find_carried(made.odometry, made.fixes).empty());
}

}  // namespace carried_test
