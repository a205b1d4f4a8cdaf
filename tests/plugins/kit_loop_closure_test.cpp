// Sensor kit: relative poses from scan matching.
#include <numbers>

#include <waymark/core/base/error.hpp>

#include "plugins/kit_drive.hpp"

namespace kit_loop_closure_test {

using namespace waymark;
using namespace waymark_test;
using Catch::Contains;

namespace {

constexpr double kSigma = 0.05;
constexpr double kSigmaHeading = 0.003;
constexpr int kLap = 30;  // s

/// Two laps of 300 m; fixes in the first five seconds only; a gyro that drifts by degrees.
KitRecipe two_laps() {
  KitRecipe recipe;
  recipe.motion = [](double) { return Eigen::Vector2d(10, 2 * std::numbers::pi / kLap); };
  recipe.noise = {1e-4, 1e-4, 1e-5, 0, 1e-4, 1};
  recipe.last_fix_s = 5;
  recipe.fix_sigma_m = 0.5;
  return recipe;
}

/// The body at a time between two nodes: on the arc that the odometry says.
Pose2<double> truth_at(const KitDrive& drive, double t) {
  const auto node = static_cast<std::size_t>(t * kNodesPerSecond);
  const double rest = t - 0.1 * static_cast<double>(node);
  const Interval& motion = drive.intervals[node];
  const Eigen::Vector3d twist(motion.speed_mps, 0, motion.yaw_rate_radps);
  return compose(drive.truth[node], se2_exp<double>(rest * twist));
}

void add(Readings& readings, double from_s, double to_s, const Pose2<double>& z) {
  readings.add(kit_stamp(from_s), {{"dt", to_s - from_s},
                                   {"x", z.position[0]},
                                   {"y", z.position[1]},
                                   {"heading", z.heading},
                                   {"sigma", kSigma},
                                   {"sigma_heading", kSigmaHeading}});
}

/// chi2 of the one EDGE_SE2 at the truth.
double chi2_at_truth(KitDrive drive, const SensorTable& readings, const Options& options) {
  drive.add_sensor("loop_closure", readings, options);
  for (std::size_t i = 0; i < drive.truth.size(); ++i) {
    const Pose2<double>& t = drive.truth[i];
    drive.graph.set_value(drive.poses[i], std::array{t.position[0], t.position[1], t.heading});
  }
  const std::size_t last = drive.graph.batch_count() - 1;
  REQUIRE(drive.graph.edge_type(last).tag == "EDGE_SE2");
  return drive.graph.batch(last).chi2(drive.graph.view());
}

}  // namespace

TEST_CASE("loop_closure: the measured pose is moved from the readings' moments to the nodes") {
  // 20 ms after a node and 30 ms before one, on a curve: 0.2 m and 0.3 m beside them. A sensor 2 m ahead that
  // looks to the left sees the motion of its own frame.
  KitRecipe recipe = two_laps();
  recipe.seconds = 5;
  recipe.noise = {1e-9, 1e-9, 1e-9, 0, 1e-12, 1};
  const KitDrive drive = make_kit_drive(recipe, 1);
  const Pose2<double> from = truth_at(drive, 1.02);
  const Pose2<double> to = truth_at(drive, 3.97);
  const Pose2<double> mount(2, 0.5, std::numbers::pi / 2);
  const Options mounted = {{"mount_x", "2"}, {"mount_y", "0.5"}, {"mount_deg", "90"}};
  const Pose2<double> seen = between(compose(from, mount), compose(to, mount));
  Readings forward("loop_closure");
  add(forward, 1.02, 3.97, seen);
  CHECK(chi2_at_truth(drive, forward.table(), mounted) < 1e-4);
  Readings backward("loop_closure");  // to an earlier time
  add(backward, 3.97, 1.02, inverse(seen));
  CHECK(chi2_at_truth(drive, backward.table(), mounted) < 1e-4);
  CHECK(chi2_at_truth(drive, forward.table(), {}) > 1e3);

  // Its accuracy moves with it: an error of the matcher has the weight that the matcher stated.
  for (const Eigen::Vector3d& off : {Eigen::Vector3d(0.05, 0, 0), Eigen::Vector3d(0, 0, 0.003)}) {
    Readings wrong("loop_closure");
    add(wrong, 1.02, 3.97, compose(seen, se2_exp<double>(off)));
    CHECK(chi2_at_truth(drive, wrong.table(), mounted) == Approx(1).epsilon(0.02));
  }
}

TEST_CASE("loop_closure: a second lap without GNSS is tied to the first") {
  constexpr int kSeeds = 20;
  double squared_without = 0;
  double squared_with = 0;
  double normalised = 0;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    KitDrive without = make_kit_drive(two_laps(), seed);
    KitDrive with = without;
    Noise noise(4000 + seed);
    Readings readings("loop_closure");
    const Eigen::Vector3d sigmas(kSigma, kSigma, kSigmaHeading);
    for (int t = kLap; t < 2 * kLap; ++t) {
      const Eigen::Vector3d error = noise(Eigen::Matrix3d(sigmas.cwiseAbs2().asDiagonal()));
      const Pose2<double> seen = between(truth_at(with, t), truth_at(with, t - kLap));
      add(readings, t, t - kLap, compose(seen, se2_exp<double>(error)));
    }
    with.add_sensor("loop_closure", readings.table());
    const Solution before = solve(without);
    const Solution after = solve(with);
    squared_without += std::pow(before.rms_position(), 2);
    squared_with += std::pow(after.rms_position(), 2);
    normalised += after.normalised(kLap * kNodesPerSecond);
    // p(30 s) = p(0) - R z: known as well as where the drive began, plus the match, plus the effect of
    // headings on the way z between the two, which covers the truth's own drift over a lap.
    constexpr int kNode = kLap * kNodesPerSecond;
    const double z = (with.truth[kNode].position - with.truth[0].position).norm();
    for (const int axis : {0, 1}) {
      const double begin = after.sigma(0, axis) + z * after.sigma(0, 2);
      const double bound = begin * begin + kSigma * kSigma + std::pow(z * kSigmaHeading, 2);
      CHECK(std::pow(after.sigma(kNode, axis), 2) < 1.01 * bound);
      CHECK(before.sigma(kNode, axis) > 2 * std::sqrt(bound));
    }
  }
  CHECK(squared_with < squared_without / 9);
  check_mean_chi_square(normalised, 3, kSeeds);
}

TEST_CASE("loop_closure: rows outside the drive are left out, a match of a node with itself is an error") {
  KitRecipe recipe = two_laps();
  recipe.seconds = 5;
  KitDrive drive = make_kit_drive(recipe, 1);
  Readings outside("loop_closure");
  add(outside, 4, 9, {});
  drive.add_sensor("loop_closure", outside.table());
  CHECK(edges_of(drive.graph, "EDGE_SE2") == 0);
  Readings itself("loop_closure");
  add(itself, 1.01, 1.03, {});
  CHECK_THROWS_WITH(drive.add_sensor("loop_closure", itself.table()),
                    Contains("row 1 (time 1001.01): column 'dt': both poses fall on one node of the drive"));
  Readings endless("loop_closure");
  add(endless, 1, 1e9, {});
  CHECK_THROWS_WITH(drive.add_sensor("loop_closure", endless.table()),
                    Contains("column 'dt': must lie in [-1e+07, 1e+07], got 999999999"));
}

}  // namespace kit_loop_closure_test
