// Edge types that call themselves relative, carried Jacobians, prepare(): the promises that the fast
// linearisation needs, and its results for every registered type, edge by edge against dense
// algebra.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <random>

#include <catch2/catch.hpp>

#include "support/dense.hpp"
#include "support/problems.hpp"
#include "support/registry.hpp"
#include "support/vertex_body_pose.hpp"

using namespace waymark;
using namespace waymark_test;

namespace {

/// Relative, but its vertices cannot carry: the chart is in the body frame.
struct EdgeBodyMotion {
  static constexpr std::string_view kTag = "EDGE_BODY_MOTION";
  static constexpr std::string_view kForm = "log";
  static constexpr int kErrorDimension = 3;
  using Vertices = VertexList<VertexBodyPose, VertexBodyPose>;
  static constexpr bool kRelative = true;
  static constexpr auto fields() { return std::array{field<&EdgeBodyMotion::measured>("measured")}; }
  template <typename T>
  Vector3<T> error(const Pose2<T>& from, const Pose2<T>& to) const {
    return se2_log(between(constant_pose<T>(measured), between(from, to)));
  }
  Eigen::Vector3d measured = Eigen::Vector3d::Zero();
};

/// Says nothing of being relative, and is not: the difference in the frame's axes.
struct EdgeDifference {
  static constexpr std::string_view kTag = "EDGE_DIFFERENCE";
  static constexpr std::string_view kForm = "difference";
  static constexpr int kErrorDimension = 2;
  using Vertices = VertexList<VertexSe2, VertexSe2>;
  static constexpr auto fields() { return std::array{field<&EdgeDifference::measured>("measured")}; }
  template <typename T>
  Vector2<T> error(const Pose2<T>& from, const Pose2<T>& to) const {
    return to.position - from.position - constant_vector<T>(measured);
  }
  Eigen::Vector2d measured = Eigen::Vector2d::Zero();
};

/// Relative by inheritance of the member, but says no: must not be carried.
struct EdgeSaysNo : EdgeDifference {
  static constexpr std::string_view kTag = "EDGE_SAYS_NO";
  static constexpr bool kRelative = false;
  static constexpr auto fields() { return std::array{field<&EdgeDifference::measured>("measured")}; }
};

/// A relative error of dimension 1 over three poses: the angle at the second. Carrying is for two.
struct EdgeBend {
  static constexpr std::string_view kTag = "EDGE_BEND";
  static constexpr std::string_view kForm = "bend";
  static constexpr int kErrorDimension = 1;
  using Vertices = VertexList<VertexSe2, VertexSe2, VertexSe2>;
  static constexpr bool kRelative = true;
  static constexpr auto fields() { return std::array{field<&EdgeBend::measured>("measured")}; }
  template <typename T>
  Eigen::Matrix<T, 1, 1> error(const Pose2<T>& a, const Pose2<T>& b, const Pose2<T>& c) const {
    const Pose2<T> first = between(b, a);
    const Pose2<T> second = between(b, c);
    return Eigen::Matrix<T, 1, 1>(first.position[0] * second.position[1] -
                                  first.position[1] * second.position[0] - T(measured));
  }
  double measured = 0;
};

/// A distance: relative, carried, of error dimension 1, differentiated by dual numbers. Counts how
/// often it was prepared since its fields were set.
struct EdgeDistance {
  static constexpr std::string_view kTag = "EDGE_DISTANCE";
  static constexpr std::string_view kForm = "distance";
  static constexpr int kErrorDimension = 1;
  using Vertices = VertexList<VertexSe2, VertexSe2>;
  static constexpr bool kRelative = true;
  static constexpr auto fields() { return std::array{field<&EdgeDistance::measured>("measured")}; }
  template <typename T>
  Eigen::Matrix<T, 1, 1> error(const Pose2<T>& from, const Pose2<T>& to) const {
    using std::sqrt;
    const T x = to.position[0] - from.position[0];
    const T y = to.position[1] - from.position[1];
    return Eigen::Matrix<T, 1, 1>(sqrt(x * x + y * y) - T(prepared));
  }
  void prepare() { prepared += measured; }  // twice would be seen
  double measured = 0;
  double prepared = 0;
};

TypeRegistry registry_with_test_types() {
  TypeRegistry registry = full_registry();
  registry.add_vertex<VertexBodyPose>();
  registry.add_edge<EdgeBodyMotion>();
  registry.add_edge<EdgeDifference>();
  registry.add_edge<EdgeSaysNo>();
  registry.add_edge<EdgeBend>();
  registry.add_edge<EdgeDistance>();
  return registry;
}

/// Three vertices for every place in the type's list, and edges of the type among them, in both
/// directions.
Graph edges_of_type(const TypeRegistry& registry, const EdgeType& type, double place, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> unit(-1, 1);
  Graph graph;
  std::map<std::string, std::vector<VertexIndex>> by_tag;
  const bool runtime = type.arity == EdgeType::kRuntimeArity;
  std::vector<std::string> tags = type.vertex_tags;
  if (runtime) tags = {"VERTEX_SE2", "VERTEX_XY"};
  for (const std::string& tag : tags) {
    const VertexType& vertex = *registry.find_vertex(tag);
    for (int i = 0; i < 3; ++i) {
      std::vector<double> value;
      for (const std::string& name : vertex.value_names) {
        const bool is_place = vertex.value_units.empty() || vertex.value_units[value.size()] == "m";
        value.push_back(name == "heading" ? std::numbers::pi * unit(random)
                                          : (is_place ? place : 0) + 5 * unit(random));
      }
      by_tag[tag].push_back(graph.add_vertex(vertex, VertexId(graph.vertex_count()), value));
    }
  }
  for (int e = 0; e < 12; ++e) {
    std::vector<VertexIndex> vertices;
    std::vector<double> fields;
    Eigen::Index dimension = 0;
    for (const std::string& tag : tags) {
      const auto& choice = by_tag[tag];
      VertexIndex v;
      do {
        v = choice[random() % choice.size()];
      } while (std::find(vertices.begin(), vertices.end(), v) != vertices.end());
      vertices.push_back(v);
      dimension += graph.vertex_type(v).tangent_size;
      if (runtime) fields.insert(fields.end(), graph.value(v).begin(), graph.value(v).end());
    }
    const auto rest = runtime ? static_cast<int>(dimension) : type.field_size();
    for (int i = 0; i < rest; ++i) fields.push_back(0.5 + 0.4 * unit(random));
    if (!runtime) dimension = type.error_dimension;
    const Eigen::MatrixXd root =
        Eigen::MatrixXd::NullaryExpr(dimension, dimension, [&] { return unit(random); });
    const Eigen::MatrixXd information =
        root * root.transpose() + Eigen::MatrixXd::Identity(dimension, dimension);
    graph.add_edge(type, vertices, fields, 0.5 * (information + information.transpose()));
  }
  return graph;
}

/// J_k T_k, T_k the motion of vertex k when the plane moves along x, along y, or turns about the
/// origin.
Eigen::MatrixXd moved(const Graph& graph, VertexIndex v, const Eigen::MatrixXd& jacobian) {
  const VertexType& type = graph.vertex_type(v);
  Eigen::MatrixXd columns(type.tangent_size, 3);
  type.rigid_motion(graph.value(v).data(), {0, 0}, 1, columns.data());
  return jacobian * columns;
}

void check_against_dense(const Graph& graph, double tolerance = 1e-12) {
  const std::vector<char> nobody(graph.vertex_count(), 0);
  Structure structure;
  structure.build(graph, nobody);
  NormalEquations equations(graph, structure);
  CHECK(equations.linearize(graph.values()) == Approx(graph.chi2()).epsilon(1e-10));  // states up to 1e7
  const DenseSystem expected = assemble_dense(graph, nobody);
  const DenseSystem got = spread_out(graph, structure, equations);
  REQUIRE(got.start == expected.start);
  CHECK(relative_difference(got.hessian, expected.hessian) < tolerance);
  CHECK(relative_difference(got.gradient, expected.gradient) < tolerance);
}

template <typename E>
double chi2_of(Graph& graph) {
  static const EdgeType type = make_edge_type<E>();
  return graph.batch(type).chi2(graph.view());
}

}  // namespace

