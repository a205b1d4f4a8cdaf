// A graph that grows with its drive is that of the whole drive: every model continues where it ended.
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <span>

#include <catch2/catch.hpp>

#include <waymark/core/optimize/optimizer.hpp>
#include <waymark/formats/logs/log_readers.hpp>
#include <waymark/tools/drive/description/drive_file.hpp>
#include <waymark/tools/drive/model/build.hpp>
#include <waymark/tools/drive/model/fuse.hpp>

#include "support/paths.hpp"
#include "support/registry.hpp"

namespace growing_drive_test {

using namespace waymark;
using namespace waymark::drive;
using waymark_test::registry;

namespace {

const PreparedDrive& bundled_drive() {
  static const PreparedDrive drive = [] {
    const std::string yaml = waymark_test::source_dir() + "/examples/berlin_potsdamer_platz/drive.yaml";
    TypeRegistry readers;
    formats::register_log_readers(readers);
    return load_drive(load_drive_file(yaml).description, readers);
  }();
  return drive;
}

/// The settings with the noise as it is by default.
FusionSettings settings_of(const std::string& modeling, const Options& calibration) {
  FusionSettings settings;
  settings.modeling = modeling;
  settings.calibration = calibration;
  settings.estimates_noise = false;
  return decided(settings, registry());
}

const Options kAllStates = {
    {"gyro_bias", "random_walk"}, {"speed_scale", "constant"}, {"time_offset", "constant"}};

PlacedDrive place(const FusionSettings& settings) {
  return place_drive(bundled_drive(), timeline_of(bundled_drive()), settings, registry());
}

SensorTable rows_between(const SensorTable& table, std::optional<Stamp> after, Stamp last) {
  SensorTable part;
  part.columns = table.columns;
  for (std::size_t row = 0; row < table.size(); ++row) {
    if (table.stamps[row] > last || (after && table.stamps[row] <= *after)) continue;
    part.stamps.push_back(table.stamps[row]);
    for (std::size_t column = 0; column < table.columns; ++column)
      part.values.push_back(table.at(row, column));
  }
  return part;
}

/// Adds the nodes [begin, end) with their fixes and readings.
void add_part(std::size_t begin, std::size_t end, const PlacedDrive& placed,
              const std::vector<PreparedSensor>& sensors, GraphBuilder& builder) {
  const Timeline& timeline = placed.timeline;
  std::vector<Fix> fixes;
  std::vector<std::size_t> fix_nodes;
  for (std::size_t i = 0; i < placed.fixes.size(); ++i) {
    const std::size_t node = timeline.fix_node[i];
    if (placed.fixes[i].status != FixStatus::accepted || node < begin || node >= end) continue;
    fixes.push_back(placed.fixes[i]);
    fix_nodes.push_back(node);
  }
  std::vector<PreparedSensor> next = sensors;
  for (PreparedSensor& sensor : next) {
    const std::optional<Stamp> after = begin == 0 ? std::nullopt : std::optional(timeline.stamps[begin - 1]);
    sensor.readings = rows_between(sensor.readings, after, timeline.stamps[end - 1]);
  }
  const std::size_t first_interval = begin == 0 ? 0 : begin - 1;
  builder.extend({std::span(timeline.stamps).subspan(begin, end - begin),
                  std::span(placed.start.poses).subspan(begin, end - begin),
                  std::span(timeline.intervals).subspan(first_interval, end - 1 - first_interval), fixes,
                  fix_nodes, next});
}

GraphBuilder grown(const PlacedDrive& placed, const std::vector<PreparedSensor>& sensors,
                   const FusionSettings& settings, std::size_t nodes_per_part) {
  GraphBuilder builder(facts_of(placed, settings), sensors, settings, registry());
  const std::size_t nodes = placed.timeline.stamps.size();
  const std::size_t first = std::max<std::size_t>(nodes_per_part, 2);  // with an interval
  add_part(0, first, placed, sensors, builder);
  for (std::size_t begin = first; begin < nodes; begin += nodes_per_part)
    add_part(begin, std::min(begin + nodes_per_part, nodes), placed, sensors, builder);
  return builder;
}

std::map<std::string, std::size_t> edges_by_type(const Graph& graph) {
  std::map<std::string, std::size_t> counts;
  for (std::size_t b = 0; b < graph.batch_count(); ++b)
    counts[graph.edge_type(b).tag] += graph.batch(b).size();
  return counts;
}

double solve(Graph& graph) {
  const auto algorithm = registry().make_algorithm("dogleg");
  const auto solver = registry().make_linear_solver("block_cholesky");
  OptimizerOptions options;
  options.decrement_tolerance = 1e-12;
  options.max_iterations = 200;
  const Summary summary = optimize(graph, *algorithm, *solver, options);
  REQUIRE(summary.converged());
  return summary.final_chi2;
}

/// @param tolerance of chi2, relative
void check_same(const PlacedDrive& placed, const std::vector<PreparedSensor>& sensors,
                const FusionSettings& settings, std::size_t nodes_per_part, double tolerance = 1e-9) {
  Graph whole = build_graph(placed, sensors, settings, registry()).graph;
  GraphBuilder builder = grown(placed, sensors, settings, nodes_per_part);
  const std::span<const VertexIndex> poses = builder.nodes().poses;
  Graph& parts = builder.graph();
  CHECK(parts.vertex_count() == whole.vertex_count());
  CHECK(edges_by_type(parts) == edges_by_type(whole));
  CHECK(parts.chi2() == Approx(whole.chi2()).epsilon(tolerance));
  CHECK(solve(parts) == Approx(solve(whole)).epsilon(tolerance));
  double apart_m = 0;
  for (std::size_t node = 0; node < poses.size(); ++node) {
    const auto one = whole.value(whole.find(vertex_of(node)).value());
    const auto other = parts.value(poses[node]);
    apart_m = std::max(apart_m, std::hypot(one[0] - other[0], one[1] - other[1]));
  }
  CHECK(apart_m < 1e-5);
}

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// A compass whose offset is a state, and two landmarks: one is free, the place of the other is stated late.
std::vector<PreparedSensor> two_sensors(const PlacedDrive& placed) {
  PreparedSensor compass{.name = "heading", .options = {{"offset", "constant"}, {"sigma_deg", "5"}}};
  compass.readings.columns = 2;
  PreparedSensor camera{.name = "landmarks"};
  camera.readings.columns = 9;
  const std::vector<Eigen::Vector3d>& poses = placed.start.poses;
  for (std::size_t node = 50; node + 1 < poses.size(); node += 100) {
    const Stamp stamp = placed.timeline.stamps[node];
    compass.readings.stamps.push_back(stamp);
    compass.readings.values.insert(compass.readings.values.end(), {poses[node][2] + 0.1, kNone});
    const double id = node % 200 == 50 ? 1 : 2;
    const bool states_map = node > poses.size() / 2 && id == 1;
    const Eigen::Vector2d place = poses[poses.size() / 3].head<2>() + Eigen::Vector2d(20 * id, 5);
    const Eigen::Vector2d from = place - poses[node].head<2>();
    const double c = std::cos(poses[node][2]);
    const double s = std::sin(poses[node][2]);
    camera.readings.stamps.push_back(stamp);
    camera.readings.values.insert(camera.readings.values.end(),
                                  {id, c * from[0] + s * from[1], c * from[1] - s * from[0], kNone, kNone, 3,
                                   kNone, states_map ? place[0] : kNone, states_map ? place[1] : kNone});
  }
  return {compass, camera};
}

}  // namespace

TEST_CASE("growing drive: parts give the graph of the whole drive under every registered modeling") {
  for (const auto& [modeling, origin] : registry().gnss_modelings()) {
    const FusionSettings settings = settings_of(modeling.name, kAllStates);
    const PlacedDrive placed = place(settings);
    for (const std::size_t nodes_per_part : {std::size_t{1}, std::size_t{333}}) {
      INFO(modeling.name << ", " << nodes_per_part << " nodes in each part");
      check_same(placed, {}, settings, nodes_per_part);
    }
  }
}

TEST_CASE("growing drive: sensors keep their states and landmarks from part to part") {
  const FusionSettings settings = settings_of("g1", {});
  const PlacedDrive placed = place(settings);
  const std::vector<PreparedSensor> sensors = two_sensors(placed);
  REQUIRE(sensors[0].readings.size() > 20);
  // A reading takes the grid scale of the nearest fix known so far, which differs in the eighth digit.
  check_same(placed, sensors, settings, 333, 1e-6);
}

TEST_CASE("growing drive: several receivers keep their states apart, or in common, from part to part") {
  PreparedDrive drive = bundled_drive();
  drive.receivers = {{"front", {2.6, 0}}, {"rear", {-0.8, 0.3}}};
  for (std::size_t i = 0; i < drive.fixes.size(); ++i) {
    drive.fixes[i].source = static_cast<int>(i % 2);
    drive.fixes[i].antenna_m = drive.receivers[i % 2].antenna_m;
  }
  FusionSettings settings = settings_of("correlated", kAllStates);
  for (const char* common : {"", "front"}) {
    INFO("common: " << common);
    settings.sources["rear"].common = common;
    check_same(place_drive(drive, timeline_of(drive), settings, registry()), {}, settings,
               timeline_of(drive).stamps.size() / 2 + 1);
  }
}

}  // namespace growing_drive_test
