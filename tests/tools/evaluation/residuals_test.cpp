#include <cmath>
#include <random>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <catch2/catch.hpp>

#include <waymark/core/optimize/algorithm.hpp>
#include <waymark/core/optimize/optimizer.hpp>
#include <waymark/plugins/gnss_correlated/gnss_bias.hpp>
#include <waymark/plugins/odometry/calibration.hpp>
#include <waymark/tools/evaluation/document/residuals.hpp>
#include <waymark/types_se2/edge_se2.hpp>
#include <waymark/types_se2/g2o_edges.hpp>
#include "support/problems.hpp"
#include "support/registry.hpp"

namespace residuals_test {

using namespace waymark;
using namespace waymark::evaluation;
using namespace waymark::plugins::gnss_correlated;
using namespace waymark::plugins::odometry;

namespace {

/// One pose at the origin, one prior that says it was at -error.
Graph one_prior(const Eigen::Vector3d& error, const Eigen::Matrix3d& information) {
  Graph graph;
  graph.add_vertex<VertexSe2>(VertexId{7}, {0, 0, 0});
  EdgePriorSe2 prior;
  prior.measured = -error;
  graph.add_edge(prior, {0}, information);
  return graph;
}

std::vector<double> whitened(const Graph& graph) {
  return residuals_by_type(graph).types.front().whitened;
}

Loss huber(double scale) {
  const LossType& type = builtin_losses()[0];
  return {type.name, type.evaluate, scale};
}

}  // namespace

TEST_CASE("residuals: with independent components the whitened ones are errors in sigmas") {
  const auto w = whitened(one_prior({0.2, -0.6, 0}, Eigen::Vector3d(100, 25, 4).asDiagonal()));
  CHECK(w[0] == Approx(2));
  CHECK(w[1] == Approx(-3));
  CHECK(w[2] == Approx(0).margin(1e-15));
}

TEST_CASE("residuals: correlated components keep their chi2, whatever their units") {
  Eigen::Matrix3d information;
  information << 9, 4, 0, 4, 16, 0, 0, 0, 1;
  const Eigen::Vector3d error(0.3, -0.4, 0);
  const auto w = whitened(one_prior(error, information));
  CHECK(w[0] * w[0] + w[1] * w[1] + w[2] * w[2] == Approx(error.dot(information * error)));
  // The second component in units a hundred times smaller.
  const Eigen::Vector3d unit(1, 100, 1);
  const auto scaled =
      whitened(one_prior(unit.cwiseProduct(error),
                         unit.cwiseInverse().asDiagonal() * information * unit.cwiseInverse().asDiagonal()));
  for (std::size_t k = 0; k < 3; ++k) CHECK(scaled[k] == Approx(w[k]).margin(1e-15));
  // Both are strange in the same measure and alike in sign as the errors are.
  CHECK(w[0] > 0);
  CHECK(w[1] < 0);
}

TEST_CASE("residuals: noise as stated is white with variance 1 in every component") {
  Eigen::Matrix3d information;
  information << 400, 50, 900, 50, 100, 0, 900, 0, 1e4;
  const Eigen::Matrix3d root = information.inverse().llt().matrixL();
  std::mt19937_64 random(5);
  std::normal_distribution<double> unit(0, 1);
  Graph graph;
  constexpr int kEdges = 20000;
  for (int i = 0; i < kEdges; ++i) {  // the pose is the error: the prior says the origin
    const Eigen::Vector3d e = root * Eigen::Vector3d(unit(random), unit(random), unit(random));
    graph.add_vertex<VertexSe2>(VertexId(i), {e[0], e[1], e[2]});
    graph.add_edge(EdgePriorSe2{}, {i}, information);
  }
  const TypeResiduals type = residuals_by_type(graph).types.front();
  REQUIRE(type.components.size() == 3);
  Eigen::Matrix3d moments = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < kEdges; ++i) {
    const Eigen::Map<const Eigen::Vector3d> w(type.whitened.data() + 3 * i);
    moments += w * w.transpose() / kEdges;
  }
  CHECK((moments - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff() < 0.05);
  CHECK(type.components[0].name == "x");
  CHECK(type.components[2].name == "heading");
  for (const ResidualComponent& component : type.components) {
    CHECK(component.statistics.count == kEdges);
    CHECK(component.statistics.rms == Approx(1).margin(0.03));
    CHECK(component.statistics.mean == Approx(0).margin(0.03));
    CHECK(component.statistics.max_abs > 3);
  }
}

TEST_CASE("residuals: a component without information is left out") {
  const GraphResiduals residuals =
      residuals_by_type(one_prior({1, 2, 3}, Eigen::Vector3d(1, 1, 0).asDiagonal()));
  const TypeResiduals& type = residuals.types.front();
  CHECK(std::isnan(type.whitened[2]));
  CHECK(type.components[2].statistics.count == 0);
  CHECK(residuals.components == 2);
}

TEST_CASE("residuals: after a fit the rms is what redundancy leaves") {
  Graph graph = waymark_test::noisy_circle(4000, 3);
  const TypeRegistry registry = waymark_test::full_registry();
  const auto algorithm = registry.make_algorithm("gauss_newton", {});
  const auto solver = registry.make_linear_solver("block_cholesky");
  const Summary summary = optimize(graph, *algorithm, *solver, {});
  REQUIRE(summary.converged());
  const GraphResiduals residuals = residuals_by_type(graph);
  CHECK(residuals.components == 3 * graph.edge_count());
  // The information of this problem states a correlation that its noise does not have, which
  // changes the expected square by trace(Omega Sigma) / 3; it is 1 here, as the diagonal of Omega
  // is the inverse of the noise.
  const double rms = std::sqrt(residuals.squared / static_cast<double>(residuals.components));
  CHECK(rms == Approx(residuals.expected_rms(summary.unknowns)).epsilon(0.15));
  CHECK(residuals.chi2 == Approx(graph.chi2()).epsilon(1e-12));
}

TEST_CASE("residuals: shares, weights and the largest edges") {
  Graph graph;
  for (int i = 0; i < 4; ++i) {
    graph.add_vertex<VertexSe2>(VertexId(10 * i), {1.0 * i, 0, 0});
    if (i > 0) graph.set_stamp(i, Stamp{i});
  }
  const Eigen::Matrix3d information = Eigen::Matrix3d::Identity();
  for (int i = 0; i < 3; ++i)
    graph.add_edge(EdgeSe2{{1.0 + i, 0, 0}}, {i, i + 1}, information);  // off by 0, 1 and 2
  const EdgePlace wrong = graph.add_edge(EdgePriorSe2{{-4, 0, 0}}, {0}, information);
  graph.batch(wrong.batch).set_loss(huber(2));  // rho(16) = 2 * 2 * 4 - 4 = 12, rho' = 2 / 4
  const GraphResiduals residuals = residuals_by_type(graph, 2);
  REQUIRE(residuals.types.size() == 2);
  CHECK(residuals.squared == Approx(21));
  CHECK(residuals.chi2 == Approx(17));
  CHECK(residuals.chi2 == Approx(graph.chi2()));
  const TypeResiduals& odometry = residuals.types[0];
  CHECK(odometry.chi2_share == Approx(5.0 / 17));
  CHECK(odometry.squared_share == Approx(5.0 / 21));
  CHECK(odometry.robust == 0);
  CHECK(odometry.edges.size() == 3);
  REQUIRE(odometry.largest.size() == 2);
  CHECK(odometry.largest[0].residual.edge == 2);
  CHECK(odometry.largest[0].residual.squared == Approx(4));
  CHECK(odometry.largest[0].vertices == std::vector{VertexId{20}, VertexId{30}});
  CHECK(odometry.largest[0].residual.stamp == Stamp{3});
  CHECK(odometry.largest[0].whitened[0] == Approx(-2));
  CHECK(odometry.largest[1].residual.edge == 1);
  const TypeResiduals& prior = residuals.types[1];
  CHECK(prior.robust == 1);
  CHECK(prior.weight_sum == Approx(0.5));
  CHECK_FALSE(prior.edges[0].stamp);
}

TEST_CASE("residuals: measurements, steps of a state, and what was said beforehand") {
  Graph graph;
  graph.add_vertex<VertexGnssBias>(VertexId{0}, {0, 0});
  graph.add_vertex<VertexGnssBias>(VertexId{1}, {0.5, 0});
  graph.add_vertex<VertexSe2>(VertexId{2}, {0, 0, 0});
  graph.add_edge(gaussian_prior_type(), std::array<VertexIndex, 1>{0}, std::array{0.0, 0.0, 0.0, 0.0},
                 Eigen::MatrixXd::Identity(2, 2));
  graph.add_edge(gaussian_prior_type(), std::array<VertexIndex, 2>{0, 2},
                 std::array{0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0},
                 Eigen::MatrixXd::Identity(5, 5));
  graph.add_edge(EdgeGnssBiasDecay{}, {0, 1}, 4 * Eigen::Matrix2d::Identity());
  graph.add_edge(EdgePriorSe2{}, {2}, Eigen::Matrix3d::Identity());
  graph.add_vertex<VertexGyroBias>(VertexId{3}, {0});
  graph.add_edge(EdgeGyroAtRest{}, {3}, Eigen::Matrix<double, 1, 1>(1.0));
  const GraphResiduals residuals = residuals_by_type(graph);
  REQUIRE(residuals.types.size() == 4);
  CHECK(residuals.types[3].role == EdgeRole::measurement);  // a reading of a state
  CHECK(residuals.types[1].components[1].name == "gnss_bias_y");
  CHECK(residuals.types[0].role == EdgeRole::prior);
  CHECK(residuals.types[1].role == EdgeRole::process);
  CHECK(residuals.types[1].whitened == std::vector<double>{1, 0});
  CHECK(residuals.types[2].role == EdgeRole::measurement);
  // Edges of different sizes in one batch: the table is as wide as the largest.
  CHECK(residuals.types[0].dimension == 5);
  CHECK(residuals.types[0].components[4].statistics.count == 1);
  CHECK(residuals.components == 2 + 5 + 2 + 3 + 1);
}

TEST_CASE("residuals: of an empty graph there are none") {
  const GraphResiduals residuals = residuals_by_type(Graph());
  CHECK(residuals.types.empty());
  CHECK(residuals.expected_rms(0) == 0);
}

}  // namespace residuals_test
