// Every registered loss: derivatives by differences, weights in [0, 1], continuity, the formulas of
// its literature.
#include <cmath>
#include <random>

#include <Eigen/Eigenvalues>
#include <catch2/catch.hpp>

#include <waymark/core/graph/detail/robust_information.hpp>
#include <waymark/core/robust/edge_selection.hpp>
#include <waymark/core/system/normal_equations.hpp>

#include "support/problems.hpp"
#include "support/registry.hpp"

using namespace waymark;

namespace {

const std::vector<double> kScales = {0.3, 1, 2.5, 10};

/// Squared errors around and far from every threshold that a loss of this scale may have.
std::vector<double> squares(double scale) {
  std::vector<double> result = {1e-12, 1e-3, 0.13, 0.97, 7.3, 103, 1.1e4, 1e8};
  for (const double threshold : {scale, scale * scale}) {
    for (const double factor : {0.5, 0.99, 1.01, 2.0}) result.push_back(threshold * factor);
  }
  return result;
}

LossType find(const std::string& name) {
  return *waymark_test::registry().find_loss(name);
}

}  // namespace

TEST_CASE("losses: the losses that the house names are registered") {
  for (const char* name : {"huber", "cauchy", "tukey", "geman_mcclure", "welsch", "dcs"}) {
    CHECK(waymark_test::registry().find_loss(name) != nullptr);
  }
}

TEST_CASE("every loss: weight is rho' and curvature is rho''") {
  for (const auto& [loss, origin] : waymark_test::registry().losses()) {
    for (const double scale : kScales) {
      for (const double s : squares(scale)) {
        INFO(loss.name << " scale " << scale << " s " << s);
        const double step = 1e-4 * s;
        const LossValue at = loss.evaluate(s, scale);
        const LossValue up = loss.evaluate(s + step, scale);
        const LossValue down = loss.evaluate(s - step, scale);
        CHECK(at.weight ==
              Approx((up.rho - down.rho) / (2 * step)).epsilon(1e-6).margin(1e-12 * at.rho / step));
        CHECK(at.curvature ==
              Approx((up.weight - down.weight) / (2 * step)).epsilon(1e-6).margin(1e-12 / step));
      }
    }
  }
}

TEST_CASE(
    "every loss: weights lie in 0 to 1 and never grow, rho starts at 0 with slope 1 and never exceeds s") {
  for (const auto& [loss, origin] : waymark_test::registry().losses()) {
    for (const double scale : kScales) {
      INFO(loss.name << " scale " << scale);
      CHECK(loss.evaluate(0, scale).rho == 0);
      CHECK(loss.evaluate(0, scale).weight == 1);
      double last_weight = 1;
      double last_rho = 0;
      for (double s = 1e-9; s < 1e12; s *= 1.3) {
        const LossValue at = loss.evaluate(s, scale);
        REQUIRE(at.weight >= 0);
        REQUIRE(at.weight <= last_weight * (1 + 1e-12));
        REQUIRE(at.rho >= last_rho * (1 - 1e-12));
        REQUIRE(at.rho <= s * (1 + 1e-12));
        REQUIRE(at.curvature <= 0);
        last_weight = at.weight;
        last_rho = at.rho;
      }
    }
  }
}

TEST_CASE("every loss: it is continuous with a continuous weight at scale and scale squared") {
  for (const auto& [loss, origin] : waymark_test::registry().losses()) {
    for (const double scale : kScales) {
      for (const double threshold : {scale, scale * scale}) {
        INFO(loss.name << " scale " << scale);
        const LossValue below = loss.evaluate(threshold * (1 - 1e-12), scale);
        const LossValue above = loss.evaluate(threshold * (1 + 1e-12), scale);
        CHECK(below.rho == Approx(above.rho).epsilon(1e-11));
        CHECK(below.weight == Approx(above.weight).epsilon(1e-9).margin(1e-11));
      }
    }
  }
}

TEST_CASE("losses: Huber is quadratic up to k, then linear in |e| with slope 2k") {
  const LossType huber = find("huber");
  CHECK(huber.evaluate(3.9, 2).rho == 3.9);
  CHECK(huber.evaluate(100, 2).rho == Approx(2 * 2 * 10 - 4));
  CHECK(huber.evaluate(100, 2).weight == Approx(0.2));
}

