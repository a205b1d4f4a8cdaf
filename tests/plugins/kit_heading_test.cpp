// Sensor kit: absolute headings, plain and with a deviation to be estimated.
#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

#include <waymark/core/base/error.hpp>
#include <waymark/plugins/heading/heading.hpp>

#include "plugins/kit_drive.hpp"

namespace kit_heading_test {

using namespace waymark;
using namespace waymark::plugins::heading;
using namespace waymark_test;
using Catch::Contains;

namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kDegree = kPi / 180;
constexpr double kSigma = 1 * kDegree;

/// Fixes of 10 m: on 600 m they give a heading to half a degree.
KitRecipe coarse_fixes() {
  KitRecipe recipe;
  recipe.fix_sigma_m = 10;
  return recipe;
}

/// A reading a second, 30 ms after a node.
SensorTable readings_of(const KitDrive& drive, double offset, Noise& noise) {
  Readings readings("heading");
  for (std::size_t i = 0; i + 1 < drive.truth.size(); i += kNodesPerSecond) {
    const double at_reading = drive.truth[i].heading + 0.03 * drive.intervals[i].yaw_rate_radps;
    readings.add(Stamp{drive.stamps[i].nanoseconds + 30'000'000},
                 {{"heading", wrap_angle(at_reading + offset + noise(kSigma))}});
  }
  return readings.table();
}

}  // namespace

TEST_CASE("heading: the error is heading minus reading, by the shorter way") {
  // 3.0 and -3.0 rad are 2 pi - 6 = 0.283 rad apart; the pose is clockwise of the reading.
  CHECK(EdgeHeading{-3.0}.error(Pose2<double>(1, 2, 3.0))[0] == Approx(6 - 2 * kPi));
  // A sensor that reads 0.2 more than the heading 0.5.
  CHECK(EdgeHeadingOffset{0.7}.error(Pose2<double>(1, 2, 0.5), 0.2)[0] == Approx(0).margin(1e-15));
  CHECK(EdgeHeadingOffset{0.7}.error(Pose2<double>(1, 2, 0.5), 0.0)[0] == Approx(-0.2));
}

TEST_CASE("heading: mounting is subtracted, and the turn from the node to the reading") {
  // A baseline that points to the left, turning left by 0.5 rad/s; 30 ms after the node at 0.1 s, whose
  // heading is 0.4 + 0.05, it reads 0.45 + 0.015 + pi/2; 20 ms before the node it reads 0.01 less.
  KitRecipe recipe;
  recipe.seconds = 1;
  recipe.motion = [](double) { return Eigen::Vector2d(10, 0.5); };
  for (const double ahead : {0.03, -0.02}) {
    KitDrive drive = make_kit_drive(recipe, 1);
    Readings readings("heading");
    readings.add(kit_stamp(0.1 + ahead), {{"heading", 0.45 + 0.5 * ahead + kPi / 2}});
    drive.add_sensor("heading", readings.table(), {{"mount_deg", "90"}, {"offset", "off"}});
    const std::size_t batch = drive.graph.batch_count() - 1;
    REQUIRE(drive.graph.edge_type(batch).tag == "EDGE_HEADING");
    std::vector<double> fields;
    drive.graph.batch(batch).fields(0, fields);
    CHECK(fields[0] == Approx(0.45));
    CHECK(drive.graph.batch(batch).vertices(0)[0] == drive.poses[1]);
    CHECK(drive.graph.batch(batch).information(0)(0, 0) == Approx(1 / (kDegree * kDegree)));
  }
}

TEST_CASE("heading: n readings add n / sigma^2 to the information on a stiff drive's heading") {
  constexpr int kSeeds = 40;
  double squared_without = 0;
  double squared_with = 0;
  double normalised = 0;
  double gain = 0;
  for (int seed = 1; seed <= kSeeds; ++seed) {
    KitDrive without = make_kit_drive(coarse_fixes(), static_cast<std::uint64_t>(seed));
    KitDrive with = without;
    Noise noise(static_cast<std::uint64_t>(1000 + seed));
    with.add_sensor("heading", readings_of(with, 0, noise), {{"offset", "off"}});
    const double n = static_cast<double>(edges_of(with.graph, "EDGE_HEADING"));
    REQUIRE(n == 60);
    const Solution before = solve(without);
    const Solution after = solve(with);
    const double expected = std::pow(before.sigma(300, 2), -2) + n / (kSigma * kSigma);
    CHECK(std::pow(after.sigma(300, 2), -2) == Approx(expected).epsilon(0.02));
    gain = before.sigma(300, 2) / after.sigma(300, 2);
    squared_without += std::pow(before.rms_heading(), 2);
    squared_with += std::pow(after.rms_heading(), 2);
    normalised += after.normalised(300);
  }
  CHECK(gain > 3);
  CHECK(std::sqrt(squared_without / squared_with) == Approx(gain).epsilon(0.5));
  check_mean_chi_square(normalised, 3, kSeeds);
}

