// Marginal covariances against the inverse of the dense H; Gaussian priors against what they stand for.
#include <array>
#include <cmath>
#include <numeric>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <catch2/catch.hpp>

#include <waymark/core/error.hpp>
#include <waymark/core/gauge.hpp>
#include <waymark/core/marginals.hpp>
#include <waymark/core/optimizer.hpp>

#include "support/dense.hpp"
#include "support/problems.hpp"
#include "support/registry.hpp"
#include "support/scalar_types.hpp"

using namespace waymark;
using namespace waymark_test;

namespace {

const TypeRegistry& registry() {
  static const TypeRegistry value = full_registry();
  return value;
}

void minimise(Graph& graph) {
  REQUIRE(optimize(graph, *registry().make_algorithm("dogleg"), *registry().make_linear_solver("eigen"), {})
              .converged());
}

void check_against_inverse(const Graph& graph) {
  const DenseSystem system = assemble_dense(graph, find_gauge(graph).held);
  const Eigen::MatrixXd inverse = system.hessian.inverse();
  std::vector<VertexIndex> all(graph.vertex_count());
  std::iota(all.begin(), all.end(), 0);
  const CovarianceBlocks covariances = marginal_covariances(graph, all);
  REQUIRE(covariances.size() == all.size());
  for (std::size_t v = 0; v < all.size(); ++v) {
    INFO("vertex " << graph.id(all[v]));
    const int n = graph.vertex_type(all[v]).tangent_size;
    const Eigen::MatrixXd expected =
        system.start[v] < 0 ? Eigen::MatrixXd(Eigen::MatrixXd::Zero(n, n))
                            : Eigen::MatrixXd(inverse.block(system.start[v], system.start[v], n, n));
    CHECK((covariances[v] - expected).norm() <= 1e-9 * expected.norm());
    CHECK(covariances[v] == covariances[v].transpose());
  }
}

}  // namespace

TEST_CASE("marginals: a held gauge, loops, every vertex") {
  Graph graph = noisy_circle(40);
  minimise(graph);
  check_against_inverse(graph);
}

TEST_CASE("marginals: under minimum degree") {
  Graph graph = grid_walk(150, 8);
  minimise(graph);
  check_against_inverse(graph);
}

TEST_CASE("marginals: fixed vertices and vertices without edges have covariance zero") {
  Graph graph = noisy_circle(20);
  graph.set_fixed(3, true);
  graph.set_fixed(11, true);
  graph.add_vertex<VertexSe2>(99, {1, 2, 3});
  minimise(graph);
  check_against_inverse(graph);
}

TEST_CASE("marginals: a drive with fixes") {
  Drive drive = make_drive(registry(), 120);
  drive.add_fixes(registry(), "g2");
  minimise(drive.graph);
  check_against_inverse(drive.graph);
}

TEST_CASE("marginals: a dense calibration state and mixed sizes") {
  Graph graph;
  const VertexIndex scale = graph.add_vertex<VertexScale>(1000, {1});
  for (int i = 0; i < 30; ++i) {
    const VertexIndex pose = graph.add_vertex<VertexSe2>(i, {1.0 * i, 0, 0});
    if (i > 0)
      graph.add_edge(EdgeScaledOdometry{1, 0.1}, {pose - 1, scale, pose}, pose_information(0.1, 0.02));
    if (i % 7 == 0) graph.add_edge(EdgePriorSe2{{0.9 * i, 0.1 * i, 0}}, {pose}, Eigen::Matrix3d::Identity());
  }
  minimise(graph);
  check_against_inverse(graph);
}

TEST_CASE("marginals: robust weights count") {
  Graph graph = noisy_circle(20);
  const LossType* huber = registry().find_loss("huber");
  graph.batch(0).set_loss(Loss{huber->name, huber->evaluate, 1.5});
  minimise(graph);
  check_against_inverse(graph);
}

TEST_CASE("marginals: one prior gives its own covariance") {
  // With measured heading a, e_t = R(a)^T (p - z): the covariance in frame axes is R S R^T.
  Graph graph;
  const VertexIndex v = graph.add_vertex<VertexSe2>(0, {1, 2, 0.6});
  graph.add_edge(EdgePriorSe2{{1, 2, 0.6}}, {v}, Eigen::Vector3d(1 / 0.04, 1 / 0.25, 100).asDiagonal());
  Eigen::Matrix3d rotation;
  rotation << std::cos(0.6), -std::sin(0.6), 0, std::sin(0.6), std::cos(0.6), 0, 0, 0, 1;
  const Eigen::Matrix3d expected =
      rotation * Eigen::Matrix3d(Eigen::Vector3d(0.04, 0.25, 0.01).asDiagonal()) * rotation.transpose();
  CHECK(relative_difference(marginal_covariances(graph, std::array{v})[0], expected) < 1e-14);
}

