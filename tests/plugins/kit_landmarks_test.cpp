// Sensor kit: landmarks by x and y, by range and bearing, on a map or not.
#include <numbers>

#include <waymark/core/base/error.hpp>
#include <waymark/plugins/landmarks/landmarks.hpp>

#include "plugins/kit_drive.hpp"

namespace kit_landmarks_test {

using namespace waymark;
using namespace waymark::plugins::landmarks;
using namespace waymark_test;
using Catch::Contains;

namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kSigma = 0.1;
constexpr double kSigmaBearing = 0.005;
constexpr int kLandmarks = 12;

/// Two laps of 300 m among landmarks; fixes in the first five seconds only.
KitRecipe two_laps() {
  KitRecipe recipe;
  recipe.motion = [](double) { return Eigen::Vector2d(10, 2 * kPi / 30); };
  recipe.noise = {1e-4, 1e-4, 1e-5, 0, 1e-4, 1};
  recipe.last_fix_s = 5;
  recipe.fix_sigma_m = 0.5;
  return recipe;
}

/// Evenly round the lap's true centre, outside of it.
Eigen::Vector2d landmark(const KitDrive& drive, int id) {
  const Pose2<double>& first = drive.truth[0];
  const Eigen::Vector2d centre = first.position + rotate(first.heading, Eigen::Vector2d(0, 300 / (2 * kPi)));
  return centre + rotate(2 * kPi * id / kLandmarks, Eigen::Vector2d(60, 0));
}

/// The landmarks seen within 40 m, once a second, by a sensor at the body point.
SensorTable sightings(const KitDrive& drive, bool polar, bool on_map, Noise& noise) {
  Readings readings("landmarks");
  for (std::size_t i = 0; i < drive.truth.size(); i += kNodesPerSecond) {
    for (int id = 0; id < kLandmarks; ++id) {
      const Pose2<double>& pose = drive.truth[i];
      const Eigen::Vector2d place = landmark(drive, id);
      const Eigen::Vector2d seen = rotate_back(pose.heading, Eigen::Vector2d(place - pose.position));
      if (seen.norm() > 40) continue;
      std::map<std::string, double> row = {{"id", id}, {"sigma", kSigma}};
      if (polar) {
        row["range"] = seen.norm() + noise(kSigma);
        row["bearing"] = std::atan2(seen[1], seen[0]) + noise(kSigmaBearing);
        row["sigma_bearing"] = kSigmaBearing;
      } else {
        row["x"] = seen[0] + noise(kSigma);
        row["y"] = seen[1] + noise(kSigma);
      }
      if (on_map) {
        row["map_x"] = place[0];
        row["map_y"] = place[1];
      }
      readings.add(drive.stamps[i], row);
    }
  }
  return readings.table();
}

/// A drive of two nodes about the pose (10, 20) heading north, for readings by hand.
KitDrive heading_north() {
  KitRecipe recipe;
  recipe.seconds = 1;
  KitDrive drive = make_kit_drive(recipe, 1);
  drive.graph.set_value(drive.poses[5], std::array{10.0, 20.0, kPi / 2});
  return drive;
}

std::string error_of(const std::map<std::string, double>& row) {
  KitDrive drive = heading_north();
  Readings readings("landmarks");
  readings.add(kit_stamp(0.5), row);
  try {
    drive.add_sensor("landmarks", readings.table());
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

}  // namespace

TEST_CASE("landmarks: forward is along the heading, left is positive, also for the bearing") {
  // From (10, 20) heading north, (8, 23) lies 3 m ahead and 2 m to the left.
  const Pose2<double> pose(10, 20, kPi / 2);
  const Eigen::Vector2d place(8, 23);
  const EdgeSe2XyRangeBearing edge{{std::sqrt(13.0), std::atan2(2.0, 3.0)}, {0, 0}};
  CHECK(edge.error(pose, place).norm() < 1e-14);
  // A sensor 1 m ahead sees it 2 m ahead and 2 m to the left.
  const EdgeSe2XyRangeBearing ahead{{std::sqrt(8.0), kPi / 4}, {1, 0}};
  CHECK(ahead.error(pose, place).norm() < 1e-14);
  // Measured 1 m too short and 0.1 rad too far to the right.
  const EdgeSe2XyRangeBearing off{{std::sqrt(13.0) - 1, std::atan2(2.0, 3.0) - 0.1}, {0, 0}};
  CHECK((off.error(pose, place) - Eigen::Vector2d(1, 0.1)).norm() < 1e-14);
  // Behind the vehicle a bearing may be told as either 181 or -179 degrees.
  const EdgeSe2XyRangeBearing behind{{5, 181 * kPi / 180}, {0, 0}};
  CHECK(behind.error(pose, Eigen::Vector2d(10, 15))[1] == Approx(-kPi / 180));
}

TEST_CASE("landmarks: a first sight places the landmark, and the mounting counts") {
  // A sensor 1 m ahead that looks to the left: a point 2 m to the vehicle's left is ahead of it, a point
  // further forward is to its right.
  for (const bool polar : {true, false}) {
    KitDrive drive = heading_north();
    Readings readings("landmarks");
    if (polar) {
      readings.add(kit_stamp(0.5), {{"id", 7}, {"range", std::sqrt(8.0)}, {"bearing", -kPi / 4}});
    } else {
      readings.add(kit_stamp(0.5), {{"id", 7}, {"x", 2}, {"y", -2}});
    }
    drive.add_sensor("landmarks", readings.table(), {{"mount_x", "1"}, {"mount_deg", "90"}});
    const VertexIndex v = find_state(drive.graph, "VERTEX_XY");
    REQUIRE(v >= 0);
    CHECK(drive.graph.value(v)[0] == Approx(8));
    CHECK(drive.graph.value(v)[1] == Approx(23));
    CHECK(drive.graph.batch(drive.graph.batch_count() - 1).chi2(drive.graph.view()) < 1e-20);
    CHECK_FALSE(drive.graph.fixed(v));
  }
}

TEST_CASE("landmarks: seen again on the second lap they hold a drive without GNSS") {
  for (const bool polar : {true, false}) {
    INFO((polar ? "range and bearing" : "x and y"));
    constexpr int kSeeds = 20;
    double squared_without = 0;
    double squared_with = 0;
    double pose = 0;
    double point = 0;
    for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
      KitDrive without = make_kit_drive(two_laps(), seed);
      KitDrive with = without;
      Noise noise(5000 + seed);
      with.add_sensor("landmarks", sightings(with, polar, false, noise));
      REQUIRE(with.graph.vertex_count() == without.graph.vertex_count() + kLandmarks);
      const Solution before = solve(without);
      const Solution after = solve(with);
      squared_without += std::pow(before.rms_position(), 2);
      squared_with += std::pow(after.rms_position(), 2);
      pose += after.normalised(kNodesPerSecond * 30);
      // The first landmark in the log is the first vertex.
      const VertexIndex v = find_state(with.graph, "VERTEX_XY");
      const auto value = with.graph.value(v);
      double nearest = 1e9;
      Eigen::Vector2d error(0, 0);
      for (int id = 0; id < kLandmarks; ++id) {
        const Eigen::Vector2d off = Eigen::Vector2d(value[0], value[1]) - landmark(with, id);
        if (off.norm() < nearest) error = off;
        nearest = std::min(nearest, off.norm());
      }
      const Eigen::Matrix2d covariance = marginal_covariances(with.graph, std::array{v})[0];
      point += error.dot(covariance.llt().solve(error));
    }
    CHECK(squared_with < squared_without / 9);
    check_mean_chi_square(pose, 3, kSeeds);
    check_mean_chi_square(point, 2, kSeeds);
  }
}

TEST_CASE("landmarks: an error of the map counts once, however often its landmark is seen") {
  constexpr double kMapSigma = 0.5;
  constexpr int kSeeds = 20;
  double normalised = 0;
  double normalised_as_exact = 0;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    KitDrive drive = make_kit_drive(two_laps(), seed);
    KitDrive exact = drive;
    Noise noise(7000 + seed);
    SensorTable readings = sightings(drive, false, true, noise);
    std::map<int, Eigen::Vector2d> errors;
    for (std::size_t row = 0; row < readings.size(); ++row) {
      double* values = &readings.values[row * readings.columns];
      const auto [error, is_new] = errors.try_emplace(static_cast<int>(values[0]));
      if (is_new) error->second = {noise(kMapSigma), noise(kMapSigma)};
      values[readings.columns - 2] += error->second[0];  // map_x, map_y
      values[readings.columns - 1] += error->second[1];
    }
    drive.add_sensor("landmarks", readings, {{"map_sigma", "0.5"}});
    exact.add_sensor("landmarks", readings, {{"map_sigma", "0"}});
    CHECK_FALSE(drive.graph.fixed(find_state(drive.graph, "VERTEX_XY")));
    normalised += solve(drive).normalised(kNodesPerSecond * 30);
    normalised_as_exact += solve(exact).normalised(kNodesPerSecond * 30);
  }
  check_mean_chi_square(normalised, 3, kSeeds);
  CHECK(normalised_as_exact > 4 * normalised);
}

