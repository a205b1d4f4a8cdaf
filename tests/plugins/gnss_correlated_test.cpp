// Options of the modeling `correlated`: the tails of the white part.
#include <cmath>

#include <Eigen/Cholesky>
#include <catch2/catch.hpp>

#include <waymark/core/base/error.hpp>
#include <waymark/core/covariance/marginals.hpp>
#include <waymark/core/drive/modeling.hpp>
#include <waymark/solvers/optimize.hpp>
#include <waymark/types_se2/vertex_se2.hpp>

#include "support/registry.hpp"

namespace gnss_correlated_test {

using namespace waymark;
using Catch::Contains;

namespace {

/// The edge of one fix with a claimed sigma of 2 m.
struct BuiltFix {
  Eigen::MatrixXd information;
  const Loss* loss = nullptr;
};

Graph graph_with(const Options& options, const std::optional<Loss>& loss = std::nullopt) {
  const TypeRegistry registry = waymark_test::full_registry();
  Graph graph;
  const VertexIndex pose = graph.add_vertex<VertexSe2>(VertexId{1}, {0, 0, 0});
  graph.set_stamp(pose, Stamp::from_seconds(1));
  Fix fix;
  fix.stamp = Stamp::from_seconds(1);
  fix.vertex = VertexId{1};
  fix.covariance = 4 * Eigen::Matrix2d::Identity();
  const std::vector<Fix> fixes{fix};
  const std::vector<FixMoment> moments(1);
  registry.make_gnss_modeling("correlated", options)->extend({fixes, moments, {0, 0}, loss}, graph);
  return graph;
}

BuiltFix fix_of(const Graph& graph) {
  for (std::size_t b = 0; b < graph.batch_count(); ++b) {
    if (graph.edge_type(b).tag == "EDGE_GNSS_POSITION_CORRELATED")
      return {graph.batch(b).information(0), graph.batch(b).loss(0)};
  }
  throw std::runtime_error("no fix");
}

/// Returns the covariance of an expected error, m^2.
Eigen::Matrix2d covariance_of(const ExpectedError& error, const Graph& minimum) {
  std::vector<VertexIndex> vertices;
  Eigen::MatrixXd factors(2, 2 * static_cast<Eigen::Index>(error.terms.size()));
  for (const ExpectedError::Term& term : error.terms) {
    factors.middleCols<2>(2 * static_cast<Eigen::Index>(vertices.size())) = term.factor;
    vertices.push_back(term.vertex);
  }
  return factors * Marginals(minimum).joint(vertices) * factors.transpose() + error.rest;
}

/// Returns the white sigma that the model gives an only fix, m.
double white_sigma_of(FixQuality quality, double claim_m, const ClaimedAccuracies& claimed,
                      const Options& options) {
  Graph graph;
  graph.add_vertex<VertexSe2>(VertexId{1}, {0, 0, 0});
  graph.set_stamp(0, Stamp::from_seconds(1));
  Fix fix;
  fix.stamp = Stamp::from_seconds(1);
  fix.vertex = VertexId{1};
  fix.told.quality = quality;
  fix.accuracy_claimed = true;
  fix.covariance = claim_m * claim_m * Eigen::Matrix2d::Identity();
  const std::vector<Fix> fixes{fix};
  const std::vector<FixMoment> moments(1);
  GnssInput input{fixes, moments, {0, 0}, std::nullopt};
  input.claimed = claimed;
  waymark_test::full_registry().make_gnss_modeling("correlated", options)->extend(input, graph);
  return 1 / std::sqrt(fix_of(graph).information(0, 0));
}

}  // namespace

TEST_CASE("correlated: tails are Student's t, or normal") {
  const Options sigma = {{"white_sigma", "2"}};
  Options normal = sigma;
  normal["tails"] = "normal";
  const Graph students = graph_with(sigma);
  const Graph plain = graph_with(normal);
  const BuiltFix student = fix_of(students);
  const BuiltFix gauss = fix_of(plain);
  // The claimed accuracy is the median: the white sigma is 2 m.
  CHECK(gauss.information.isApprox(Eigen::Matrix2d::Identity() / 4));
  CHECK(gauss.loss == nullptr);
  // -2 log of the density of Student's t with four degrees of freedom in the plane: 6 log(1 + q /
  // 4).
  REQUIRE(student.loss != nullptr);
  for (const double metres : {0.0, 0.5, 2.0, 10.0, 100.0}) {
    const double q = metres * metres / 4;
    const double squared = student.information(0, 0) * metres * metres;
    CHECK(student.loss->at(squared).rho == Approx(6 * std::log1p(q / 4)));
  }
  CHECK_THROWS_WITH(graph_with({{"tails", "cauchy"}}),
                    Contains("tails") && Contains("student") && Contains("normal"));
}

TEST_CASE("correlated: errors are those expected over what is known of the exponent, at most as claimed") {
  const double mean = 0.5;
  const double sigma = 0.2;
  ClaimedAccuracies claimed;
  claimed.median_m[0] = 1;
  const auto relative = [&](double claim) {
    return white_sigma_of(FixQuality::unknown, claim, claimed,
                          {{"white_sigma", "1"}, {"tails", "normal"}, {"accuracy_exponent_sigma", "0.2"}});
  };
  for (const double claim : {0.5, 1.0, 2.0, 6.0}) {
    // The mean of claim^(2 p), by the midpoints of 10000 parts of +-6 sigma.
    double variance = 0;
    double weights = 0;
    for (int i = -5000; i < 5000; ++i) {
      const double z = 6 * (i + 0.5) / 5000;
      const double weight = std::exp(-0.5 * z * z);
      variance += weight * std::pow(claim, 2 * (mean + sigma * z));
      weights += weight;
    }
    CHECK(relative(claim) == Approx(std::sqrt(variance / weights)).epsilon(1e-4));
  }
  CHECK(relative(1e4) < 1e4);
  CHECK(relative(1e4) > relative(100));
}

TEST_CASE("correlated: sigmas hold for the claims that they are stated for") {
  ClaimedAccuracies claimed;
  claimed.median_m = {std::nullopt, 1.5, 0.02};
  const auto sigma_of = [&](FixQuality quality, const Options& reference) {
    Options options = {{"white_sigma", "0.03"}, {"tails", "normal"}, {"kind_exponent", "1"}};
    options.insert(reference.begin(), reference.end());
    return white_sigma_of(quality, quality == FixQuality::fixed ? 0.02 : 1.5, claimed, options);
  };
  // The sigma of a drive with fixed ambiguities alone, whose claims are 2 cm.
  const Options fixed = {{"reference_accuracy", "0.02"}};
  CHECK(sigma_of(FixQuality::fixed, fixed) == Approx(0.03));
  CHECK(sigma_of(FixQuality::floating, fixed) == Approx(0.03 * 1.5 / 0.02));
  // By default that of the coarsest kind.
  CHECK(sigma_of(FixQuality::floating, {}) == Approx(0.03));
}

TEST_CASE("correlated: a kind that claims nothing is as much coarser as its stand-ins are") {
  Fix code;
  code.status = FixStatus::accepted;
  code.told.quality = FixQuality::single;
  code.accuracy_claimed = false;
  code.covariance = 9 * Eigen::Matrix2d::Identity();
  Fix fixed = code;
  fixed.told.quality = FixQuality::fixed;
  fixed.accuracy_claimed = true;
  fixed.covariance = 0.02 * 0.02 * Eigen::Matrix2d::Identity();
  const Options options = {{"white_sigma", "1.5"}, {"tails", "normal"}, {"kind_exponent", "1"}};
  const ClaimedAccuracies both = claimed_accuracies(std::vector{code, fixed});
  CHECK(both.reference_m() == Approx(3));
  CHECK(white_sigma_of(FixQuality::fixed, 0.02, both, options) == Approx(1.5 * 0.02 / 3));
  // Alone, it says nothing.
  const ClaimedAccuracies alone = claimed_accuracies(std::vector{code});
  CHECK(alone.reference_m() == 0);
  CHECK(alone.of(SolutionKind::code) == 0);
}

TEST_CASE("correlated: a loss that is asked for replaces that of the tails") {
  const LossType huber = builtin_losses().front();
  for (const char* tails : {"student", "normal"}) {
    const Graph graph = graph_with({{"tails", tails}}, Loss{huber.name, huber.evaluate, 1.5});
    REQUIRE(fix_of(graph).loss != nullptr);
    CHECK(*fix_of(graph).loss == Loss{huber.name, huber.evaluate, 1.5});
  }
}

TEST_CASE("correlated: the lasting errors of other fixes are those of a Gaussian process") {
  const TypeRegistry registry = waymark_test::full_registry();
  const Options options = {{"tails", "normal"},      {"white_sigma", "0.5"},    {"multipath_sigma", "3"},
                           {"multipath_time", "30"}, {"bias_floor", "0.8"},     {"bias_share", "0.5"},
                           {"bias_time", "2000"},    {"accuracy_exponent", "0"}};
  // The vehicle stands at a known place, so that each fix shows its error.
  const std::vector<double> times = {0, 10, 20, 60, 70};
  const std::vector<Eigen::Vector2d> errors = {{1, 4}, {2, 3}, {-1, 2}, {5, 0}, {4, -1}};
  const auto fix_at = [](double time_s, const Eigen::Vector2d& error) {
    Fix fix;
    fix.stamp = Stamp::from_seconds(time_s);
    fix.vertex = VertexId{1};
    fix.covariance = Eigen::Matrix2d::Identity();
    fix.position = Eigen::Vector2d(7, -2) + error;
    return fix;
  };
  Graph graph;
  graph.set_fixed(graph.add_vertex<VertexSe2>(VertexId{1}, {7, -2, 0.3}), true);
  std::vector<Fix> known;
  for (std::size_t i = 0; i < times.size(); ++i) known.push_back(fix_at(times[i], errors[i]));
  const auto modeling = registry.make_gnss_modeling("correlated", options);
  modeling->extend({known, std::vector<FixMoment>(known.size()), {0, 0}, std::nullopt}, graph);
  REQUIRE(optimize(graph).summary.converged());

  const auto covariance = [](double a, double b) {
    const double bias = 0.8 * 0.8 + 0.5 * 0.5 * 3 * 3;
    const double first = 0.5 * 0.5 * 0.5 * 0.5;  // at 0 s
    return bias * std::exp(-std::abs(a - b) / 2000) + first * std::exp(-(std::abs(a) + std::abs(b)) / 2000) +
           9 * std::exp(-std::abs(a - b) / 30);
  };
  Eigen::MatrixXd gram(5, 5);
  Eigen::MatrixXd measured(5, 2);
  for (int i = 0; i < 5; ++i) {
    measured.row(i) = errors[static_cast<std::size_t>(i)];
    for (int j = 0; j < 5; ++j)
      gram(i, j) = covariance(times[static_cast<std::size_t>(i)], times[static_cast<std::size_t>(j)]) +
                   (i == j ? 0.25 : 0);
  }
  const Eigen::MatrixXd weights = gram.ldlt().solve(measured);
  for (const double time_s : {-40.0, 4.0, 10.0, 45.0, 100.0}) {
    Eigen::RowVectorXd to_known(5);
    for (int i = 0; i < 5; ++i) to_known[i] = covariance(time_s, times[static_cast<std::size_t>(i)]);
    const Eigen::Vector2d expected = (to_known * weights).transpose();
    const std::vector<Fix> asked{fix_at(time_s, {0, 0})};
    const std::vector<ExpectedError> predicted = modeling->lasting_errors(asked, graph);
    REQUIRE(predicted.size() == 1);
    INFO(time_s);
    CHECK((predicted[0].mean(graph) - expected).norm() < 1e-6);

    const double variance =
        covariance(time_s, time_s) + 0.25 - to_known * gram.ldlt().solve(to_known.transpose());
    CHECK((covariance_of(predicted[0], graph) - variance * Eigen::Matrix2d::Identity()).norm() < 1e-6);
  }
  CHECK(registry.make_gnss_modeling("g1", {})->lasting_errors(known, graph).empty());
}

}  // namespace gnss_correlated_test