TEST_CASE("heading: a compass with 8 degrees of deviation, which the drive finds out") {
  constexpr double kDeviation = 8 * kDegree;
  constexpr int kSeeds = 40;
  double normalised = 0;
  double state = 0;
  for (int seed = 1; seed <= kSeeds; ++seed) {
    KitDrive without = make_kit_drive(coarse_fixes(), static_cast<std::uint64_t>(seed));
    KitDrive believed = without;
    KitDrive estimated = without;
    Noise noise(static_cast<std::uint64_t>(2000 + seed));
    const SensorTable readings = readings_of(without, kDeviation, noise);
    believed.add_sensor("heading", readings, {{"offset", "off"}});
    estimated.add_sensor("heading", readings, {{"offset", "constant"}, {"offset_sigma_deg", "20"}});
    const Solution before = solve(without);
    const Solution after = solve(estimated);
    // Believed, the compass turns the drive; with its deviation estimated it does no harm.
    CHECK(solve(believed).rms_heading() > 5 * kDegree);
    CHECK(after.rms_heading() < 2 * kDegree);
    normalised += after.normalised(300);

    // The readings' mean minus the heading: the variances add.
    const VertexIndex offset = find_state(estimated.graph, "VERTEX_HEADING_OFFSET");
    const double variance = marginal_covariances(estimated.graph, std::array{offset})[0](0, 0);
    CHECK(variance == Approx(std::pow(before.sigma(300, 2), 2) + kSigma * kSigma / 60).epsilon(0.02));
    const double error = estimated.graph.value(offset)[0] - kDeviation;
    state += error * error / variance;
  }
  check_mean_chi_square(normalised, 3, kSeeds);
  check_mean_chi_square(state, 1, kSeeds);
}

TEST_CASE("heading: what wanders for 20 seconds is a state, and does not count as often as it is read") {
  constexpr double kWander = 4 * kDegree;
  constexpr double kTime_s = 20;
  constexpr int kSeeds = 40;
  double normalised = 0;
  double normalised_as_constant = 0;
  KitRecipe recipe = coarse_fixes();
  recipe.noise.heading_per_s = 1e-4;  // a poor gyro: what the compass says counts
  for (int seed = 1; seed <= kSeeds; ++seed) {
    KitDrive wandering = make_kit_drive(recipe, static_cast<std::uint64_t>(seed));
    KitDrive constant = wandering;
    Noise noise(static_cast<std::uint64_t>(3000 + seed));
    SensorTable readings = readings_of(wandering, 0, noise);
    double wander = noise(kWander);
    const double decay = std::exp(-1 / kTime_s);
    for (double& value : readings.values) {
      if (std::isnan(value)) continue;
      value = wrap_angle(value + wander);
      wander = decay * wander + noise(kWander * std::sqrt(1 - decay * decay));
    }
    constant.add_sensor("heading", readings, {{"offset", "constant"}});
    wandering.add_sensor("heading", readings, {{"wander_sigma_deg", "4"}, {"wander_time", "20"}});
    CHECK(edges_of(wandering.graph, "EDGE_HEADING_WANDERING") == 60);
    CHECK(edges_of(wandering.graph, "EDGE_HEADING_WANDER_DECAY") == 59);
    normalised += solve(wandering).normalised(300);
    normalised_as_constant += solve(constant).normalised(300);
  }
  check_mean_chi_square(normalised, 3, kSeeds);
  CHECK(normalised_as_constant > 2 * normalised);
}