TEST_CASE("every relative edge type: its error does not see a rigid motion, sum of J_k T_k = 0") {
  const TypeRegistry registry = registry_with_test_types();
  int relative = 0;
  for (const auto& [type, origin] : registry.edges()) {
    if (!type.relative) continue;
    bool moves = true;
    for (const std::string& tag : type.vertex_tags)
      moves = moves && registry.find_vertex(tag)->rigid_motion != nullptr;
    if (!moves) continue;
    ++relative;
    INFO(type.tag);
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
      const Graph graph = edges_of_type(registry, type, 3, seed);
      Eigen::VectorXd error;
      std::vector<Eigen::MatrixXd> jacobians;
      for (std::size_t e = 0; e < graph.batch(0).size(); ++e) {
        graph.batch(0).linearize_edge(e, graph.view(), error, jacobians);
        Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(error.size(), 3);
        double size = 1;
        for (std::size_t k = 0; k < jacobians.size(); ++k) {
          const Eigen::MatrixXd part = moved(graph, graph.batch(0).vertices(e)[k], jacobians[k]);
          sum += part;
          size = std::max(size, part.cwiseAbs().maxCoeff());
        }
        CHECK(sum.cwiseAbs().maxCoeff() <= 1e-13 * size);
      }
    }
  }
  CHECK(relative >= 6);  // EDGE_SE2, its logarithm, GNSS, point, odometry, standstill
}