TEST_CASE("landmarks: on a map they place the vehicle to their own accuracy") {
  constexpr int kSeeds = 20;
  double squared = 0;
  double normalised = 0;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    KitDrive drive = make_kit_drive(two_laps(), seed);
    Noise noise(6000 + seed);
    drive.add_sensor("landmarks", sightings(drive, false, true, noise), {{"map_sigma", "0"}});
    const Solution solution = solve(drive);
    squared += std::pow(solution.rms_position(), 2);
    normalised += solution.normalised(kNodesPerSecond * 30);
    // At least two landmarks are in sight: no worse than one of them, per axis.
    CHECK(solution.sigma(kNodesPerSecond * 50, 0) < kSigma);
    CHECK(solution.sigma(kNodesPerSecond * 50, 1) < kSigma);
    CHECK(drive.graph.fixed(find_state(drive.graph, "VERTEX_XY")));
  }
  CHECK(std::sqrt(squared / kSeeds) < std::sqrt(2) * kSigma);
  check_mean_chi_square(normalised, 3, kSeeds);
}

TEST_CASE("landmarks: rows that make no sense are named by row and column") {
  const std::string place = "row 1 (time 1000.5): column ";
  CHECK(error_of({{"id", 1.5}, {"x", 1}, {"y", 1}}) == place + "'id': expected a whole number, got 1.5");
  CHECK(error_of({{"id", 1}}) == place + "'x': no value: give x and y, or range and bearing");
  CHECK(error_of({{"id", 1}, {"x", 1}}) == place + "'y': no value: x and y go together");
  CHECK(error_of({{"id", 1}, {"range", 1}}) == place + "'bearing': no value: range and bearing go together");
  CHECK(error_of({{"id", 1}, {"bearing", 1}}) == place + "'range': no value: range and bearing go together");
  CHECK(error_of({{"id", 1}, {"range", -1}, {"bearing", 1}}) == place + "'range': must be above 0, got -1");
  CHECK(error_of({{"id", 1}, {"x", 1}, {"y", 1}, {"range", 1}, {"bearing", 1}}) ==
        place + "'range': give x and y, or range and bearing, not both");
  CHECK(error_of({{"id", 1}, {"x", 1}, {"y", 1}, {"map_x", 1}}) ==
        place + "'map_y': map_x and map_y go together");
  CHECK(error_of({{"id", 1}, {"x", 1}, {"y", -1e8}}) ==
        place + "'y': must lie in [-1e+07, 1e+07], got -1e+08");
  CHECK(error_of({{"id", 1}, {"x", 1}, {"y", 1}, {"sigma", 0}}) ==
        place + "'sigma': a sigma must lie in [1e-9, 1e9], got 0");
}

}  // namespace kit_landmarks_test
