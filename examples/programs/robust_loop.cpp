// A drive round a circle with a true loop closure and a false one: what the false one does without
// a loss, with one, and after it was found.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <optional>

#include <waymark/core/robust/graduation.hpp>
#include <waymark/solvers/optimize.hpp>
#include <waymark/solvers/register.hpp>
#include <waymark/types_se2/edge_se2.hpp>

using namespace waymark;

namespace {

constexpr int kPoses = 40;
constexpr double kStep = 2 * std::numbers::pi / kPoses;  // turn from pose to pose
constexpr double kLength = 5;                            // m from pose to pose

Pose2<double> truth(int i) {
  const double radius = 0.5 * kLength / std::sin(0.5 * kStep);
  return {radius * std::sin(i * kStep), radius * (1 - std::cos(i * kStep)), wrap_angle(i * kStep)};
}

Eigen::Vector3d motion(int from, int to) {
  const Eigen::Vector3d exact = between(truth(from), truth(to)).vector();
  return {exact[0], exact[1], wrap_angle(exact[2])};
}

/// Odometry with a small error, and two closures. @param loss of both closures; empty: none
struct Drive {
  Graph graph;
  EdgePlace false_closure;
};
Drive make_drive(const std::optional<Loss>& loss) {
  Drive drive;
  const Eigen::Matrix3d odometry = Eigen::Vector3d(400, 400, 40000).asDiagonal();  // 5 cm, 5 mrad
  const Eigen::Matrix3d closure = Eigen::Vector3d(100, 100, 10000).asDiagonal();   // 10 cm, 10 mrad
  Pose2<double> pose = truth(0);
  drive.graph.add_vertex<VertexSe2>(VertexId{0}, pose);
  for (int i = 1; i < kPoses; ++i) {
    const Eigen::Vector3d measured = motion(i - 1, i) + Eigen::Vector3d(0.03, -0.01, 0.002 * std::sin(i));
    pose = compose(pose, constant_pose<double>(measured));
    drive.graph.add_vertex<VertexSe2>(VertexId{i}, pose);
    drive.graph.add_edge(EdgeSe2{measured}, {i - 1, i}, odometry);
  }
  drive.graph.set_fixed(0, true);
  drive.graph.add_edge(EdgeSe2{motion(kPoses - 1, 0)}, {kPoses - 1, 0}, closure, loss);
  // Two places that look alike: "pose 25 is where pose 5 was".
  drive.false_closure = drive.graph.add_edge(EdgeSe2{}, {25, 5}, closure, loss);
  return drive;
}

double largest_error(const Graph& graph) {
  double largest = 0;
  for (int i = 0; i < kPoses; ++i) {
    largest = std::max(largest, (graph.value<VertexSe2>(i).position - truth(i).position).norm());
  }
  return largest;
}

}  // namespace

int main() {
  Drive plain = make_drive({});
  optimize(plain.graph);
  Drive robust = make_drive(builtin_loss("geman_mcclure", 1));
  const MultiStartSummary summary = optimize(robust.graph, {.start = "file"});

  Drive doubted = make_drive({});
  TypeRegistry registry;
  solvers::register_solvers(registry);
  const auto algorithm = registry.make_algorithm("dogleg");
  const auto solver = registry.make_linear_solver("block_cholesky");
  const GraduationResult found = graduate(doubted.graph, *algorithm, *solver, {});

  std::printf("largest error without a loss  %7.3f m\n", largest_error(plain.graph));
  std::printf("             with a loss      %7.3f m   %s\n", largest_error(robust.graph),
              summary.brief().c_str());
  std::printf("             by graduation    %7.3f m   %zu outlier of %zu candidates\n",
              largest_error(doubted.graph), found.outliers.size(), found.candidates);
  const bool right = largest_error(plain.graph) > 5 && largest_error(robust.graph) < 0.5 &&
                     largest_error(doubted.graph) < 0.5 &&
                     found.outliers == std::vector{doubted.false_closure};
  return right ? 0 : 1;
}