TEST_CASE("losses: Tukey keeps its digits for tiny errors: rho = s (1 - s/c^2 + ...)") {
  CHECK(find("tukey").evaluate(1e-18, 10).rho == Approx(1e-18).epsilon(1e-15));
}

TEST_CASE("losses: Tukey is constant beyond c: a third of c squared") {
  CHECK(find("tukey").evaluate(26, 5).rho == Approx(25.0 / 3));
  CHECK(find("tukey").evaluate(26, 5).weight == 0);
}

TEST_CASE("losses: DCS is as its paper has it, continued without a jump") {
  const LossType dcs = find("dcs");
  for (const double phi : kScales) {
    for (const double s : squares(phi)) {
      INFO("phi " << phi << " s " << s);
      const LossValue at = dcs.evaluate(s, phi);
      CHECK(at.rho == Approx(s <= phi ? s : 4 * phi * s / (phi + s) - phi));
      CHECK(at.weight == Approx(s <= phi ? 1 : std::pow(2 * phi / (phi + s), 2)));
      // The weight is the square of the scaling of Agarwal et al. (2013): min(1, 2 phi / (phi +
      // s)).
      CHECK(std::sqrt(at.weight) == Approx(std::min(1.0, 2 * phi / (phi + s))));
    }
  }
}

TEST_CASE("every loss: g of the normal equations is half the derivative of the robust chi2") {
  for (const auto& [type, origin] : waymark_test::registry().losses()) {
    INFO(type.name);
    Graph graph = waymark_test::noisy_circle(12);
    graph.batch(0).set_loss(Loss{type.name, type.evaluate, 1.7});
    graph.batch(0).set_loss(3, Loss{type.name, type.evaluate, 0.4});
    Structure structure;
    structure.build(graph, std::vector<char>(12, 0));
    NormalEquations equations(graph, structure);
    CHECK(equations.linearize(graph.values()) == Approx(graph.chi2()).epsilon(1e-13));
    const Eigen::VectorXd direction = Eigen::VectorXd::LinSpaced(36, -1, 1);
    const auto chi2_at = [&](double t) {
      std::vector<double> moved;
      equations.retract(graph.values(), t * direction, moved);
      return equations.chi2(moved);
    };
    constexpr double kStep = 1e-5;
    const double slope = (chi2_at(kStep) - chi2_at(-kStep)) / (2 * kStep);
    CHECK(2 * equations.gradient().dot(direction) == Approx(slope).epsilon(1e-5).margin(1e-6));
  }
}

TEST_CASE("losses: a loss on one edge leaves the others as they are") {
  Graph graph = waymark_test::noisy_circle(12);
  const double plain = graph.chi2();
  Eigen::VectorXd e;
  std::vector<Eigen::MatrixXd> unused;
  graph.batch(0).linearize_edge(14 - 2, graph.view(), e, unused);
  const double s = e.dot(graph.batch(0).information(12) * e);
  const LossType dcs = find("dcs");
  graph.batch(0).set_loss(12, Loss{"dcs", dcs.evaluate, 0.5 * s});
  CHECK(graph.chi2() == Approx(plain - s + dcs.evaluate(s, 0.5 * s).rho).epsilon(1e-12));
}

namespace {

/// Pseudo-Huber, as a plugin would bring it: 2 k^2 (sqrt(1 + s/k^2) - 1).
LossValue pseudo_huber(double s, double k) {
  const double root = std::sqrt(1 + s / (k * k));
  return {2 * s / (root + 1), 1 / root, -0.5 / (k * k * root * root * root)};
}

/// The registered losses and one that is not.
std::vector<LossType> losses_and_a_foreign_one() {
  std::vector<LossType> result;
  for (const auto& [loss, origin] : waymark_test::registry().losses()) result.push_back(loss);
  result.push_back({"pseudo_huber", &pseudo_huber, ""});
  return result;
}

/// A Gaussian over one pose: its error is linear in the pose, so nothing but the loss bends chi2.
Graph gaussian_over_a_pose(const Loss& loss, const Eigen::Vector3d& away) {
  Graph graph;
  const VertexIndex v = graph.add_vertex<VertexSe2>(VertexId{0}, {away[0], away[1], away[2]});
  Eigen::Matrix3d information;
  information << 4, 1, 0.5, 1, 3, -0.4, 0.5, -0.4, 2;
  graph.add_edge(gaussian_prior_type(), std::vector<VertexIndex>{v}, std::vector<double>(6, 0.0),
                 information);
  graph.batch(0).set_loss(loss);
  return graph;
}

Eigen::Matrix3d hessian_of_one_pose(const Graph& graph, Eigen::Vector3d* gradient = nullptr) {
  Structure structure;
  structure.build(graph, std::vector<char>(1, 0));
  NormalEquations equations(graph, structure);
  equations.linearize(graph.values());
  if (gradient != nullptr) *gradient = equations.gradient();
  return Eigen::Map<const Eigen::Matrix3d>(equations.hessian().data());
}

}  // namespace