TEST_CASE(
    "every edge type: H, g and chi2 of its batch are those assembled edge by edge, with any vertex fixed") {
  const TypeRegistry registry = registry_with_test_types();
  for (const auto& [type, origin] : registry.edges()) {
    INFO(type.tag);
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
      Graph graph = edges_of_type(registry, type, 0, seed);
      check_against_dense(graph);
      for (VertexIndex v = 0; v < static_cast<VertexIndex>(graph.vertex_count()); ++v) {
        graph.set_fixed(v, true);
        check_against_dense(graph);
        graph.set_fixed(v, v % 2 == 0);  // more and more of them stay fixed
      }
      // Far from the origin differences of coordinates have fewer digits.
      check_against_dense(edges_of_type(registry, type, 3e5, seed), 1e-9);
    }
  }
}

TEST_CASE("every edge type: with a robust loss g is that of the weighted edges, with any vertex fixed") {
  const TypeRegistry registry = registry_with_test_types();
  for (const auto& [type, origin] : registry.edges()) {
    INFO(type.tag);
    Graph graph = edges_of_type(registry, type, 0, 3);
    graph.batch(0).set_loss(Loss{"cauchy", registry.find_loss("cauchy")->evaluate, 1.3});
    graph.set_fixed(1, true);
    const std::vector<char> nobody(graph.vertex_count(), 0);
    Structure structure;
    structure.build(graph, nobody);
    NormalEquations equations(graph, structure);
    CHECK(equations.linearize(graph.values()) == Approx(graph.chi2()).epsilon(1e-12));
    const DenseSystem expected = assemble_dense(graph, nobody);
    const DenseSystem got = spread_out(graph, structure, equations);
    CHECK(relative_difference(got.gradient, expected.gradient) < 1e-12);
  }
}

TEST_CASE("edges: a type is relative only where it says so") {
  CHECK(make_edge_type<EdgeSe2>().relative);
  CHECK(make_edge_type<EdgeBodyMotion>().relative);
  CHECK_FALSE(make_edge_type<EdgeDifference>().relative);
  CHECK_FALSE(make_edge_type<EdgeSaysNo>().relative);
  CHECK_FALSE(make_edge_type<EdgePriorSe2>().relative);
}

TEST_CASE(
    "edges: prepare is called once when an edge is appended, on every way, and a copy keeps its result") {
  const EdgeType type = make_edge_type<EdgeDistance>();
  Graph graph;
  graph.add_vertex<VertexSe2>(VertexId{0}, {0, 0, 0});
  graph.add_vertex<VertexSe2>(VertexId{1}, {3, 4, 0});
  const auto expect = [&](Graph& of, std::size_t edges) {
    REQUIRE(of.batch(0).size() == edges);
    CHECK(chi2_of<EdgeDistance>(of) == 0);  // |(3, 4)| - 5 for each
  };
  graph.add_edge(EdgeDistance{5}, {0, 1}, Eigen::Matrix<double, 1, 1>::Identity());
  expect(graph, 1);
  graph.add_edge(type, std::array{1, 0}, std::array{5.0}, Eigen::MatrixXd::Identity(1, 1));
  expect(graph, 2);
  Graph copy = graph;
  expect(copy, 2);
  copy = graph;
  expect(copy, 2);
  copy.add_edge(EdgeDistance{5}, {0, 1}, Eigen::Matrix<double, 1, 1>::Identity());
  expect(copy, 3);
  expect(graph, 2);
  // The stored number is no field: a text, and the edge read from it, have only the measurement.
  std::vector<double> fields;
  copy.batch(0).fields(2, fields);
  CHECK(fields == std::vector{5.0});
}
