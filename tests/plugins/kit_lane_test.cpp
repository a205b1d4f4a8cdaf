// Sensor kit: lateral offsets to lines of a map.
#include <numbers>

#include <waymark/core/base/error.hpp>
#include <waymark/plugins/lane/lane.hpp>

#include "plugins/kit_drive.hpp"

namespace kit_lane_test {

using namespace waymark;
using namespace waymark::plugins::lane;
using namespace waymark_test;

namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kSigma = 0.1;

/// The line through the drive's true start, along its first heading.
struct Line {
  Eigen::Vector2d a, b;
  [[nodiscard]] double left_of(const Eigen::Vector2d& p) const {
    const Eigen::Vector2d along = (b - a).normalized();
    return along[0] * (p[1] - a[1]) - along[1] * (p[0] - a[0]);
  }
};

Line line_of(const KitDrive& drive) {
  const Pose2<double>& first = drive.truth[0];
  return {first.position, first.position + rotate(first.heading, Eigen::Vector2d(500, 0))};
}

std::map<std::string, double> row(const Line& line, double offset) {
  return {{"offset", offset}, {"ax", line.a[0]}, {"ay", line.a[1]}, {"bx", line.b[0]}, {"by", line.b[1]}};
}

}  // namespace

TEST_CASE("lane: left of the line is positive, seen in its own direction") {
  // Eastward through the origin: (5, 2) is 2 m to the left; westward it is 2 m to the right.
  const Pose2<double> pose(5, 2, kPi / 2);
  CHECK(EdgeLateralOffset{0, {0, 0}, 0, {0, 0}}.error(pose)[0] == Approx(2));
  CHECK(EdgeLateralOffset{0, {10, 0}, kPi, {0, 0}}.error(pose)[0] == Approx(-2));
  CHECK(EdgeLateralOffset{2, {0, 0}, 0, {0, 0}}.error(pose)[0] == Approx(0).margin(1e-15));
  // Heading north, a camera 1.5 m ahead of the body point is 3.5 m to the left, one to the left as far as it.
  CHECK(EdgeLateralOffset{0, {0, 0}, 0, {1.5, 0}}.error(pose)[0] == Approx(3.5));
  CHECK(EdgeLateralOffset{0, {0, 0}, 0, {0, 1.5}}.error(pose)[0] == Approx(2));
}

TEST_CASE("lane: a reading between nodes is that of the point at its own moment") {
  KitRecipe recipe;
  recipe.seconds = 1;
  recipe.motion = [](double) { return Eigen::Vector2d(10, 0.5); };
  recipe.noise = {1e-9, 1e-9, 1e-9, 0, 1e-12, 1};
  KitDrive drive = make_kit_drive(recipe, 1);
  const Pose2<double> then =
      compose(drive.truth[5], se2_exp<double>(Eigen::Vector3d(10 * 0.04, 0, 0.5 * 0.04)));
  const Line line = line_of(drive);
  const Eigen::Vector2d camera = then.position + rotate(then.heading, Eigen::Vector2d(1.5, 0.2));
  Readings readings("lane");
  readings.add(kit_stamp(0.54), row(line, line.left_of(camera)));
  drive.add_sensor("lane", readings.table(), {{"lever_x", "1.5"}, {"lever_y", "0.2"}});
  const std::size_t last = drive.graph.batch_count() - 1;
  REQUIRE(drive.graph.edge_type(last).tag == "EDGE_LATERAL_OFFSET");
  CHECK(drive.graph.batch(last).vertices(0)[0] == drive.poses[5]);
  // In units of the sigma of 0.2 m; the simulated noise is of 0.1 mm.
  CHECK(drive.graph.batch(last).chi2(drive.graph.view()) < 1e-5);
}

TEST_CASE("lane: the lateral error falls to the camera's, the one along the line stays") {
  KitRecipe recipe;
  recipe.fix_sigma_m = 3;
  recipe.noise = {1e-3, 1e-3, 1e-3, 0, 1e-5, 1};
  constexpr int kSeeds = 20;
  double lateral_without = 0;
  double lateral_with = 0;
  double normalised = 0;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    KitDrive without = make_kit_drive(recipe, seed);
    KitDrive with = without;
    const Line line = line_of(with);
    Noise noise(7000 + seed);
    Readings readings("lane");
    for (std::size_t i = 0; i < with.truth.size(); i += kNodesPerSecond / 2)
      readings.add(with.stamps[i], row(line, line.left_of(with.truth[i].position) + noise(kSigma)));
    with.add_sensor("lane", readings.table(), {{"sigma", shortest(kSigma)}});
    REQUIRE(edges_of(with.graph, "EDGE_LATERAL_OFFSET") == 121);
    const Solution before = solve(without);
    const Solution after = solve(with);
    const Eigen::Vector2d along = (line.b - line.a).normalized();
    const Eigen::Vector2d left(-along[1], along[0]);
    const auto sigma = [](const Solution& s, std::size_t node, const Eigen::Vector2d& axis) {
      return std::sqrt(axis.dot(s.covariances[node].topLeftCorner<2, 2>() * axis));
    };
    for (std::size_t i = 0; i < with.truth.size(); ++i) {
      lateral_without += std::pow(left.dot(before.errors[i].head<2>()), 2);
      lateral_with += std::pow(left.dot(after.errors[i].head<2>()), 2);
    }
    CHECK(sigma(after, 300, left) < kSigma);
    CHECK(sigma(before, 300, left) > 3 * kSigma);
    CHECK(sigma(after, 300, along) == Approx(sigma(before, 300, along)).epsilon(0.05));
    normalised += after.normalised(300);
  }
  CHECK(std::sqrt(lateral_with / (kSeeds * 601)) < kSigma);
  CHECK(lateral_with < lateral_without / 9);
  check_mean_chi_square(normalised, 3, kSeeds);
}

TEST_CASE("lane: two points in one place give no line") {
  KitRecipe recipe;
  recipe.seconds = 1;
  KitDrive drive = make_kit_drive(recipe, 1);
  Readings readings("lane");
  readings.add(kit_stamp(0.5), row({{3, 4}, {3, 4}}, 1));
  CHECK_THROWS_WITH(drive.add_sensor("lane", readings.table()),
                    "row 1 (time 1000.5): column 'bx': a and b are one point: they give no line");
}

}  // namespace kit_lane_test