TEST_CASE("every loss: H is the true Hessian of chi2 wherever the second-order term is kept") {
  int kept = 0;
  for (const LossType& type : losses_and_a_foreign_one()) {
    for (const double scale : kScales) {
      for (const double size : {0.02, 0.1, 0.3, 0.7, 1.5}) {
        const Loss loss{type.name, type.evaluate, scale};
        const Eigen::Vector3d place = size * Eigen::Vector3d(0.8, -0.5, 0.9);
        const Graph graph = gaussian_over_a_pose(loss, place);
        const double s = squared_error(graph, {0, 0});
        const double factor = curvature_factor(loss.at(s), s);
        INFO(type.name << " scale " << scale << " s " << s << " factor " << factor);
        if (factor == 1) continue;  // left out, or no bend here
        ++kept;
        Eigen::Matrix3d by_differences;
        constexpr double kStep = 1e-6;
        for (int i = 0; i < 3; ++i) {
          Eigen::Vector3d side[2];
          for (const int sign : {0, 1}) {
            const Eigen::Vector3d moved = place + (2 * sign - 1) * kStep * Eigen::Vector3d::Unit(i);
            (void)hessian_of_one_pose(gaussian_over_a_pose(loss, moved), &side[sign]);
          }
          by_differences.col(i) = (side[1] - side[0]) / (2 * kStep);
        }
        CHECK(hessian_of_one_pose(graph).isApprox(by_differences, 1e-6));
      }
    }
  }
  CHECK(kept > 30);
}

TEST_CASE(
    "every loss: the information with its second-order term is positive definite wherever the weight is") {
  std::mt19937_64 random(7);
  std::normal_distribution<double> unit(0, 1);
  for (const LossType& type : losses_and_a_foreign_one()) {
    for (const double scale : kScales) {
      for (const double s : squares(scale)) {
        Eigen::Matrix3d root;
        for (double& x : root.reshaped()) x = unit(random);
        const Eigen::Matrix3d information = root * root.transpose() + 0.1 * Eigen::Matrix3d::Identity();
        Eigen::Vector3d e(unit(random), unit(random), unit(random));
        e *= std::sqrt(s / e.dot(information * e));
        const LossValue loss = type.evaluate(s, scale);
        const Eigen::Matrix3d robust = robust_information(loss, s, information, e);
        INFO(type.name << " scale " << scale << " s " << s);
        const Eigen::Vector3d eigenvalues =
            Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(robust).eigenvalues();
        const double weakest = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(information).eigenvalues()[0];
        CHECK(eigenvalues[0] >= loss.weight * kLeastCurvature * weakest * (1 - 1e-9));
      }
    }
  }
}

TEST_CASE(
    "every loss: a stretch m turns rho(s) into m rho(s / m), for Geman-McClure the scale into sqrt(m) c") {
  for (const LossType& type : losses_and_a_foreign_one()) {
    const Loss stretched{type.name, type.evaluate, 1.3, 9};
    const LossValue at = stretched.at(7);
    const LossValue plain = type.evaluate(7.0 / 9, 1.3);
    CHECK(at.rho == Approx(9 * plain.rho));
    CHECK(at.weight == plain.weight);
    CHECK(at.curvature == Approx(plain.curvature / 9));
  }
  const LossType type = find("geman_mcclure");
  CHECK(Loss{"geman_mcclure", type.evaluate, 2, 9}.at(7).rho == Approx(type.evaluate(7, 6).rho));
}
