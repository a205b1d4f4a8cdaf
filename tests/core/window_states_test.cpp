// A sliding window with calibration states: what stays, what it costs, and how it begins.
#include <catch2/catch.hpp>

#include <algorithm>
#include <limits>
#include <map>

#include <waymark/core/covariance/marginals.hpp>
#include <waymark/core/optimize/optimizer.hpp>
#include <waymark/core/window/incremental.hpp>

#include "support/problems.hpp"
#include "support/registry.hpp"
#include "support/replay.hpp"

namespace window_states_test {

using namespace waymark;
using namespace waymark_test;

namespace {

constexpr int kPoses = 3000;  // 2 minutes at 25 Hz
constexpr std::int64_t kWindow = 400;

const Options kStates = {{"gyro_bias", "random_walk"}, {"speed_scale", "constant"}};

bool is_pose(const Graph& graph, VertexIndex v) {
  return graph.vertex_type(v).position != nullptr && !graph.fixed(v);
}

/// The vertices as a running system makes them: a state comes before the first pose that needs it.
std::vector<VertexIndex> as_needed(const Graph& graph) {
  constexpr auto kNever = std::numeric_limits<VertexIndex>::max();
  std::map<VertexIndex, VertexIndex> first_pose;  // by state
  for (std::size_t b = 0; b < graph.batch_count(); ++b) {
    for_each_edge(graph.batch(b), [&](std::span<const VertexIndex> vertices) {
      VertexIndex pose = kNever;
      for (const VertexIndex v : vertices)
        if (is_pose(graph, v)) pose = std::min(pose, v);
      for (const VertexIndex v : vertices)
        if (!is_pose(graph, v) && !graph.fixed(v))
          first_pose[v] = std::min(first_pose.try_emplace(v, kNever).first->second, pose);
    });
  }
  // A state that is used at rest only joins no pose. It begins at the pose of its stamp.
  for (auto& [state, pose] : first_pose)
    if (pose == kNever) pose = static_cast<VertexIndex>(graph.stamp(state)->nanoseconds / 40'000'000);
  std::vector<VertexIndex> order;
  for (VertexIndex v = 0; v < static_cast<VertexIndex>(graph.vertex_count()); ++v)
    if (graph.fixed(v)) order.push_back(v);  // the origin of the fixes
  for (VertexIndex v = 0; v < static_cast<VertexIndex>(graph.vertex_count()); ++v) {
    if (!is_pose(graph, v)) continue;
    for (const auto& [state, pose] : first_pose)
      if (pose == v) order.push_back(state);
    order.push_back(v);
  }
  return order;
}

struct RunningWindow {
  Graph graph;
  std::vector<std::int64_t> pattern_sizes;  ///< at each update after the first drop
  std::size_t most_vertices = 0;
};

/// Runs a window along a drive, with an update at every fifth pose.
void run(const Graph& source, RunningWindow& window) {
  Replay replay(source, as_needed(source));
  IncrementalOptimizer optimizer(window.graph, registry().make_algorithm("gauss_newton"),
                                 registry().make_linear_solver("block_cholesky"), {.max_iterations = 2});
  while (!replay.done()) {
    const VertexIndex added = replay.append_to(window.graph);
    const std::int64_t newest = to_number(window.graph.id(added));
    if (!is_pose(window.graph, added) || newest % 5 != 0) continue;
    const Summary summary = optimizer.update();
    REQUIRE((summary.converged() || summary.termination == Termination::max_iterations ||
             summary.termination == Termination::nothing_to_do));
    if (newest < kWindow) continue;
    (void)optimizer.drop_prefix(*window.graph.find(VertexId{newest - kWindow}));
    window.pattern_sizes.push_back(optimizer.structure().pattern().value_count());
    window.most_vertices = std::max(window.most_vertices, window.graph.vertex_count());
  }
}

}  // namespace

TEST_CASE("window states: a window with a constant and a walk stays small and close to the whole drive") {
  Drive drive = make_drive(registry(), kPoses, {0, 0}, 1, kStates);
  drive.add_fixes(registry(), "g1");
  RunningWindow window;
  run(drive.graph, window);

  // 400 poses, and per 250 poses a value of the walk, one on each side of the cut, and the constant.
  CHECK(window.most_vertices <= kWindow + 6);
  // No fill-in builds up: what a window holds after two minutes, it held when it was first full.
  const std::size_t early = window.pattern_sizes.size() / 10;
  const std::int64_t first = *std::max_element(
      window.pattern_sizes.begin(), window.pattern_sizes.begin() + static_cast<std::ptrdiff_t>(early));
  CHECK(window.pattern_sizes.back() <= first + first / 10);
  // A pose joins the one before, the constant and a value of the walk: 9 + 9 + 3 + 3 numbers, and panels
  // hold a triangle beside. Fill-in would be 400 * 400 * 9 / 2.
  CHECK(window.pattern_sizes.back() < 60 * kWindow);

  Graph whole = drive.graph;
  REQUIRE(
      optimize(whole, *registry().make_algorithm("gauss_newton"), *registry().make_linear_solver("eigen"), {})
          .converged());
  const VertexId last{kPoses - 1};
  const Eigen::MatrixXd covariance = marginal_covariances(whole, std::array{*whole.find(last)})[0];
  const Eigen::Vector3d apart = window.graph.value<VertexSe2>(*window.graph.find(last)).vector() -
                                whole.value<VertexSe2>(*whole.find(last)).vector();
  for (int axis = 0; axis < 3; ++axis) CHECK(std::abs(apart[axis]) < 0.2 * std::sqrt(covariance(axis, axis)));

  // The constant is there with all that the drive says about it.
  for (VertexIndex v = 0; v < static_cast<VertexIndex>(window.graph.vertex_count()); ++v) {
    if (window.graph.vertex_type(v).tag != "VERTEX_SPEED_SCALE") continue;
    const VertexIndex same = *whole.find(window.graph.id(v));
    const double sigma = std::sqrt(marginal_covariances(whole, std::array{same})[0](0, 0));
    const double in_window = std::sqrt(marginal_covariances(window.graph, std::array{v})[0](0, 0));
    CHECK(in_window == Approx(sigma).epsilon(0.1));
    CHECK(std::abs(window.graph.value(v)[0] - whole.value(same)[0]) < 0.3 * sigma);
  }
}

TEST_CASE("window states: the first updates need no second fix, and the first pose is held until then") {
  Drive drive = make_drive(registry(), 100);
  drive.add_fixes(registry(), "g1");
  Replay replay(drive.graph, as_needed(drive.graph));
  Graph graph;
  IncrementalOptimizer optimizer(graph, registry().make_algorithm("gauss_newton"),
                                 registry().make_linear_solver("block_cholesky"), {});
  for (int i = 0; i < 3; ++i) (void)replay.append_to(graph);  // the origin and two poses
  const Summary early = optimizer.update();
  CHECK(early.converged());
  REQUIRE_FALSE(early.notes.empty());
  INFO(early.notes.front());
  CHECK(early.notes.front().find("held at its present value until more is measured") != std::string::npos);
  while (!replay.done()) (void)replay.append_to(graph);
  const Summary late = optimizer.update();
  CHECK(late.converged());
  CHECK(late.notes.empty());

  Graph whole = drive.graph;
  const Summary batch = optimize(whole, *registry().make_algorithm("gauss_newton"),
                                 *registry().make_linear_solver("eigen"), {});
  CHECK(late.final_chi2 == Approx(batch.final_chi2).epsilon(1e-6));
}

TEST_CASE("window states: with a prior on the first pose everything is determined from the first update on") {
  Graph graph;
  const VertexIndex first = graph.add_vertex<VertexSe2>(VertexId{0}, {1, 2, 0.5});
  graph.add_edge(EdgePriorSe2{{1, 2, 0.5}}, {first}, Eigen::Vector3d(0.04, 0.04, 0.1).asDiagonal());
  IncrementalOptimizer optimizer(graph, registry().make_algorithm("gauss_newton"),
                                 registry().make_linear_solver("block_cholesky"), {});
  CHECK(optimizer.update().notes.empty());
  const Eigen::MatrixXd covariance = marginal_covariances(graph, std::array{first})[0];
  CHECK(covariance(0, 0) == Approx(25));
  CHECK(covariance(2, 2) == Approx(10));
}

}  // namespace window_states_test