TEST_CASE("marginals: what is not determined is an error") {
  Graph graph;
  const VertexIndex v = graph.add_vertex<VertexScale>(0, {1});
  graph.add_edge(EdgeSigmoid{}, {v}, Eigen::Matrix<double, 1, 1>::Zero());
  CHECK_THROWS_AS(marginal_covariances(graph, std::array{v}), InputError);
}

TEST_CASE("Gaussian prior: equals the pose prior with its information turned into frame axes") {
  const double a = 0.6;
  Graph by_pose = noisy_circle(20);
  Graph by_gaussian = by_pose;
  Eigen::Matrix3d omega;
  omega << 30, 5, 2, 5, 20, -3, 2, -3, 60;
  Eigen::Matrix3d rotation;
  rotation << std::cos(a), -std::sin(a), 0, std::sin(a), std::cos(a), 0, 0, 0, 1;
  by_pose.add_edge(EdgePriorSe2{{4, 5, a}}, {7}, omega);
  by_gaussian.add_edge(*registry().find_edge("EDGE_GAUSSIAN_PRIOR"), std::array<VertexIndex, 1>{7},
                       std::array<double, 6>{4, 5, a, 0, 0, 0}, rotation * omega * rotation.transpose());
  CHECK(by_gaussian.chi2() == Approx(by_pose.chi2()).epsilon(1e-12));
  minimise(by_pose);
  minimise(by_gaussian);
  CHECK(by_gaussian.chi2() == Approx(by_pose.chi2()).epsilon(1e-9));
  for (std::size_t i = 0; i < by_pose.values().size(); ++i)
    CHECK(by_gaussian.values()[i] == Approx(by_pose.values()[i]).margin(1e-6));
  CHECK(relative_difference(marginal_covariances(by_gaussian, std::array<VertexIndex, 1>{15})[0],
                            marginal_covariances(by_pose, std::array<VertexIndex, 1>{15})[0]) < 1e-6);
}

TEST_CASE("Gaussian prior: left by marginalisation, it gives the rest of the graph the same step") {
  // Eliminate pose 0 of a chain 0-1-2-3 with a prior on 0: S = H_bb - H_ba H_aa^-1 H_ab on pose 1, and offset
  // d = -S^-1 (g_b - H_ba H_aa^-1 g_a).
  Graph whole;
  for (int i = 0; i < 4; ++i) whole.add_vertex<VertexSe2>(i, {1.1 * i, 0.1 * i * i, 0.2 * i});
  whole.add_edge(EdgePriorSe2{{0.3, 0.1, 0.05}}, {0}, pose_information(0.3, 0.1));
  Graph rest;
  for (int i = 1; i < 4; ++i) {
    const auto value = whole.value(i);
    rest.add_vertex<VertexSe2>(i, {value[0], value[1], value[2]});
    whole.add_edge(EdgeSe2Log{{1, 0.1, 0.15}}, {i - 1, i}, pose_information(0.05, 0.02));
    if (i > 1) rest.add_edge(EdgeSe2Log{{1, 0.1, 0.15}}, {i - 2, i - 1}, pose_information(0.05, 0.02));
  }
  Graph head;  // what is marginalised: the prior and the edge 0-1
  for (int i = 0; i < 2; ++i) {
    const auto value = whole.value(i);
    head.add_vertex<VertexSe2>(i, {value[0], value[1], value[2]});
  }
  head.add_edge(EdgePriorSe2{{0.3, 0.1, 0.05}}, {0}, pose_information(0.3, 0.1));
  head.add_edge(EdgeSe2Log{{1, 0.1, 0.15}}, {0, 1}, pose_information(0.05, 0.02));
  const DenseSystem h = assemble_dense(head, std::vector<char>(2, 0));
  const Eigen::Matrix3d gain =
      h.hessian.bottomLeftCorner<3, 3>() * h.hessian.topLeftCorner<3, 3>().inverse().eval();
  Eigen::Matrix3d schur = h.hessian.bottomRightCorner<3, 3>() - gain * h.hessian.topRightCorner<3, 3>();
  schur = Eigen::Matrix3d(0.5 * (schur + schur.transpose()));
  const Eigen::Vector3d d = -schur.ldlt().solve(h.gradient.tail<3>() - gain * h.gradient.head<3>());
  const auto reference = whole.value(1);
  const std::array<double, 6> fields = {reference[0], reference[1], reference[2], d[0], d[1], d[2]};
  rest.add_edge(*registry().find_edge("EDGE_GAUSSIAN_PRIOR"), std::array<VertexIndex, 1>{0}, fields, schur);

  const DenseSystem all = assemble_dense(whole, std::vector<char>(4, 0));
  const DenseSystem kept = assemble_dense(rest, std::vector<char>(3, 0));
  const Eigen::VectorXd step = -all.hessian.ldlt().solve(all.gradient);
  const Eigen::VectorXd kept_step = -kept.hessian.ldlt().solve(kept.gradient);
  CHECK(relative_difference(kept_step, step.tail<9>()) < 1e-9);
}
