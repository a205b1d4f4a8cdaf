// The marginal likelihood against dense linear algebra: if errors are linear, Laplace's method
// is exact.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include <Eigen/Cholesky>
#include <catch2/catch.hpp>

#include <waymark/core/covariance/evidence.hpp>
#include <waymark/core/system/normal_equations.hpp>
#include <waymark/plugins/odometry/calibration.hpp>

#include "plugins/kit_drive.hpp"

namespace evidence_test {

using namespace waymark;
using namespace waymark::plugins::odometry;
using namespace waymark_test;

namespace {

constexpr int kSteps = 40;

/// A bias that walks and is read at every step.
struct Walk {
  double prior_sigma;
  double step_sigma;
  double reading_sigma;
};

Eigen::Matrix<double, 1, 1> information(double sigma) {
  return Eigen::Matrix<double, 1, 1>(1 / (sigma * sigma));
}

Graph make_graph(const Walk& walk, const Eigen::VectorXd& readings) {
  Graph graph;
  VertexIndex last = -1;
  for (int i = 0; i < kSteps; ++i) {
    const VertexIndex bias = graph.add_vertex<VertexGyroBias>(VertexId(i), {0});
    if (last < 0) {
      add_prior_about_zero(graph, bias, walk.prior_sigma);
    } else {
      graph.add_edge(EdgeGyroBiasWalk{}, {last, bias}, information(walk.step_sigma));
    }
    graph.add_edge(EdgeGyroAtRest{readings[i]}, {bias}, information(walk.reading_sigma));
    last = bias;
  }
  return graph;
}

/// The density of the readings themselves: normal, with the covariance of a walk plus the
/// covariance of the readings.
double exact_negative_log(const Walk& walk, const Eigen::VectorXd& readings) {
  Eigen::MatrixXd covariance(kSteps, kSteps);
  for (int i = 0; i < kSteps; ++i) {
    for (int j = 0; j < kSteps; ++j) {
      covariance(i, j) = walk.prior_sigma * walk.prior_sigma +
                         std::min(i, j) * walk.step_sigma * walk.step_sigma +
                         (i == j ? walk.reading_sigma * walk.reading_sigma : 0.0);
    }
  }
  const Eigen::LLT<Eigen::MatrixXd> root(covariance);
  return 0.5 * readings.dot(root.solve(readings)) + root.matrixLLT().diagonal().array().log().sum();
}

/// At the minimum, which Newton's method reaches in one step.
double negative_log(const Walk& walk, const Eigen::VectorXd& readings) {
  Graph graph = make_graph(walk, readings);
  Structure structure;
  structure.build(graph, std::vector<char>(graph.vertex_count(), 0));
  BlockCholesky cholesky;
  cholesky.analyze(structure.pattern());
  NormalEquations equations(graph, structure);
  equations.linearize(graph.values());
  REQUIRE(cholesky.factorize(equations.hessian()) == FactorStatus::ok);
  Eigen::VectorXd step = -equations.gradient();
  cholesky.solve({step.data(), static_cast<std::size_t>(step.size())},
                 {step.data(), static_cast<std::size_t>(step.size())});
  std::vector<double> moved;
  equations.retract(graph.values(), step, moved);
  graph.set_values(std::move(moved));
  return evidence(graph, structure, cholesky).negative_log();
}

/// A bias at 0 with a prior of sigma 1, and readings of it with sigma 1 and a Cauchy loss of scale sqrt(6).
Graph bias_with_cauchy_readings(const std::vector<double>& readings) {
  Graph graph;
  const VertexIndex bias = graph.add_vertex<VertexGyroBias>(VertexId{0}, {0});
  add_prior_about_zero(graph, bias, 1);
  for (const double reading : readings)
    graph.add_edge(EdgeGyroAtRest{reading}, {bias}, Eigen::Matrix<double, 1, 1>(1.0));
  graph.batch(1).set_loss(builtin_loss("cauchy", std::sqrt(6.0)));
  return graph;
}

}  // namespace

TEST_CASE("evidence: of linear errors it is the density of the readings, without its powers of 2 pi") {
  Noise noise(17);
  Eigen::VectorXd readings(kSteps);
  double bias = noise(0.01);
  for (int i = 0; i < kSteps; ++i) {
    readings[i] = bias + noise(0.02);
    bias += noise(0.005);
  }
  for (const Walk& walk : {Walk{0.01, 0.005, 0.02}, Walk{0.1, 0.005, 0.02}, Walk{0.01, 0.05, 0.02},
                           Walk{0.01, 0.005, 0.2}, Walk{0.003, 0.001, 0.001}}) {
    INFO(walk.prior_sigma << " " << walk.step_sigma << " " << walk.reading_sigma);
    CHECK(negative_log(walk, readings) == Approx(exact_negative_log(walk, readings)).epsilon(1e-9));
  }
}

TEST_CASE("evidence: an axis without information counts for nothing, H that is not definite for everything") {
  Graph graph;
  const VertexIndex origin = graph.add_vertex<VertexSe2>(VertexId{0}, {0, 0, 0});
  graph.set_fixed(origin, true);
  const VertexIndex pose = graph.add_vertex<VertexSe2>(VertexId{1}, {0, 0, 0});
  graph.add_edge(EdgeSe2{{1, 2, 0.1}}, {origin, pose}, Eigen::Vector3d(4, 9, 0).asDiagonal().toDenseMatrix());
  Structure structure;
  structure.build(graph, std::vector<char>(graph.vertex_count(), 0));
  BlockCholesky cholesky;
  cholesky.analyze(structure.pattern());
  CHECK(evidence(graph, structure, cholesky).log_det_information == Approx(std::log(36.0)));
  CHECK(std::isinf(evidence(graph, structure, cholesky).negative_log()));
  graph.add_edge(EdgeSe2{{1, 2, 0.1}}, {origin, pose}, Eigen::Matrix3d::Identity());
  structure.build(graph, std::vector<char>(graph.vertex_count(), 0));
  cholesky.analyze(structure.pattern());
  const Evidence found = evidence(graph, structure, cholesky);
  CHECK(found.log_det_information == Approx(std::log(36.0)));
  CHECK(found.log_det_hessian == Approx(std::log(5.0 * 10.0 * 1.0)));
}

TEST_CASE("evidence: a robust edge counts by its weight, at most by what gives its density its mass") {
  const std::vector<double> readings = {0.5, 1.5, 3, 8};
  const Graph graph = bias_with_cauchy_readings(readings);
  // exp(-rho / 2) = (1 + e^2 / 6)^-3 has the mass sqrt(6) B(1/2, 5/2) = sqrt(6) 3 pi / 8.
  const double mass = std::sqrt(6.0) * 3 * std::numbers::pi / 8;
  const double most = 2 * std::numbers::pi / (mass * mass);
  double expected = 1;
  for (const double reading : readings) expected += std::min(most, 6 / (6 + reading * reading));
  CHECK(evidence(graph).log_det_hessian == Approx(std::log(expected)).epsilon(1e-4));
}

TEST_CASE("evidence: H with the concave terms of the losses is the derivative of the gradient") {
  const std::vector<double> readings = {0.5, 1.5, 3, 8};
  const Graph graph = bias_with_cauchy_readings(readings);
  Structure structure;
  structure.build(graph, std::vector<char>(graph.vertex_count(), 0));
  NormalEquations equations(graph, structure);
  // The second derivative of 3 log(1 + e^2 / 6) is (6 - e^2) / 6 / (1 + e^2 / 6)^2.
  double expected = 1;
  for (const double e : readings) expected += (1 - e * e / 6) / std::pow(1 + e * e / 6, 2);
  (void)equations.linearize_with_concave_terms(graph.values());
  CHECK(equations.hessian()[0] == Approx(expected).epsilon(1e-12));
  (void)equations.linearize(graph.values());
  CHECK(equations.hessian()[0] > expected);
}

TEST_CASE("evidence: repeated for other numbers in one structure it is that of each graph") {
  Graph graph = make_graph({0.01, 0.005, 0.02}, Eigen::VectorXd::LinSpaced(kSteps, -0.01, 0.01));
  Structure structure;
  structure.build(graph, std::vector<char>(graph.vertex_count(), 0));
  RepeatedEvidence repeated(graph, structure);
  for (const double sigma : {0.02, 0.2, 0.02}) {
    graph = make_graph({0.01, 0.005, sigma}, Eigen::VectorXd::LinSpaced(kSteps, -0.01, 0.01));
    CHECK(repeated.at(graph.values()).negative_log() == evidence(graph).negative_log());
  }
}

}  // namespace evidence_test
