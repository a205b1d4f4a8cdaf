// Elimination in the order of time through one front: the minimum and the covariances are those of the
// general optimizer.
#include <cmath>

#include <catch2/catch.hpp>

#include <waymark/core/covariance/marginals.hpp>
#include <waymark/core/optimize/optimizer.hpp>
#include <waymark/core/window/marginalization.hpp>
#include <waymark/core/window/window_solver.hpp>
#include <waymark/formats/logs/log_readers.hpp>
#include <waymark/tools/drive/description/drive_file.hpp>
#include <waymark/tools/drive/model/build.hpp>
#include <waymark/tools/drive/model/fuse.hpp>

#include "support/paths.hpp"
#include "support/registry.hpp"

namespace window_solver_test {

using namespace waymark;
using waymark_test::registry;

namespace {

/// The first minute of the bundled drive.
const drive::PreparedDrive& minute() {
  static const drive::PreparedDrive prepared = [] {
    const std::string yaml = waymark_test::source_dir() + "/examples/berlin_potsdamer_platz/drive.yaml";
    drive::DriveDescription description = drive::load_drive_file(yaml).description;
    description.to_s = 60;
    TypeRegistry readers;
    formats::register_log_readers(readers);
    return drive::load_drive(description, readers);
  }();
  return prepared;
}

Graph graph_of(const std::string& modeling) {
  drive::FusionSettings settings;
  settings.modeling = modeling;
  settings.calibration =
      Options{{"gyro_bias", "random_walk"}, {"speed_scale", "constant"}, {"time_offset", "constant"}};
  settings.estimates_noise = false;
  return drive::Fusion(minute(), registry()).model(settings).document.graph;
}

Graph minimised(Graph graph) {
  OptimizerOptions options;
  options.decrement_tolerance = 1e-12;
  options.max_iterations = 100;
  const Summary summary = optimize(graph, *registry().make_algorithm("dogleg"),
                                   *registry().make_linear_solver("block_cholesky"), options);
  REQUIRE(summary.converged());
  return graph;
}

double furthest(const Graph& a, const Graph& b) {
  double apart = 0;
  for (std::size_t i = 0; i < a.values().size(); ++i)
    apart = std::max(apart, std::abs(a.values()[i] - b.values()[i]));
  return apart;
}

VertexIndex newest_pose(const Graph& graph) {
  VertexIndex newest = -1;
  for (VertexIndex v = 0; v < static_cast<VertexIndex>(graph.vertex_count()); ++v)
    if (graph.vertex_type(v).position != nullptr && graph.stamp(v) &&
        (newest < 0 || *graph.stamp(v) > *graph.stamp(newest)))
      newest = v;
  return newest;
}

}  // namespace

TEST_CASE("the minimum of a window is that of the general optimizer", "[window]") {
  const std::string modeling = GENERATE("correlated", "g1", "g2", "g3");
  CAPTURE(modeling);
  Graph graph = graph_of(modeling);
  const Graph expected = minimised(graph);
  WindowSolver solver(graph);
  const WindowSummary summary = solver.update({.max_iterations = 50, .decrement_tolerance = 1e-12});
  CHECK(summary.solved);
  CHECK(summary.converged);
  CHECK(summary.chi2 == Approx(expected.chi2()).epsilon(1e-9));
  CHECK(furthest(graph, expected) < 1e-5);
  // Poses are joined by few states, so the front stays small whatever the length of the window is.
  CHECK(solver.largest_front() < 40);
}

TEST_CASE("the joint covariance of the newest pose and the open states is that of the whole graph",
          "[window]") {
  const std::string modeling = GENERATE("correlated", "g1", "g3");
  CAPTURE(modeling);
  Graph graph = minimised(graph_of(modeling));
  WindowSolver solver(graph);
  REQUIRE(solver.update({.max_iterations = 1}).solved);
  const WindowTail tail = solver.tail(newest_pose(graph));
  REQUIRE(tail.vertices.size() >= 3);  // the pose, gyro bias, speed scale
  CHECK(tail.vertices.front() == newest_pose(graph));
  const Eigen::MatrixXd expected = Marginals(graph).joint(tail.vertices);
  REQUIRE(expected.rows() == tail.covariance.rows());
  for (Eigen::Index r = 0; r < expected.rows(); ++r)
    for (Eigen::Index c = 0; c < expected.cols(); ++c) {
      const double scale = std::sqrt(expected(r, r) * expected(c, c));
      CHECK(std::abs(tail.covariance(r, c) - expected(r, c)) < 1e-6 * scale);
    }
}

TEST_CASE("a window without its oldest third has the minimum of the whole", "[window]") {
  const Graph whole = minimised(graph_of("correlated"));
  Graph window = whole;
  const auto count = static_cast<VertexIndex>(window.vertex_count() / 3);
  const Marginalization dropped = marginalize_prefix(window, count);
  WindowSolver solver(window);
  const WindowSummary summary = solver.update({.max_iterations = 20, .decrement_tolerance = 1e-14});
  REQUIRE(summary.converged);
  double apart = 0;
  for (VertexIndex v = 0; v < static_cast<VertexIndex>(whole.vertex_count()); ++v) {
    const VertexIndex now = dropped.removal.new_index[static_cast<std::size_t>(v)];
    if (now < 0) continue;
    for (std::size_t i = 0; i < whole.value(v).size(); ++i)
      apart = std::max(apart, std::abs(whole.value(v)[i] - window.value(now)[i]));
  }
  CHECK(apart < 1e-4);
}

TEST_CASE("a window that nothing anchors is told by the vertex that is not determined", "[window]") {
  Graph graph = graph_of("g1");
  // Only the odometry: no fix says where it is.
  std::vector<char> gone(graph.vertex_count(), 0);
  for (VertexIndex v = 0; v < static_cast<VertexIndex>(graph.vertex_count()); ++v)
    gone[static_cast<std::size_t>(v)] = graph.fixed(v) && graph.vertex_type(v).position != nullptr;
  (void)graph.remove_vertices(gone);
  const std::vector<double> before = graph.values();
  WindowSolver solver(graph);
  const WindowSummary summary = solver.update();
  CHECK_FALSE(summary.solved);
  CHECK(summary.singular >= 0);
  CHECK(graph.values() == before);
}

}  // namespace window_solver_test
