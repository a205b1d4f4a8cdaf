// The same problems written for Ceres, with its own automatic derivatives and nothing of ours but the numbers
// of the graph: both must end at the same chi2. Ceres minimises half the sum of squares. (REQUIRE throughout:
// Ceres' headers define a CHECK of their own.)
#include <catch2/catch.hpp>

#include "support/skip.hpp"

#ifndef WAYMARK_HAVE_CERES

TEST_CASE("peer: Ceres ends at the same minima") {
  waymark_test::skip("Ceres was not found when this was built (package libceres-dev)");
}

#else

#include <cmath>
#include <numbers>
#include <optional>

#include <ceres/ceres.h>
#include <Eigen/Cholesky>

#include <waymark/core/optimize/optimizer.hpp>
#include <waymark/formats/graph/graph_document.hpp>
#include <waymark/formats/graph/graph_format.hpp>
#include <waymark/formats/text/text_file.hpp>

#include "support/problems.hpp"
#include "support/registry.hpp"

using namespace waymark;
using namespace waymark::formats;

namespace {

template <typename T>
T normalised(const T& angle) {
  return angle - 2 * std::numbers::pi * ceres::floor((angle + std::numbers::pi) / (2 * std::numbers::pi));
}

/// U with U^T U = Omega.
Eigen::MatrixXd square_root(const Eigen::MatrixXd& omega) {
  const Eigen::LLT<Eigen::MatrixXd> factor(omega);
  REQUIRE(factor.info() == Eigen::Success);
  return factor.matrixU();
}

/// b seen from a, poses as arrays (x, y, heading).
template <typename T>
void relative(const T* a, const T* b, T* seen) {
  const T dx = b[0] - a[0];
  const T dy = b[1] - a[1];
  seen[0] = cos(a[2]) * dx + sin(a[2]) * dy;
  seen[1] = cos(a[2]) * dy - sin(a[2]) * dx;
  seen[2] = b[2] - a[2];
}

template <typename T, int N>
void weigh(const Eigen::MatrixXd& root, const Eigen::Matrix<T, N, 1>& error, T* residual) {
  Eigen::Map<Eigen::Matrix<T, N, 1>>{residual} = root.cast<T>() * error;
}

struct TranslationHeading {
  Eigen::Vector3d z;
  Eigen::MatrixXd root;
  template <typename T>
  bool operator()(const T* a, const T* b, T* residual) const {
    const T measured[3] = {T(z[0]), T(z[1]), T(z[2])};
    T seen[3];
    T off[3];
    relative(a, b, seen);
    relative(measured, seen, off);
    weigh<T, 3>(root, {off[0], off[1], normalised(off[2])}, residual);
    return true;
  }
};

/// The logarithm of the pose relative to the end of an arc of constant twist: V(theta)^-1 applied to the
/// offset.
struct ArcLogarithm {
  double speed;
  double yaw_rate;
  double dt;
  Eigen::MatrixXd root;
  template <typename T>
  bool operator()(const T* a, const T* b, T* residual) const {
    const double turn = yaw_rate * dt;
    const double length = speed * dt;
    const bool straight = std::abs(turn) < 1e-12;
    const T measured[3] = {T(straight ? length : length * std::sin(turn) / turn),
                           T(straight ? 0.5 * length * turn : length * (1 - std::cos(turn)) / turn), T(turn)};
    T seen[3];
    T off[3];
    relative(a, b, seen);
    relative(measured, seen, off);
    const T theta = normalised(off[2]);
    // (theta/2) cot(theta/2): its series to theta^4 if sin and theta would cancel.
    const T half = 0.5 * theta;
    const T h = abs(theta) < T(1e-4) ? T(1.0) - theta * theta / 12.0 : half * cos(half) / sin(half);
    weigh<T, 3>(root, {h * off[0] + half * off[1], h * off[1] - half * off[0], theta}, residual);
    return true;
  }
};

struct Position {
  Eigen::Vector2d z;
  Eigen::Vector2d antenna;
  Eigen::MatrixXd root;
  template <typename T>
  bool operator()(const T* pose, T* residual) const {
    const T x = pose[0] + cos(pose[2]) * antenna[0] - sin(pose[2]) * antenna[1];
    const T y = pose[1] + sin(pose[2]) * antenna[0] + cos(pose[2]) * antenna[1];
    weigh<T, 2>(root, {x - z[0], y - z[1]}, residual);
    return true;
  }
};

/// chi2 at Ceres' minimum of the graph from its present values; the poses hold the result.
double minimise_with_ceres(const Graph& graph, std::vector<double>& poses) {
  ceres::Problem problem;
  poses = graph.values();
  const auto pose = [&](VertexIndex v) { return poses.data() + 3 * v; };
  bool anchored = false;
  for (std::size_t b = 0; b < graph.batch_count(); ++b) {
    const EdgeBatchBase& batch = graph.batch(b);
    const std::string& tag = graph.edge_type(b).tag;
    for (std::size_t e = 0; e < batch.size(); ++e) {
      std::vector<double> f;
      batch.fields(e, f);
      const auto v = batch.vertices(e);
      const Eigen::MatrixXd root = square_root(batch.information(e));
      if (tag == "EDGE_SE2") {
        problem.AddResidualBlock(new ceres::AutoDiffCostFunction<TranslationHeading, 3, 3, 3>(
                                     new TranslationHeading{{f[0], f[1], f[2]}, root}),
                                 nullptr, pose(v[0]), pose(v[1]));
      } else if (tag == "EDGE_SE2_ODOMETRY" || tag == "EDGE_SE2_STANDSTILL") {
        const bool stands = tag == "EDGE_SE2_STANDSTILL";
        problem.AddResidualBlock(new ceres::AutoDiffCostFunction<ArcLogarithm, 3, 3, 3>(
                                     new ArcLogarithm{stands ? 0 : f[0], stands ? 0 : f[1], f[2], root}),
                                 nullptr, pose(v[0]), pose(v[1]));
      } else if (tag == "EDGE_GNSS_POSITION") {
        REQUIRE(graph.fixed(v[0]));  // the origin at zero
        problem.AddResidualBlock(
            new ceres::AutoDiffCostFunction<Position, 2, 3>(new Position{{f[0], f[1]}, {f[2], f[3]}, root}),
            nullptr, pose(v[1]));
        anchored = true;
      } else {
        FAIL("no Ceres cost for " << tag);
      }
    }
  }
  if (!anchored) problem.SetParameterBlockConstant(pose(0));
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  options.max_num_iterations = 500;
  options.function_tolerance = 1e-15;
  options.gradient_tolerance = 1e-14;
  options.parameter_tolerance = 1e-14;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  INFO(summary.BriefReport());
  REQUIRE(summary.IsSolutionUsable());
  return 2 * summary.final_cost;
}

/// @param figure the minimum, if the caller knows it
void check_same_minimum(Graph graph, std::optional<double> figure = {}) {
  const TypeRegistry registry = waymark_test::full_registry();
  std::vector<double> poses;
  const double peer = minimise_with_ceres(graph, poses);
  if (figure) REQUIRE(peer == Approx(*figure).epsilon(1e-7));
  OptimizerOptions options;
  options.decrement_tolerance = 1e-12;  // nine digits are compared
  const Summary summary = optimize(graph, *registry.make_algorithm("dogleg"),
                                   *registry.make_linear_solver("block_cholesky"), options);
  INFO(summary.message);
  REQUIRE(summary.converged());
  REQUIRE(summary.final_chi2 == Approx(peer).epsilon(1e-9));
  // Our chi2 of their poses: the two objectives are one function.
  graph.set_values(poses);
  REQUIRE(graph.chi2() == Approx(peer).epsilon(1e-9));
}

/// Returns a file of the shared data; nothing if the case is skipped, because the file is missing.
std::optional<std::string> load(const std::string& name) {
  const auto path = waymark_test::shared_data("graphs/" + name);
  if (!path) return std::nullopt;
  return read_text_file(*path);
}

void check_file(const char* name) {
  const auto text = load(std::string(name) + ".g2o");
  if (text) check_same_minimum(read_graph(*text, name, waymark_test::full_registry()).graph);
}

}  // namespace

