// Every registered edge type: its Jacobians against differences, finite at extremes.
#include <cmath>
#include <numbers>
#include <random>

#include <catch2/catch.hpp>

#include <waymark/core/graph/checks/edge_type_check.hpp>
#include <waymark/types_se2/edge_se2.hpp>

#include "support/dense.hpp"
#include "support/registry.hpp"
#include "support/vertex_body_pose.hpp"

using namespace waymark;

namespace {

constexpr double kHalfTurn = std::numbers::pi;

template <typename Visit>
void for_each_case(const TypeRegistry& registry, int repetitions, Visit visit) {
  for (const auto& [type, origin] : registry.edges()) {
    for (const EdgeScenario& scenario : edge_scenarios()) {
      INFO(type.tag << ", " << scenario.name);
      std::mt19937_64 random(11);
      for (int i = 0; i < repetitions; ++i) visit(single_edge(registry, type, scenario, random));
    }
  }
}

}  // namespace

TEST_CASE("every edge type: given Jacobians are those of differences of the error") {
  int cases = 0;
  int without_derivative = 0;
  for_each_case(waymark_test::full_registry(), 50, [&](const Graph& graph) {
    Eigen::VectorXd error;
    std::vector<Eigen::MatrixXd> given;
    graph.batch(0).linearize_edge(0, graph.view(), error, given);
    for (std::size_t k = 0; k < given.size(); ++k) {
      const auto expected = numeric_jacobian(graph, 0, 0, k);
      ++cases;
      if (!expected) {
        ++without_derivative;  // a bearing at the landmark itself
        continue;
      }
      CHECK((given[k] - expected->jacobian).cwiseAbs().maxCoeff() <= expected->tolerance);
    }
  });
  CHECK(without_derivative < cases / 20);
}

// At 1e9 m a coordinate is rounded by 1e-7 m, which is 1e-4 of the step of the differences.
TEST_CASE("every edge type: Jacobians far from the origin are not called wrong, and wrong ones are") {
  for (const double origin : {1e6, 1e9}) {
    Graph graph;
    graph.add_vertex<VertexSe2>(VertexId{0}, {origin, -origin, 1});
    graph.add_vertex<VertexSe2>(VertexId{1}, {origin + 3, -origin + 2, 2});
    graph.add_edge(EdgeSe2{{3, 2, 1}}, {0, 1}, Eigen::Matrix3d::Identity());
    const auto numeric = numeric_jacobian(graph, 0, 0, 1);
    REQUIRE(numeric);
    CHECK(numeric->tolerance < 2e-3);
    CHECK(check_gradients(graph, 0, 1).judged == 2);
    CHECK(check_gradients(graph, 0, 1).error < kGradientTolerance);
    // d e / d (x, y) of the second pose is (R(1) R(1))^T, of pose and measurement: differences tell it as well as they claim.
    CHECK(std::abs(numeric->jacobian(0, 0) - std::cos(2)) <= numeric->tolerance);
    CHECK(std::abs(numeric->jacobian(0, 1) - std::sin(2)) <= numeric->tolerance);
  }
}

TEST_CASE("every edge type: sound in the check that plugin authors run") {
  const TypeRegistry registry = waymark_test::full_registry();
  for (const auto& [type, origin] : registry.edges()) {
    const EdgeTypeCheck check = check_edge_type(registry, type);
    INFO(type.tag << ", " << check.scenario << ": " << describe(check.graph, 0, check.worst));
    CHECK(check.sound());
  }
}

TEST_CASE("every edge type: chi2 is e^T Omega e of the error that linearisation sees") {
  for_each_case(waymark_test::full_registry(), 5, [](const Graph& graph) {
    Eigen::VectorXd error;
    std::vector<Eigen::MatrixXd> unused;
    graph.batch(0).linearize_edge(0, graph.view(), error, unused);
    const double expected = error.dot(graph.batch(0).information(0) * error);
    CHECK(graph.chi2() == Approx(expected).epsilon(1e-6).margin(1e-24));
  });
}

TEST_CASE("every edge type: finite at coordinates of 1e7 and headings of pi") {
  const TypeRegistry registry = waymark_test::full_registry();
  for (const auto& [type, origin] : registry.edges()) {
    INFO(type.tag);
    std::mt19937_64 random(12);
    for (const double heading : {kHalfTurn, -kHalfTurn, 0.0, std::nextafter(kHalfTurn, 0)}) {
      for (const double field : {0.0, 1e-300, kHalfTurn, 1e3}) {
        const Graph graph = single_edge(registry, type, {"extreme", 1e7, heading, 0, field}, random);
        Eigen::VectorXd error;
        std::vector<Eigen::MatrixXd> jacobians;
        graph.batch(0).linearize_edge(0, graph.view(), error, jacobians);
        CHECK(error.allFinite());
        for (const Eigen::MatrixXd& jacobian : jacobians) CHECK(jacobian.allFinite());
        CHECK(std::isfinite(graph.chi2()));
      }
    }
  }
}

TEST_CASE("every edge type: an error of whole turns is no error") {
  // Heading components are compared modulo a turn: a vertex moved by 2 pi is the same vertex.
  for_each_case(waymark_test::full_registry(), 5, [](const Graph& graph) {
    for (VertexIndex v = 0; v < static_cast<VertexIndex>(graph.vertex_count()); ++v) {
      const VertexType& type = graph.vertex_type(v);
      if (type.tag != "VERTEX_SE2") continue;
      Graph turned = graph;
      std::vector<double> value(graph.value(v).begin(), graph.value(v).end());
      value[2] += 2 * kHalfTurn;  // not normalised
      turned.set_value(v, value);
      CHECK(turned.chi2() == Approx(graph.chi2()).epsilon(1e-6).margin(1e-12));
    }
  });
}

TEST_CASE("every edge type: the schema has names and a dimension") {
  for_each_case(waymark_test::full_registry(), 1, [](const Graph& graph) {
    const EdgeType& type = graph.edge_type(0);
    CHECK(graph.batch(0).error_dimension(0) > 0);
    for (const FieldInfo& field : type.fields) {
      CHECK_FALSE(field.name.empty());
      CHECK(field.size > 0);
    }
  });
}

TEST_CASE("Gaussian prior: it differentiates charts that are not linear, such as body-frame poses") {
  // local(r, X exp(d)) = log(r^-1 X exp(d)): its derivative is the inverse right Jacobian.
  TypeRegistry registry = waymark_test::full_registry();
  registry.add_vertex<waymark_test::VertexBodyPose>();
  Graph graph;
  const VertexIndex v =
      graph.add_vertex(*registry.find_vertex("VERTEX_BODY_POSE"), VertexId{0}, std::array{1.0, 2.0, 0.5});
  const std::array<double, 6> fields = {0.8, 2.2, -0.4, 0.01, 0.02, 0.03};
  graph.add_edge(*registry.find_edge("EDGE_GAUSSIAN_PRIOR"), std::array{v}, fields,
                 Eigen::Matrix3d::Identity());
  Eigen::VectorXd error;
  std::vector<Eigen::MatrixXd> jacobians;
  graph.batch(0).linearize_edge(0, graph.view(), error, jacobians);
  const Eigen::Vector3d xi = se2_log(between(Pose2<double>(0.8, 2.2, -0.4), Pose2<double>(1, 2, 0.5)));
  CHECK((error - (xi - Eigen::Vector3d(0.01, 0.02, 0.03))).norm() < 1e-14);
  CHECK((jacobians[0] - se2_right_jacobian_inverse(xi)).norm() < 1e-8);
}
