// A filter that keeps the last 5 s of a drive: what is older leaves as a prior, so that a step
// costs the same however long the drive is. Its newest pose is that of a whole optimisation.
#include <cmath>
#include <cstdio>

#include <waymark/core/window/incremental.hpp>
#include <waymark/solvers/optimize.hpp>
#include <waymark/solvers/register.hpp>
#include <waymark/types_se2/edge_se2.hpp>

using namespace waymark;

namespace {

constexpr int kSteps = 600;  // at 10 Hz
constexpr int kWindow = 50;  // poses

/// The motion measured from step i to the next, and the fix at step i.
Pose2<double> odometry(int i) {
  return {1.0, 0.0, 0.03 * std::sin(0.02 * i)};
}
Eigen::Vector2d fix(const Pose2<double>& truth, int i) {
  return truth.position + Eigen::Vector2d(0.3 * std::sin(7.0 * i), 0.3 * std::cos(5.0 * i));
}

/// Appends step i to a graph, its pose predicted from the one before.
void add_step(Graph& graph, int i, const Pose2<double>& truth) {
  if (i == 0) {
    graph.add_vertex<VertexSe2>(VertexId{0}, truth);
  } else {
    const VertexIndex last = *graph.find(VertexId{i - 1});
    const Pose2<double> motion = odometry(i - 1);
    const Pose2<double> predicted = compose(graph.value<VertexSe2>(last), motion);
    const VertexIndex pose = graph.add_vertex<VertexSe2>(VertexId{i}, predicted);
    graph.add_edge(EdgeSe2{motion.vector()}, {last, pose}, Eigen::Vector3d(400, 400, 40000).asDiagonal());
  }
  if (i % 10 == 0) {
    graph.add_edge(EdgePriorSe2{{fix(truth, i)[0], fix(truth, i)[1], truth.heading}},
                   {*graph.find(VertexId{i})}, Eigen::Vector3d(4, 4, 4).asDiagonal());
  }
}

}  // namespace

int main() {
  TypeRegistry registry;
  solvers::register_solvers(registry);
  Graph window;
  IncrementalOptimizer optimizer(window, registry.make_algorithm("gauss_newton"),
                                 registry.make_linear_solver("block_cholesky"), {.max_iterations = 2});
  Graph whole;
  Pose2<double> truth(0, 0, 0);
  for (int i = 0; i < kSteps; ++i) {
    add_step(window, i, truth);
    add_step(whole, i, truth);
    optimizer.update();
    if (i >= kWindow) (void)optimizer.drop_prefix(*window.find(VertexId{i - kWindow + 1}));
    truth = compose(truth, odometry(i));
  }
  const MultiStartSummary summary = optimize(whole);

  const VertexId newest{kSteps - 1};
  const Pose2<double> filtered = window.value<VertexSe2>(*window.find(newest));
  const Pose2<double> smoothed = whole.value<VertexSe2>(*whole.find(newest));
  const double apart = (filtered.vector() - smoothed.vector()).norm();
  std::printf("window: %zu poses, %zu edges; whole: %zu poses, %s\n", window.vertex_count(),
              window.edge_count(), whole.vertex_count(), summary.brief().c_str());
  std::printf("newest pose: %.4f %.4f %.4f by the window, %.1e from the whole\n", filtered.position.x(),
              filtered.position.y(), filtered.heading, apart);
  return summary.converged() && window.vertex_count() == kWindow && apart < 1e-3 ? 0 : 1;
}
