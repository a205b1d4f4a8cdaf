// The Ceres that `waymark bench --peer` measures solves the same problem: its first cost is our
// chi2 of the start, its result our minimum. (ceres_test.cpp writes the errors anew; here they are
// ours, as measured.)
#include <catch2/catch.hpp>

#ifdef WAYMARK_HAVE_CERES

#include <waymark/core/optimize/optimizer.hpp>
#include <waymark/tools/benchmark/ceres/ceres_peer.hpp>

#include "support/problems.hpp"
#include "support/registry.hpp"
#include "support/scalar_types.hpp"
#include "support/vertex_body_pose.hpp"

using namespace waymark;
using namespace waymark::benchmark;

namespace {

void check_same_problem(Graph graph, CeresMethod method = CeresMethod::levenberg_marquardt) {
  const TypeRegistry registry = waymark_test::full_registry();
  Graph solved = graph;
  const RunOutcome peer = optimize_with_ceres(solved, {.method = method, .function_tolerance = 1e-14});
  const double start_chi2 = graph.chi2();
  const Summary summary =
      optimize(graph, *registry.make_algorithm("dogleg"), *registry.make_linear_solver("eigen"), {});
  INFO(summary.message << "\n" << peer.message);
  REQUIRE(summary.converged());
  CHECK(peer.converged);
  CHECK(peer.iterations > 0);
  CHECK(peer.initial_chi2 == Approx(start_chi2).epsilon(1e-12));
  CHECK(peer.final_chi2 == Approx(summary.final_chi2).epsilon(1e-6));
  CHECK(peer.final_chi2 == Approx(solved.chi2()).epsilon(1e-15));
}

/// Correlated and semidefinite information, every edge type of the plane.
Graph graph_of_all_types() {
  Graph graph = waymark_test::noisy_circle(50);
  Eigen::Matrix3d full;  // its largest diagonal entry is last: the root needs a permutation
  full << 260, 0.5, 10, 0.5, 256, -25, 10, -25, 332;
  const Eigen::Matrix3d no_heading = Eigen::Vector3d(0.5, 0.3, 0).asDiagonal();
  graph.add_edge(EdgeSe2{{1.01, 0.1, 0.12}}, {0, 1}, full);
  graph.add_edge(EdgeSe2{{1.01, 0.1, 0.5}}, {3, 4}, no_heading);
  graph.add_edge(EdgeSe2Log{{2.0, 0.1, 0.26}}, {10, 12}, full);
  graph.add_edge(EdgePriorSe2{{8, 0.1, 1.6}}, {0}, full);
  const VertexIndex landmark = graph.add_vertex<VertexXy>(VertexId{1000}, {1.0, 1.0});
  for (const VertexIndex pose : {5, 17, 30}) {
    graph.add_edge(EdgeSe2Xy{{2, 6}}, {pose, landmark}, Eigen::Matrix2d(full.topLeftCorner<2, 2>()));
    graph.add_edge(EdgeGnssPosition{{1, 2}, {0.5, -0.2}}, {0, pose},
                   Eigen::Matrix2d(0.01 * Eigen::Matrix2d::Identity()));
  }
  return graph;
}

/// The relative pose of two vertices whose steps are in their own axes.
struct EdgeBodyPoses {
  static constexpr std::string_view kTag = "EDGE_BODY_POSES";
  static constexpr int kErrorDimension = 3;
  using Vertices = VertexList<waymark_test::VertexBodyPose, waymark_test::VertexBodyPose>;
  static constexpr auto fields() { return std::array{field<&EdgeBodyPoses::measured>("measured")}; }
  template <typename T>
  Vector3<T> error(const Pose2<T>& a, const Pose2<T>& b) const {
    const Pose2<T> off = between(constant_pose<T>(measured), between(a, b));
    return Vector3<T>(off.position[0], off.position[1], wrap_angle(off.heading));
  }
  Eigen::Vector3d measured{0, 0, 0};
};

}  // namespace

TEST_CASE("peer: vertices with a chart of their own are updated by it") {
  Graph graph;
  constexpr int kPoses = 20;
  for (int i = 0; i < kPoses; ++i)
    graph.add_vertex<waymark_test::VertexBodyPose>(VertexId{i}, {1.0 * i, 0.2 * std::sin(i), 0.1 * i});
  graph.set_fixed(0, true);
  for (int i = 0; i + 1 < kPoses; ++i)
    graph.add_edge(EdgeBodyPoses{{1, 0, 0.3}}, {i, i + 1}, Eigen::Vector3d(4, 9, 100).asDiagonal());
  for (int i = 0; i + 5 < kPoses; i += 5)
    graph.add_edge(EdgeBodyPoses{{3.5, 2.5, 1.4}}, {i, i + 5}, Eigen::Vector3d(1, 1, 10).asDiagonal());
  check_same_problem(graph);
}

TEST_CASE("peer: the measured Ceres solves the same problem with every edge type of the plane") {
  check_same_problem(graph_of_all_types());
  check_same_problem(graph_of_all_types(), CeresMethod::dogleg);
}

TEST_CASE("peer: the measured Ceres holds what the gauge test holds, and fixed vertices") {
  Graph graph = waymark_test::noisy_circle(50);
  check_same_problem(graph);
  graph.set_fixed(7, true);
  graph.set_fixed(20, true);
  check_same_problem(graph);
}

TEST_CASE("peer: the measured Ceres has our robust losses") {
  Graph graph = waymark_test::noisy_circle(50);
  graph.add_edge(EdgeSe2{{9, -9, 1}}, {2, 30}, waymark_test::pose_information(0.05, 0.01));
  graph.batch(0).set_loss({"huber", waymark_test::full_registry().find_loss("huber")->evaluate, 1.5});
  check_same_problem(graph);
}

TEST_CASE("peer: the measured Ceres takes unknown edge types the slow way and says so") {
  Graph graph = waymark_test::noisy_circle(20);
  const VertexIndex scale = graph.add_vertex<waymark_test::VertexScale>(VertexId{500}, {1.0});
  for (VertexIndex i = 0; i < 10; ++i) {
    graph.add_edge(waymark_test::EdgeScaledOdometry{0.98, 0.31}, {i, scale, i + 1},
                   waymark_test::pose_information(0.05, 0.01));
  }
  check_same_problem(graph);
  const RunOutcome outcome = optimize_with_ceres(graph, {});
  REQUIRE(outcome.notes.size() == 1);
  CHECK(outcome.notes.front().find("10 edges EDGE_SCALED_ODOMETRY") != std::string::npos);
}

TEST_CASE("peer: the measured Ceres ends where it is told to") {
  Graph graph = waymark_test::noisy_circle(200);
  const RunOutcome outcome = optimize_with_ceres(graph, {.max_iterations = 1});
  CHECK_FALSE(outcome.converged);
  CHECK(outcome.iterations == 1);
  const std::atomic<bool> cancel{true};
  CHECK_FALSE(optimize_with_ceres(graph, {.cancel = &cancel}).converged);
}

#endif
