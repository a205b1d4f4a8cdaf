// An edge whose heading error is near half a turn. Where its information is correlated, chi2 jumps when that error
// passes the seam, and a descent on one side of the jump comes to an end at it.
#include <cmath>
#include <memory>
#include <numbers>
#include <string>

#include <catch2/catch.hpp>

#include <waymark/core/optimize/optimizer.hpp>
#include <waymark/types_se2/edge_se2.hpp>

#include "support/registry.hpp"

namespace heading_seam_test {

using namespace waymark;
using namespace waymark_test;

namespace {

/// One pose between two priors: one at the origin that couples x and heading, and one at (place, 0, heading).
struct Seam {
  double coupling = 0;
  double stiffness = 0;  ///< of the heading of the first prior
  double place = 0;
  double place_weight = 0;
  double heading = 0;

  [[nodiscard]] Graph graph(double start) const {
    Graph graph;
    graph.add_vertex<VertexSe2>(VertexId{0}, {place, 0, start});
    Eigen::Matrix3d coupled = Eigen::Vector3d(1, 1, stiffness).asDiagonal();
    coupled(0, 2) = coupled(2, 0) = coupling;
    graph.add_edge(EdgePriorSe2{Eigen::Vector3d::Zero()}, {0}, coupled);
    graph.add_edge(EdgePriorSe2{Eigen::Vector3d(place, 0, wrap_angle(heading))}, {0},
                   Eigen::Vector3d(place_weight, place_weight, 1).asDiagonal());
    return graph;
  }

  /// Returns chi2 at (x, 0, u) where the heading error of the second prior is u - aim.
  [[nodiscard]] double chi2(double x, double u, double aim) const {
    return x * x + 2 * coupling * x * u + stiffness * u * u + place_weight * std::pow(x - place, 2) +
           std::pow(u - aim, 2);
  }

  /// Returns the least chi2 of that quadratic form, from its two linear equations.
  [[nodiscard]] double least_chi2(double aim) const {
    Eigen::Matrix2d h;
    h << 1 + place_weight, coupling, coupling, stiffness + 1;
    const Eigen::Vector2d at = h.inverse() * Eigen::Vector2d(place_weight * place, aim);
    return chi2(at[0], at[1], aim);
  }
};

Summary minimized(Graph& graph, const std::string& algorithm) {
  const TypeRegistry registry = full_registry();
  const auto method = registry.make_algorithm(algorithm);
  const auto solver = registry.make_linear_solver("block_cholesky");
  return optimize(graph, *method, *solver, {});
}

}  // namespace

TEST_CASE("heading seam: a descent that ends at a jump of chi2 goes on beyond it") {
  const Seam seam{.coupling = -0.5, .stiffness = 1, .place = 2, .place_weight = 100, .heading = 6};
  const double beyond = seam.least_chi2(6 - 2 * std::numbers::pi);
  REQUIRE(beyond < seam.chi2(2, std::numbers::pi, 6) - 10);  // where the descent meets the jump
  for (const std::string algorithm : {"dogleg", "levenberg_marquardt", "gauss_newton"}) {
    Graph graph = seam.graph(3);
    const Summary summary = minimized(graph, algorithm);
    INFO(algorithm << ": " << summary.full());
    CHECK(summary.converged());
    CHECK(summary.final_chi2 == Approx(beyond).epsilon(1e-9));
    CHECK(summary.iterations < 40);
  }
}

TEST_CASE("heading seam: where all is higher beyond the jump, the run ends at it soon") {
  const Seam seam{.coupling = -0.3, .stiffness = 0.1, .place = 1, .place_weight = 1e6, .heading = 3.5};
  const double before = seam.chi2(1, std::numbers::pi, 3.5);
  REQUIRE(before < seam.least_chi2(3.5 - 2 * std::numbers::pi) - 1);
  for (const std::string algorithm : {"dogleg", "levenberg_marquardt"}) {
    Graph graph = seam.graph(2.5);
    const Summary summary = minimized(graph, algorithm);
    INFO(algorithm << ": " << summary.full());
    CHECK(summary.termination == Termination::stalled);
    CHECK(summary.message.find("jumps by 3.7") != std::string::npos);  // 4 * 0.3 * pi
    CHECK(summary.final_chi2 == Approx(before).epsilon(0.01));
    CHECK(summary.iterations < 120);
  }
}

}  // namespace heading_seam_test
