// Every registered edge type: its Jacobians against dual numbers and against differences, finite at extremes.
#include <cmath>
#include <numbers>
#include <random>

#include <catch2/catch.hpp>

#include "support/dense.hpp"
#include "support/registry.hpp"
#include "support/vertex_body_pose.hpp"

using namespace waymark;

namespace {

constexpr double kPi = std::numbers::pi;

/// Draws one number of a vertex value (`heading` true where the name says so) or of a field.
struct Scenario {
  const char* name;
  double place;    ///< half range of coordinates
  double heading;  ///< headings lie around this...
  double spread;   ///< ...within this
  double field;    ///< half range of the fields
};

const Scenario kScenarios[] = {
    {"identity", 0, 0, 0, 0},
    {"tiny relative motion", 1e-8, 0.3, 1e-8, 1e-8},
    {"tiny relative motion at heading pi", 1e-8, kPi, 1e-8, 1e-8},
    {"headings on both sides of pi", 5, kPi, 0.1, 0.4},
    {"random", 5, 0, 1.4, 0.7},
    {"far away", 2000, 1, 0.5, 0.7},
};

/// A graph with one edge of the type, all numbers drawn from the scenario.
Graph single_edge(const TypeRegistry& registry, const EdgeType& type, const Scenario& scenario,
                  std::mt19937_64& random) {
  std::uniform_real_distribution<double> unit(-1, 1);
  Graph graph;
  std::vector<VertexIndex> vertices;
  std::size_t tangent_size = 0;
  std::vector<double> reference;
  const bool runtime = type.arity == EdgeType::kRuntimeArity;
  std::vector<std::string> tags = type.vertex_tags;
  if (runtime) {
    for (const auto& [vertex, origin] : registry.vertices()) tags.push_back(vertex.tag);
  }
  for (const std::string& tag : tags) {
    const VertexType* vertex = registry.find_vertex(tag);
    REQUIRE(vertex != nullptr);
    std::vector<double> value;
    for (const std::string& name : vertex->value_names) {
      value.push_back(name == "heading" ? scenario.heading + scenario.spread * unit(random)
                                        : scenario.place * unit(random));
    }
    const std::vector<double> zero(static_cast<std::size_t>(vertex->tangent_size), 0.0);
    vertex->retract(value.data(), zero.data());  // normalised
    vertices.push_back(graph.add_vertex(*vertex, static_cast<VertexId>(vertices.size()), value));
    tangent_size += zero.size();
    for (const double x : value) reference.push_back(x + scenario.field * unit(random));
  }
  std::vector<double> fields;
  if (runtime) fields = reference;
  const std::size_t rest = runtime ? tangent_size : static_cast<std::size_t>(type.field_size());
  for (std::size_t i = 0; i < rest; ++i) fields.push_back(scenario.field * unit(random));
  const auto n = runtime ? static_cast<Eigen::Index>(tangent_size) : Eigen::Index{type.error_dimension};
  const Eigen::MatrixXd root = Eigen::MatrixXd::NullaryExpr(n, n, [&] { return unit(random); });
  const Eigen::MatrixXd information = root * root.transpose() + Eigen::MatrixXd::Identity(n, n);
  graph.add_edge(type, vertices, fields, 0.5 * (information + information.transpose()));
  return graph;
}

/// Error of the one edge with vertex k moved by delta.
Eigen::VectorXd error_at(const Graph& graph, VertexIndex vertex, const Eigen::VectorXd& delta) {
  std::vector<double> values = graph.values();
  graph.vertex_type(vertex).retract(values.data() + graph.offsets()[static_cast<std::size_t>(vertex)],
                                    delta.data());
  Eigen::VectorXd error;
  std::vector<Eigen::MatrixXd> unused;
  graph.batch(0).linearize_edge(0, {values.data(), graph.offsets().data()}, error, unused);
  return error;
}

/// Whether the error has a derivative here. A point has no direction from its own place, so a bearing has
/// none.
bool is_differentiable(const Graph& graph) {
  if (graph.edge_type(0).tag != "EDGE_BEARING_SE2_XY") return true;
  const auto pose = graph.value(0);
  const auto point = graph.value(1);
  return pose[0] != point[0] || pose[1] != point[1];
}

/// Differences of fourth order: truncation and rounding both near 1e-12 of the error's size. The step is
/// shorter where the error is steep: a bearing at a distance r is smooth over steps that are small to r.
Eigen::MatrixXd numeric_jacobian(const Graph& graph, VertexIndex vertex, double steepness) {
  const double step = 2e-3 / std::max(1.0, steepness);
  const int n = graph.vertex_type(vertex).tangent_size;
  Eigen::MatrixXd jacobian(graph.batch(0).error_dimension(0), n);
  for (int c = 0; c < n; ++c) {
    const Eigen::VectorXd d = step * Eigen::VectorXd::Unit(n, c);
    jacobian.col(c) = (8 * (error_at(graph, vertex, d) - error_at(graph, vertex, -d)) -
                       (error_at(graph, vertex, 2 * d) - error_at(graph, vertex, -2 * d))) /
                      (12 * step);
  }
  return jacobian;
}

double magnitude(const Eigen::MatrixXd& m) {
  return 1 + (m.size() > 0 ? m.cwiseAbs().maxCoeff() : 0);
}

template <typename Visit>
void for_each_case(const TypeRegistry& registry, int repetitions, Visit visit) {
  for (const auto& [type, origin] : registry.edges()) {
    for (const Scenario& scenario : kScenarios) {
      INFO(type.tag << ", " << scenario.name);
      std::mt19937_64 random(11);
      for (int i = 0; i < repetitions; ++i) visit(single_edge(registry, type, scenario, random));
    }
  }
}

}  // namespace

