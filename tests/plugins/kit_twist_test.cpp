// Sensor kit: twists of visual or lidar odometry.
#include <numbers>

#include <Eigen/LU>

#include <waymark/plugins/twist/edge_twist.hpp>

#include "plugins/kit_drive.hpp"

namespace kit_twist_test {

using namespace waymark;
using namespace waymark::plugins::twist;
using namespace waymark_test;
using Catch::Contains;

namespace {

constexpr double kDegree = std::numbers::pi / 180;
const Options kPlain = {{"scale", "off"}, {"yaw_rate_bias", "off"}};

/// Nodes and nothing between them.
struct BareDrive {
  Graph graph;
  std::vector<Stamp> stamps;
  std::vector<VertexIndex> poses;
  std::vector<Interval> intervals;

  explicit BareDrive(const std::vector<double>& seconds) {
    add_nodes(seconds);
    graph.set_fixed(poses.front(), true);
  }
  void add_nodes(const std::vector<double>& seconds) {
    for (const double t : seconds) {
      const Stamp stamp = kit_stamp(t);
      if (!stamps.empty()) intervals.push_back({0, 0, seconds_between(stamps.back(), stamp), false});
      stamps.push_back(stamp);
      poses.push_back(graph.add_vertex<VertexSe2>(graph.free_id(), {0, 0, 0}));
    }
  }
  void extend(SensorModel& model, const SensorTable& readings) {
    model.extend({{stamps, poses, intervals}, {}, {0, 0}, readings}, graph);
  }
  void add(const SensorTable& readings, const Options& options) {
    extend(*registry().make_sensor_model("twist", options), readings);
  }
  /// The last pose of the minimum, seen from the first.
  [[nodiscard]] Eigen::Vector3d end() {
    const Summary summary = optimize(graph, *registry().make_algorithm("dogleg"),
                                     *registry().make_linear_solver("block_cholesky"), {});
    INFO(summary.message);
    REQUIRE(summary.converged());
    const auto value = graph.value(poses.back());
    return {value[0], value[1], value[2]};
  }
};

std::vector<double> every(double step_s, double last_s) {
  std::vector<double> moments;
  for (int i = 0; i * step_s < last_s + 1e-9; ++i) moments.push_back(i * step_s);
  return moments;
}

/// A vehicle that changes its speed and its turns; velocities of the body point.
Eigen::Vector3d winding(double t) {
  return {8 + 3 * std::sin(t), 0, 0.4 * std::cos(1.7 * t)};
}

SensorTable table_of(const std::vector<double>& moments,
                     const std::function<Eigen::Vector3d(double)>& twist) {
  Readings readings("twist");
  for (const double t : moments) {
    const Eigen::Vector3d v = twist(t);
    readings.add(kit_stamp(t), {{"vx", v[0]}, {"vy", v[1]}, {"yaw_rate", v[2]}});
  }
  return readings.table();
}

std::vector<std::vector<double>> lines_of(const Graph& graph, std::string_view tag) {
  std::vector<std::vector<double>> lines;
  for (std::size_t b = 0; b < graph.batch_count(); ++b) {
    if (graph.edge_type(b).tag != tag) continue;
    for (std::size_t i = 0; i < graph.batch(b).size(); ++i) {
      std::vector<double>& line = lines.emplace_back();
      graph.batch(b).fields(i, line);
      for (const VertexIndex v : graph.batch(b).vertices(i)) line.push_back(static_cast<double>(v));
      const Eigen::MatrixXd information = graph.batch(b).information(i);
      line.insert(line.end(), information.data(), information.data() + information.size());
    }
  }
  return lines;
}

/// The pairs of stamps that edges of a type join, s.
std::vector<std::pair<double, double>> joined(const BareDrive& drive, std::string_view tag) {
  std::vector<std::pair<double, double>> pairs;
  const auto seconds = [&](VertexIndex v) {
    const auto node = std::find(drive.poses.begin(), drive.poses.end(), v) - drive.poses.begin();
    return seconds_between(kit_stamp(0), drive.stamps[static_cast<std::size_t>(node)]);
  };
  for (std::size_t b = 0; b < drive.graph.batch_count(); ++b) {
    if (drive.graph.edge_type(b).tag != tag) continue;
    for (std::size_t i = 0; i < drive.graph.batch(b).size(); ++i) {
      const auto vertices = drive.graph.batch(b).vertices(i);
      pairs.emplace_back(seconds(vertices[0]), seconds(vertices[1]));
    }
  }
  return pairs;
}

/// The rows [first, last) of a table.
SensorTable part_of(const SensorTable& table, std::size_t first, std::size_t last) {
  SensorTable part;
  part.columns = table.columns;
  for (std::size_t row = first; row < last; ++row) {
    part.stamps.push_back(table.stamps[row]);
    for (std::size_t c = 0; c < table.columns; ++c) part.values.push_back(table.at(row, c));
  }
  return part;
}

}  // namespace

TEST_CASE("twist: a circle is reproduced exactly, seen by a sensor that is mounted anywhere") {
  // The body drives an arc of radius 20 m for 10 s at 10 m/s. A sensor at (2, 0.5) that looks left
  // moves with the body's velocity plus w x r: (10 - 0.25, 1) in the body's axes.
  const double w = 0.5;
  const Eigen::Vector3d mounted(2 * w, -(10 - 0.5 * w), w);
  const Options mount = {{"mount_x", "2"}, {"mount_y", "0.5"}, {"mount_deg", "90"}};
  for (const char* state : {"off", "constant"}) {
    Options options = mount;
    options["scale"] = options["yaw_rate_bias"] = state;
    BareDrive drive(every(0.1, 10));
    drive.add(table_of(every(0.1, 10), [&](double) { return mounted; }), options);
    const Eigen::Vector3d end = drive.end();
    CHECK(end[0] == Approx(20 * std::sin(5)).margin(1e-6));
    CHECK(end[1] == Approx(20 * (1 - std::cos(5))).margin(1e-6));
    CHECK(end[2] == Approx(5 - 2 * std::numbers::pi).margin(1e-7));
  }
}

TEST_CASE("twist: one interval has the variance dt^2 sigma^2, at the sensor") {
  BareDrive drive({0, 0.2});
  Readings readings("twist");
  for (const double t : {0.0, 0.2})
    readings.add(kit_stamp(t),
                 {{"vx", 0}, {"vy", 0}, {"yaw_rate", 0}, {"sigma_v", 0.3}, {"sigma_yaw_rate", 0.02}});
  Options options = kPlain;
  options["mount_x"] = "5";
  drive.add(readings.table(), options);
  const Eigen::Matrix3d covariance = drive.graph.batch(0).information(0).inverse();
  // An error of the turn is one about the sensor, and moves the body 5 m behind it sideways.
  CHECK(covariance(0, 0) == Approx(std::pow(0.2 * 0.3, 2)));
  CHECK(covariance(2, 2) == Approx(std::pow(0.2 * 0.02, 2)));
  CHECK(covariance(1, 1) == Approx(std::pow(0.2 * 0.3, 2) + 25 * std::pow(0.2 * 0.02, 2)));
  CHECK(covariance(1, 2) == Approx(-5 * std::pow(0.2 * 0.02, 2)));
}

TEST_CASE("twist: a missing vy is 0 with a sigma of its own, and not for a sensor that moves sideways") {
  BareDrive drive({0, 1});
  Readings readings("twist");
  for (const double t : {0.0, 1.0})
    readings.add(kit_stamp(t), {{"vx", 0}, {"yaw_rate", 0}, {"sigma_v", 0.3}});
  Options options = kPlain;
  options["sigma_vy"] = "0.02";
  drive.add(readings.table(), options);
  const Eigen::Matrix3d information = drive.graph.batch(0).information(0);
  CHECK(information(0, 0) == Approx(1 / (0.3 * 0.3)));
  CHECK(information(1, 1) == Approx(1 / (0.02 * 0.02)));
  for (const Options& turned : {Options{{"mount_x", "1"}}, Options{{"mount_deg", "30"}}})
    CHECK_THROWS_WITH(drive.add(readings.table(), turned),
                      Contains("row 1 (time 1000): column 'vy': is missing"));
  CHECK_NOTHROW(drive.add(readings.table(), {{"mount_y", "1"}, {"mount_deg", "180"}}));
}

TEST_CASE("twist: a source denser than the nodes loses nothing") {
  // 50 rows a second. The nodes are at its rows, or five times rarer and beside them.
  const SensorTable readings = table_of(every(0.02, 10), winding);
  std::vector<double> beside = {0};
  for (double t = 0.013; t < 10; t += 0.1) beside.push_back(t);
  beside.push_back(10);
  for (const char* state : {"off", "constant"}) {
    const Options options = {{"scale", state}, {"yaw_rate_bias", state}, {"mount_x", "1"}};
    BareDrive fine(every(0.02, 10));
    BareDrive coarse(beside);
    fine.add(readings, options);
    coarse.add(readings, options);
    CHECK((fine.end() - coarse.end()).norm() < 1e-6);
    // The covariances compose too: the end is known equally well.
    const auto last = [](BareDrive& drive) {
      return Eigen::Matrix3d(marginal_covariances(drive.graph, std::array{drive.poses.back()})[0]);
    };
    const Eigen::Matrix3d expected = last(fine);
    CHECK((last(coarse) - expected).norm() < 1e-2 * expected.norm());
  }
}

TEST_CASE("twist: a source sparser than the nodes joins one node per row") {
  BareDrive drive(every(0.1, 3));
  drive.add(table_of({0.03, 0.96, 1.92, 2.87}, winding), kPlain);
  const auto pairs = joined(drive, "EDGE_SE2_LOG");
  REQUIRE(pairs.size() == 3);
  // From the first node after the first row to the last one before each row.
  CHECK(pairs[0].first == Approx(0.1));
  CHECK(pairs[0].second == Approx(0.9));
  CHECK(pairs[1].second == Approx(1.9));
  CHECK(pairs[2].second == Approx(2.8));
  for (std::size_t i = 1; i < 3; ++i) CHECK(pairs[i].first == pairs[i - 1].second);
}

TEST_CASE("twist: the source drives on through a gap without nodes") {
  std::vector<double> moments = every(0.1, 2);
  for (double t = 8; t < 9.95; t += 0.1) moments.push_back(t);
  BareDrive gap(moments);
  BareDrive full(every(0.1, 9.9));
  const SensorTable readings = table_of(every(0.1, 9.9), winding);
  gap.add(readings, {});
  full.add(readings, {});
  CHECK((gap.end() - full.end()).norm() < 1e-6);

  // A bias turns each part of the way through the gap as it turns the whole: exact to first order.
  constexpr double kBias = 0.002;
  const VertexIndex gap_bias = find_state(gap.graph, "VERTEX_TWIST_BIAS");
  const VertexIndex full_bias = find_state(full.graph, "VERTEX_TWIST_BIAS");
  const Eigen::Vector3d straight = full.end();
  for (auto [drive, bias] : {std::pair{&gap, gap_bias}, std::pair{&full, full_bias}}) {
    drive->graph.set_value(bias, std::array{kBias});
    drive->graph.set_fixed(bias, true);
  }
  const Eigen::Vector3d bent = full.end();
  CHECK((bent - straight).norm() > 0.1);
  CHECK((gap.end() - bent).norm() < 1e-3);
}

TEST_CASE("twist: a silence of the source leaves no edge") {
  std::vector<double> moments = every(0.1, 2);
  for (double t = 4.05; t < 6; t += 0.1) moments.push_back(t);
  BareDrive drive(every(0.1, 6));
  drive.add(table_of(moments, winding), kPlain);
  const auto pairs = joined(drive, "EDGE_SE2_LOG");
  REQUIRE(pairs.size() == 20 + 18);
  CHECK(pairs[19].second == Approx(2.0));
  CHECK(pairs[20].first == Approx(4.1));
  BareDrive patient(every(0.1, 6));
  Options options = kPlain;
  options["longest"] = "3";
  patient.add(table_of(moments, winding), options);
  CHECK(joined(patient, "EDGE_SE2_LOG").size() == 20 + 1 + 19);  // one edge from 2.0 to 4.0 s
}

TEST_CASE("twist: rows split over two calls give the same edges") {
  const SensorTable readings = table_of(every(0.03, 5), winding);
  for (const char* state : {"off", "constant", "random_walk"}) {
    const Options options = {{"scale", state}, {"yaw_rate_bias", state}, {"calibration_period", "1"}};
    BareDrive whole(every(0.1, 5));
    whole.add(readings, options);
    for (const std::size_t split : {1U, 50U, 53U, 166U}) {
      BareDrive parts(every(0.1, 5));
      const auto model = registry().make_sensor_model("twist", options);
      parts.extend(*model, part_of(readings, 0, split));
      parts.extend(*model, part_of(readings, split, readings.size()));
      for (const char* tag : {"EDGE_SE2_TWIST", "EDGE_SE2_LOG", "EDGE_TWIST_BIAS_WALK"})
        CHECK(lines_of(parts.graph, tag) == lines_of(whole.graph, tag));
    }
  }
}

TEST_CASE("twist: rows that come before their nodes wait for the next ones") {
  const SensorTable readings = table_of(every(0.02, 10), winding);
  BareDrive whole(every(0.1, 10));
  whole.add(readings, {});
  BareDrive growing(every(0.1, 4));
  const auto model = registry().make_sensor_model("twist", {});
  growing.extend(*model, part_of(readings, 0, 216));  // up to 4.3 s
  std::vector<double> more;
  for (int i = 41; i <= 100; ++i) more.push_back(0.1 * i);
  growing.add_nodes(more);
  growing.extend(*model, part_of(readings, 216, readings.size()));
  const auto pairs = joined(growing, "EDGE_SE2_TWIST");
  REQUIRE(pairs.size() == 100 - 2);
  CHECK(pairs[40].first == Approx(4.0));
  CHECK(pairs[40].second == Approx(4.3));
  CHECK((growing.end() - whole.end()).norm() < 1e-6);
}

TEST_CASE("twist: a way begins anew if the node where it began has left the graph") {
  const SensorTable readings = table_of(every(0.02, 2), winding);
  BareDrive drive(every(0.1, 1));
  const auto model = registry().make_sensor_model("twist", kPlain);
  drive.extend(*model, part_of(readings, 0, 53));  // up to 1.04 s
  BareDrive window({1.1, 1.2, 1.3, 2});            // other ids, as of a graph whose first vertices left
  window.graph = Graph();
  for (std::size_t i = 0; i < window.poses.size(); ++i)
    window.poses[i] = window.graph.add_vertex<VertexSe2>(VertexId(100 + static_cast<int>(i)), {0, 0, 0});
  window.extend(*model, part_of(readings, 53, readings.size()));
  const auto pairs = joined(window, "EDGE_SE2_LOG");
  REQUIRE(pairs.size() == 3);
  CHECK(pairs[0].first == Approx(1.1));
  CHECK(pairs[2].second == Approx(2.0));
}

TEST_CASE("twist: scale and bias are found by a drive with good fixes, as well as they claim") {
  constexpr int kSeeds = 30;
  constexpr double kScale = 0.03;
  constexpr double kBias = 0.004;
  KitRecipe recipe;
  recipe.motion = [](double t) { return Eigen::Vector2d(10, 0.2 * std::sin(0.3 * t)); };
  recipe.noise = {1e-9, 1e-9, 1e-9, 0, 1e-12, 1};
  recipe.fix_sigma_m = 0.3;
  double scale_squared = 0;
  double bias_squared = 0;
  for (int seed = 1; seed <= kSeeds; ++seed) {
    KitDrive drive = make_kit_drive(recipe, static_cast<std::uint64_t>(seed));
    drive.graph = Graph();  // without the odometry
    for (std::size_t i = 0; i < drive.truth.size(); ++i) {
      const Pose2<double>& t = drive.truth[i];
      drive.poses[i] = drive.graph.add_vertex<VertexSe2>(
          VertexId(static_cast<int>(i)), {t.position[0], t.position[1], wrap_angle(t.heading)});
    }
    drive.add_fixes();
    Noise noise(static_cast<std::uint64_t>(5000 + seed));
    Readings readings("twist");
    for (std::size_t i = 0; i < drive.truth.size(); ++i) {
      const double t = 0.1 * static_cast<double>(i);
      const double yaw_rate = recipe.motion(t)[1];
      readings.add(drive.stamps[i], {{"vx", 10 / (1 + kScale) + noise(0.1)},
                                     {"vy", noise(0.1)},
                                     {"yaw_rate", yaw_rate + kBias + noise(0.5 * kDegree)}});
    }
    drive.add_sensor("twist", readings.table(), {{"scale_sigma", "0.1"}, {"yaw_rate_bias_sigma", "0.1"}});
    (void)solve(drive);
    const std::array states = {find_state(drive.graph, "VERTEX_TWIST_SCALE"),
                               find_state(drive.graph, "VERTEX_TWIST_BIAS")};
    const CovarianceBlocks blocks = marginal_covariances(drive.graph, states);
    CHECK(blocks[0](0, 0) < 0.003 * 0.003);
    CHECK(blocks[1](0, 0) < 0.002 * 0.002);
    scale_squared += std::pow(drive.graph.value(states[0])[0] - kScale, 2) / blocks[0](0, 0);
    bias_squared += std::pow(drive.graph.value(states[1])[0] - kBias, 2) / blocks[1](0, 0);
  }
  check_mean_chi_square(scale_squared, 1, kSeeds);
  check_mean_chi_square(bias_squared, 1, kSeeds);
}

TEST_CASE("twist: numbers that cannot be are named with their row") {
  BareDrive drive(every(0.1, 2));
  const auto refused = [&](const std::map<std::string, double>& row, const std::string& message) {
    Readings readings("twist");
    readings.add(kit_stamp(0), {{"vx", 1}, {"yaw_rate", 0}});
    readings.add(kit_stamp(0.5), row);
    CHECK_THROWS_WITH(drive.add(readings.table(), {}), Contains("row 2 (time 1000.5): " + message));
  };
  refused({{"yaw_rate", 0}}, "column 'vx': must lie in [-150, 150], got nan");
  refused({{"vx", 36000}, {"yaw_rate", 0}}, "column 'vx': must lie in [-150, 150], got 36000");
  refused({{"vx", 1}, {"vy", -200}, {"yaw_rate", 0}}, "column 'vy': must lie in [-150, 150], got -200");
  refused({{"vx", 1}, {"yaw_rate", 57}}, "column 'yaw_rate': must lie in [-20, 20], got 57");
  refused({{"vx", 1}, {"yaw_rate", 0}, {"sigma_v", 0}}, "column 'sigma_v': a sigma must lie in [1e-9, 1e9]");
  refused({{"vx", 1}, {"yaw_rate", 0}, {"sigma_yaw_rate", -1}}, "column 'sigma_yaw_rate': a sigma must lie");
  CHECK_THROWS_WITH(registry().make_sensor_model("twist", {{"longest", "0"}}), Contains("longest"));
}

TEST_CASE("twist: rows outside the drive leave no edge") {
  BareDrive drive(every(0.1, 2));
  drive.add(table_of({-3, -2.5, -2}, winding), kPlain);
  drive.add(table_of({5, 5.5, 6}, winding), kPlain);
  CHECK(joined(drive, "EDGE_SE2_LOG").empty());
}

}  // namespace kit_twist_test
