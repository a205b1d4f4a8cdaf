// Wrong units and signs of the odometry are named; right ones are not.
#include <catch2/catch.hpp>

#include <waymark/tools/drive/nodes/plausibility.hpp>
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

std::vector<std::string> warnings(const Scene& scene) {
  return compare_odometry_with_fixes(scene.fixes, scene.antenna);
}

}  // namespace

TEST_CASE("plausibility: odometry that agrees with the fixes is not complained about") {
  CHECK(warnings(scene(1, 1)).empty());
  CHECK(warnings(scene(1.1, 0.9)).empty());
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

}  // namespace plausibility_test