TEST_CASE("heading: readings that come in disorder have the process of those in order") {
  KitDrive ordered = make_kit_drive(coarse_fixes(), 1);
  KitDrive disordered = ordered;
  Noise noise(7);
  const SensorTable readings = readings_of(ordered, 0.05, noise);
  SensorTable reversed = readings;
  std::reverse(reversed.stamps.begin(), reversed.stamps.end());
  for (std::size_t row = 0; row < readings.size(); ++row)
    for (std::size_t column = 0; column < readings.columns; ++column)
      reversed.values[row * readings.columns + column] = readings.at(readings.size() - 1 - row, column);
  ordered.add_sensor("heading", readings);
  disordered.add_sensor("heading", reversed);
  const Solution one = solve(ordered);
  const Solution other = solve(disordered);
  for (const int node : {0, 300, 600}) {
    CHECK(other.errors[static_cast<std::size_t>(node)][2] ==
          Approx(one.errors[static_cast<std::size_t>(node)][2]).margin(1e-7));
    CHECK(other.sigma(node, 2) == Approx(one.sigma(node, 2)).epsilon(1e-6));
  }
}

TEST_CASE("heading: rows that make no sense are named, those outside the drive or in a gap left out") {
  KitRecipe recipe;
  recipe.seconds = 1;
  KitDrive drive = make_kit_drive(recipe, 1);
  Readings readings("heading");
  readings.add(kit_stamp(-5), {{"heading", 0}});
  readings.add(kit_stamp(0.5), {{"heading", 0}, {"sigma", -0.1}});
  CHECK_THROWS_WITH(drive.add_sensor("heading", readings.table()),
                    "row 2 (time 1000.5): column 'sigma': a sigma must lie in [1e-9, 1e9], got -0.1");
  Readings outside("heading");
  outside.add(kit_stamp(-5), {{"heading", 0}});
  outside.add(kit_stamp(8), {{"heading", 0}});
  drive.add_sensor("heading", outside.table());
  CHECK(edges_of(drive.graph, "EDGE_HEADING") == 0);
  CHECK_THROWS_WITH(registry().make_sensor_model("heading", {{"offset", "maybe"}}),
                    "heading: option 'offset' must be 'wandering' or 'constant' or 'off', got 'maybe'");
  CHECK_THROWS_WITH(registry().make_sensor_model("heading", {{"mounting", "3"}}),
                    Contains("heading: unknown option 'mounting'; did you mean 'mount_deg'?"));
}

TEST_CASE(
    "heading: a compass that counts the other way round is refused before the drive, and no other one is") {
  // Bends of 86 degrees to either side, five seconds each, at 10 m/s, with fixes of 2 m; then as much in reverse.
  std::vector<Fix> fixes;
  std::vector<double> headings;
  Noise noise(5);
  Eigen::Vector2d place(0, 0);
  double heading = 0.4;
  for (int second = 0; second < 400; ++second) {
    const double speed = second < 200 ? 10 : -10;
    const bool bends = second % 20 < 5 || (second % 20 >= 10 && second % 20 < 15);
    heading = wrap_angle(heading + (bends ? (second % 60 < 30 ? 0.3 : -0.3) : 0.0));
    place += speed * Eigen::Vector2d(std::cos(heading), std::sin(heading));
    Fix fix;
    fix.stamp = kit_stamp(second);
    fix.position = place + Eigen::Vector2d(noise(2), noise(2));
    fix.covariance = 4 * Eigen::Matrix2d::Identity();
    fixes.push_back(fix);
    headings.push_back(heading);
  }
  const auto readings_with = [&](const std::function<double(double)>& reading) {
    Readings readings("heading");
    for (std::size_t i = 0; i < fixes.size(); ++i)
      readings.add(fixes[i].stamp, {{"heading", wrap_angle(reading(headings[i]) + noise(3 * kDegree))}});
    return readings.table();
  };
  const auto compass = registry().make_sensor_model("heading", {});
  CHECK_NOTHROW(compass->check_drive(fixes, readings_with([](double h) { return h; })));
  CHECK_NOTHROW(compass->check_drive(fixes, readings_with([](double h) { return h + 2; })));
  CHECK_NOTHROW(compass->check_drive(fixes, readings_with([](double) { return 0.7; })));  // it is dead
  CHECK_THROWS_WITH(compass->check_drive(fixes, readings_with([](double h) { return 0.5 * kPi - h; })),
                    Contains("the headings turn against the fixes") && Contains("'convention'"));
}

}  // namespace kit_heading_test
