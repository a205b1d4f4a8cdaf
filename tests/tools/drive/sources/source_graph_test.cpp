// The graph of a drive with several receivers and odometries.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <set>

#include <waymark/core/base/angle.hpp>
#include <waymark/core/base/error.hpp>
#include <waymark/tools/drive/description/drive_file.hpp>
#include <waymark/tools/drive/model/build.hpp>
#include <waymark/tools/drive/model/fuse.hpp>
#include <waymark/tools/drive/model/poses_at_fixes.hpp>
#include <waymark/tools/evaluation/document/estimated_states.hpp>
#include <waymark/tools/simulation/simulation.hpp>
#include <waymark/types_se2/se2.hpp>

#include "support/registry.hpp"
#include "tools/experiments/simulated.hpp"

namespace source_graph_test {

using namespace waymark;
using namespace waymark::drive;
using Catch::Matchers::Message;
using waymark_test::registry;

namespace {

constexpr double kSpeed = 10;
constexpr double kYawRate = 0.05;

/// The vehicle drives a circle.
Pose2<double> truth_at(double t) {
  return compose(Pose2<double>(20, -30, 0.4), se2_exp<double>(Eigen::Vector3d(kSpeed * t, 0, kYawRate * t)));
}

std::vector<OdometrySample> circle_samples(double rate_hz, double first_s, double last_s) {
  std::vector<OdometrySample> samples;
  for (int i = 0; first_s + i / rate_hz <= last_s + 1e-9; ++i)
    samples.push_back({Stamp::from_seconds(first_s + i / rate_hz), kSpeed, kYawRate});
  return samples;
}

/// Two receivers with lever arms, without any error, once in a second.
PreparedDrive circle(double later_s) {
  PreparedDrive drive;
  drive.odometry = circle_samples(10, 0, 60);
  drive.receivers = {{"front", {2.6, 0}}, {"rear", {-0.8, 0.3}}};
  for (int second = 1; second < 60; ++second) {
    for (int source = 0; source < 2; ++source) {
      Fix fix;
      const double t = second + (source == 1 ? later_s : 0);
      fix.stamp = Stamp::from_seconds(t);
      fix.source = source;
      fix.antenna_m = drive.receivers[static_cast<std::size_t>(source)].antenna_m;
      const Pose2<double> pose = truth_at(t);
      fix.position = pose.position + rotate(pose.heading, fix.antenna_m);
      fix.epoch = static_cast<int>(drive.fixes.size());
      drive.fixes.push_back(fix);
    }
  }
  return drive;
}

FusionSettings plain(const std::string& modeling, const Options& calibration = {}) {
  FusionSettings settings;
  settings.modeling = modeling;
  settings.calibration = calibration;
  settings.estimates_noise = false;
  settings.gate.enabled = false;
  return settings;
}

FusedDrive fused(const PreparedDrive& drive, const FusionSettings& settings) {
  FusedDrive result = fuse(drive, settings, registry());
  REQUIRE(result.minimum.summary.converged());
  return result;
}

std::vector<VertexId> vertices_of(const Graph& graph, const std::string& tag) {
  std::vector<VertexId> ids;
  for (VertexIndex v = 0; v < static_cast<VertexIndex>(graph.vertex_count()); ++v)
    if (graph.vertex_type(v).tag == tag) ids.push_back(graph.id(v));
  return ids;
}

std::size_t odometry_edges_of(const Graph& graph) {
  std::size_t count = 0;
  for (std::size_t b = 0; b < graph.batch_count(); ++b)
    if (graph.edge_type(b).tag.rfind("EDGE_SE2_ODOMETRY", 0) == 0) count += graph.batch(b).size();
  return count;
}

}  // namespace

TEST_CASE("source graph: two receivers at their true places give the exact truth") {
  const PreparedDrive drive = circle(0.55);
  const FusedDrive result = fused(drive, plain("g1"));
  CHECK(result.model.document.graph.chi2() < 1e-12);
  for (const StampedPose& at : poses_at_fixes(result.model.document)) {
    const Pose2<double> truth = truth_at(at.stamp.seconds());
    REQUIRE((at.pose.head<2>() - truth.position).norm() < 1e-6);
    REQUIRE(std::abs(wrap_angle(at.pose[2] - truth.heading)) < 1e-7);
  }
  // The other way round, the receivers contradict each other.
  PreparedDrive swapped = drive;
  for (Fix& fix : swapped.fixes) fix.antenna_m = drive.receivers[fix.source == 0 ? 1 : 0].antenna_m;
  CHECK(fused(swapped, plain("g1")).model.document.graph.chi2() > 1);
}

TEST_CASE(
    "source graph: a receiver that contradicts two others is named, and is not in the graph for that time") {
  PreparedDrive drive = circle(0.55);
  drive.odometry = circle_samples(10, 0, 400);
  drive.receivers.push_back({"roof", {0.9, 0.4}});
  drive.fixes.clear();
  for (int second = 0; second < 400; ++second) {
    for (int source = 0; source < 3; ++source) {
      Fix fix;
      const double t = second + 0.2 * source;
      fix.stamp = Stamp::from_seconds(t);
      fix.source = source;
      fix.antenna_m = drive.receivers[static_cast<std::size_t>(source)].antenna_m;
      fix.position = truth_at(t).position + rotate(truth_at(t).heading, fix.antenna_m);
      // It drifts away by 30 m, and back, too slowly for a jump.
      if (source == 2)
        fix.position[0] += 30 * std::clamp(std::min(second - 180, 320 - second) / 60.0, 0.0, 1.0);
      drive.fixes.push_back(fix);
    }
  }
  const FusedDrive result = fused(drive, plain("g1"));
  GateSummary gate = result.model.placed.gate;
  CHECK(gate.reasons["contradicts"] == 140);
  CHECK(gate.rejected == 140);
  CHECK(gate.accepted == 1060);
  const std::vector<std::string> warnings = result.model.warnings();
  REQUIRE(warnings.size() == 1);
  // Medians of windows of 20 s: 5, 15, 25, 30, 25.5, 15.5 and 5.5 m.
  CHECK(warnings[0] ==
        "roof contradicts the others, which agree, from 180 to 320 s after the start: by 15.5 m; its 140 "
        "readings there are left out");
  CHECK(result.model.document.graph.chi2() < 1e-9);
}

TEST_CASE("source graph: two odometries have their own edges and their own states") {
  PreparedDrive drive = circle(0.55);
  drive.odometry_name = "wheels";
  drive.relative = {{"wheels", drive.odometry, 0.5, {}}, {"visual", circle_samples(2, 0.05, 59.6), 2, {}}};
  const FusedDrive result =
      fused(drive, plain("g1", {{"gyro_bias", "constant"}, {"speed_scale", "constant"}}));
  const formats::GraphDocument& document = result.model.document;
  const Graph& graph = document.graph;
  const std::size_t nodes = result.model.placed.timeline.stamps.size();
  // The samples of the visual odometry are at 0.05, 0.55, ... 59.55 s: 120 nodes, 119 edges.
  CHECK(odometry_edges_of(graph) == nodes - 1 + 119);
  CHECK(graph.chi2() < 1e-12);
  for (const char* tag : {"VERTEX_GYRO_BIAS", "VERTEX_SPEED_SCALE"}) {
    std::set<std::string> sources;
    const std::vector<VertexId> states = vertices_of(graph, tag);
    for (const VertexId id : states) sources.insert(formats::source_of(id, document));
    INFO(tag);
    CHECK(states.size() == 2);
    CHECK(sources == std::set<std::string>{"wheels", "visual"});
  }
}

TEST_CASE("source graph: states are named by their source") {
  PreparedDrive drive = circle(0.55);
  const FusedDrive result = fused(drive, plain("correlated", {{"time_offset", "constant"}}));
  std::set<std::string> names;
  for (const evaluation::StateReport& state : evaluation::report_states(result.model.document))
    names.insert(state.name);
  for (const char* source : {"front", "rear"})
    for (const char* state : {"gnss_bias_x", "gnss_bias_y", "time_offset"})
      CHECK(names.contains(std::string(source) + "." + state));
  CHECK_FALSE(names.contains("gnss_bias_x"));
  drive.receivers.pop_back();
  std::erase_if(drive.fixes, [](const Fix& fix) { return fix.source == 1; });
  for (const evaluation::StateReport& state :
       evaluation::report_states(fused(drive, plain("correlated")).model.document))
    CHECK(state.name.find('.') == std::string::npos);
}

TEST_CASE("source graph: receivers with common errors share the states of each stamp") {
  const PreparedDrive drive = circle(0);
  FusionSettings settings = decided(plain("correlated"), registry());
  const auto states_of = [&](const char* tag) {
    const PlacedDrive placed = place_drive(drive, timeline_of(drive), settings, registry());
    return vertices_of(build_graph(placed, {}, settings, registry()).graph, tag).size();
  };
  CHECK(states_of("VERTEX_GNSS_BIAS") == 2 * 59);
  CHECK(states_of("VERTEX_GNSS_MULTIPATH") == 2 * 59);
  settings.sources["rear"].common = "front";
  CHECK(states_of("VERTEX_GNSS_BIAS") == 2 * 59);  // each its own
  CHECK(states_of("VERTEX_GNSS_MULTIPATH") == 59);
  // What both receivers are told of a group is that of its first: the truth stays exact.
  const FusedDrive result = fused(drive, settings);
  CHECK(result.model.document.graph.chi2() < 1e-9);
}

TEST_CASE("source graph: a modeling of white noise has no errors in common") {
  FusionSettings settings = plain("g1");
  settings.sources["rear"].common = "front";
  CHECK_THROWS_MATCHES(fuse(circle(0), settings, registry()), UsageError,
                       Message("source 'front': the modeling 'g1' has no errors that sources could have in "
                               "common; leave out 'common'"));
}

TEST_CASE("source graph: one odometry and one receiver under sources give the graph of the short forms") {
  const std::string forms[] = {
      "odometry: {file: o.csv, options: {heading_variance_per_s: 1e-6}, model: constant_twist}\n"
      "gnss: {file: g.csv}\n"
      "modeling: {name: correlated, options: {white_sigma: 2}}\n"
      "noise: stated\n",
      "sources:\n"
      "  wheels: {kind: odometry, file: o.csv, options: {heading_variance_per_s: 1e-6}, model: constant_twist}\n"
      "  front: {kind: gnss, file: g.csv}\n"
      "modeling: {name: correlated, options: {white_sigma: 2}}\n"
      "noise: stated\n",
      "sources:\n"
      "  wheels: {kind: odometry, file: o.csv, options: {heading_variance_per_s: 1e-6}}\n"
      "  front: {kind: gnss, file: g.csv, modeling: {name: correlated, options: {white_sigma: 2}}}\n"
      "noise: stated\n"};
  const simulation::SimulationRecipe recipe =
      simulation::with_duration(simulation::simulation_preset("mixed").recipe, 120);
  PreparedDrive drive = waymark_test::prepared(simulation::simulate(recipe, 3));
  std::vector<std::vector<double>> values;
  for (const std::string& form : forms) {
    const DriveFile file = parse_drive_file(form, "drive.yaml", "");
    drive.odometry_name = file.description.odometry.front().name;
    drive.receivers = {{file.description.gnss.front().name, {0, 0}}};
    const Graph graph = fused(drive, file.settings).model.document.graph;
    values.emplace_back(graph.values().begin(), graph.values().end());
  }
  REQUIRE(values[0].size() > 1000);
  CHECK(values[1] == values[0]);
  CHECK(values[2] == values[0]);
}

}  // namespace source_graph_test