TEST_CASE("every edge type: given Jacobians are those of dual numbers") {
  for_each_case(waymark_test::full_registry(), 50, [](const Graph& graph) {
    Eigen::VectorXd given_error;
    Eigen::VectorXd dual_error;
    std::vector<Eigen::MatrixXd> given;
    std::vector<Eigen::MatrixXd> dual;
    graph.batch(0).linearize_edge(0, graph.view(), given_error, given);
    graph.batch(0).differentiate_edge(0, graph.view(), dual_error, dual);
    REQUIRE(given.size() == dual.size());
    CHECK((given_error - dual_error).norm() <=
          1e-12 * magnitude(graph.batch(0).information(0)) * magnitude(dual_error));
    for (std::size_t k = 0; k < given.size(); ++k) {
      CHECK((given[k] - dual[k]).cwiseAbs().maxCoeff() <= 1e-12 * magnitude(dual[k]));
    }
  });
}

TEST_CASE("every edge type: given Jacobians are those of differences of the error") {
  for_each_case(waymark_test::full_registry(), 50, [](const Graph& graph) {
    Eigen::VectorXd error;
    std::vector<Eigen::MatrixXd> given;
    graph.batch(0).linearize_edge(0, graph.view(), error, given);
    // Differences cannot be taken across the jump of an angle.
    if (((error.cwiseAbs().array() - kPi).abs() < 0.02).any() || !is_differentiable(graph)) return;
    const bool bearing = graph.edge_type(0).tag == "EDGE_BEARING_SE2_XY";
    for (std::size_t k = 0; k < given.size(); ++k) {
      const double steepness = bearing ? given[k].cwiseAbs().maxCoeff() : 1;
      const Eigen::MatrixXd expected = numeric_jacobian(graph, graph.batch(0).vertices(0)[k], steepness);
      CHECK((given[k] - expected).cwiseAbs().maxCoeff() <=
            1e-9 * magnitude(error) * std::max(1.0, steepness));
    }
  });
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
    for (const double heading : {kPi, -kPi, 0.0, std::nextafter(kPi, 0)}) {
      for (const double field : {0.0, 1e-300, kPi, 1e3}) {
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
      value[2] += 2 * kPi;  // not normalised
      turned.set_value(v, value);
      CHECK(turned.chi2() == Approx(graph.chi2()).epsilon(1e-6).margin(1e-12));
    }
  });
}

TEST_CASE("every edge type: the schema has a form, names and a dimension") {
  for_each_case(waymark_test::full_registry(), 1, [](const Graph& graph) {
    const EdgeType& type = graph.edge_type(0);
    CHECK_FALSE(type.form.empty());
    CHECK(graph.batch(0).error_dimension(0) > 0);
    for (const FieldInfo& field : type.fields) {
      CHECK_FALSE(field.name.empty());
      CHECK(field.size > 0);
    }
  });
}

TEST_CASE("the Gaussian prior differentiates charts that are not linear, such as body-frame poses") {
  // local(r, X exp(d)) = log(r^-1 X exp(d)): its derivative is the inverse right Jacobian.
  TypeRegistry registry = waymark_test::full_registry();
  registry.add_vertex<waymark_test::VertexBodyPose>();
  Graph graph;
  const VertexIndex v =
      graph.add_vertex(*registry.find_vertex("VERTEX_BODY_POSE"), 0, std::array{1.0, 2.0, 0.5});
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