TEST_CASE("peer: Ceres ends at the same minimum of a noisy circle") {
  check_same_minimum(waymark_test::noisy_circle(200));
}

TEST_CASE("peer: Ceres ends at the same minimum of intel") {
  check_file("intel");
}

TEST_CASE("peer: Ceres ends at the same minimum of manhattan, from its odometry") {
  check_file("manhattan");
}

TEST_CASE("peer: Ceres ends at the same minimum of ring, for which no figure is published") {
  check_file("ring");
}

TEST_CASE("peer: Ceres ends at the same minimum of manhattanOlson3500, for which no figure is published") {
  check_file("manhattanOlson3500");
}

TEST_CASE("peer: Ceres ends at the same minimum of MIT from the linear start, below every published figure") {
  const auto text = load("MIT.g2o");
  if (!text) return;
  const TypeRegistry registry = waymark_test::full_registry();
  Graph graph = read_graph(*text, "MIT", registry).graph;
  graph.set_values(registry.make_start("linear", graph).values);
  check_same_minimum(graph, 41.163269);
}

TEST_CASE("peer: Ceres ends at the same minimum of fr079, for which no figure is published") {
  const auto text = load("fr079_toro.graph");
  if (text)
    check_same_minimum(read_graph_as(GraphFormat::toro, *text, "fr079", waymark_test::full_registry()).graph,
                       37.599116);
}

TEST_CASE(
    "peer: Ceres ends at the same minimum of a drive under G1, logarithmic odometry, antenna off the axle") {
  const TypeRegistry registry = waymark_test::full_registry();
  waymark_test::Drive drive = waymark_test::make_drive(registry, 4000, {1.2, -0.4});
  drive.add_fixes(registry, "g1");
  check_same_minimum(drive.graph);
}

#endif
