// What the functions of a plugin's types throw is told with the type, as a PluginError.
#include <catch2/catch.hpp>

#include <stdexcept>

#include <waymark/core/base/error.hpp>
#include <waymark/core/optimize/named_start.hpp>
#include <waymark/core/system/gauge.hpp>
#include <waymark/types_se2/edge_se2.hpp>

#include "support/registry.hpp"

namespace guarded_types_test {

using namespace waymark;
using Catch::Matchers::Contains;
using Catch::Matchers::Message;
using waymark_test::full_registry;

namespace {

enum class Throws { nothing, position, rigid_motion };

/// A point whose place cannot be told.
template <Throws kThrows>
struct VertexPoint {
  static constexpr std::string_view kTag = "VERTEX_TEST_POINT";
  static constexpr int kValueSize = 2;
  static constexpr int kTangentSize = 2;
  static constexpr std::array<std::string_view, 2> value_names() { return {"x", "y"}; }
  template <typename T>
  static Vector2<T> at(const double* value, const T* delta) {
    return {delta[0] + T(value[0]), delta[1] + T(value[1])};
  }
  static void retract(double* value, const double* delta) { VertexXy::retract(value, delta); }
  static void local(const double* from, const double* to, double* delta) { VertexXy::local(from, to, delta); }
  static Eigen::Vector2d position(const double* value) {
    if (kThrows == Throws::position) throw std::runtime_error("no place");
    return {value[0], value[1]};
  }
  static void rigid_motion(const double* value, const Eigen::Vector2d& centre, double extent,
                           double* columns) {
    if (kThrows == Throws::rigid_motion) throw std::runtime_error("no motion");
    VertexXy::rigid_motion(value, centre, extent, columns);
  }
};

template <typename V>
struct EdgePlace {
  static constexpr std::string_view kTag = "EDGE_TEST_PLACE";
  static constexpr int kErrorDimension = 2;
  using Vertices = VertexList<V>;
  static constexpr auto fields() { return std::array{field<&EdgePlace::measured>("measured")}; }
  template <typename T>
  Vector2<T> error(const Vector2<T>& point) const {
    return point - constant_vector<T>(measured);
  }
  Eigen::Vector2d measured{0, 0};
};

/// Its measurement is refused by its own code.
struct EdgeUnprepared {
  static constexpr std::string_view kTag = "EDGE_TEST_UNPREPARED";
  static constexpr int kErrorDimension = 1;
  using Vertices = VertexList<VertexSe2, VertexXy>;
  static constexpr auto fields() { return std::array{field<&EdgeUnprepared::measured>("measured")}; }
  template <typename T>
  Eigen::Matrix<T, 1, 1> error(const Pose2<T>& pose, const Vector2<T>& point) const {
    return Eigen::Matrix<T, 1, 1>(length(Vector2<T>(point - pose.position)) - T(measured));
  }
  void prepare() {
    if (measured < 0) throw std::invalid_argument("negative range");
  }
  [[nodiscard]] Sight sight() const { throw std::logic_error("no sight"); }
  double measured = 0;
};

template <Throws kThrows>
Graph one_point() {
  using V = VertexPoint<kThrows>;
  Graph graph;
  graph.add_vertex(make_vertex_type<V>(), VertexId{1}, std::array{1.0, 2.0});
  graph.add_edge(make_edge_type<EdgePlace<V>>(), std::array{0}, std::array{1.0, 2.0},
                 Eigen::Matrix2d::Identity());
  return graph;
}

Graph pose_and_point() {
  Graph graph;
  graph.add_vertex<VertexSe2>(VertexId{1}, {0, 0, 0});
  graph.add_vertex<VertexXy>(VertexId{2}, {3, 4});
  return graph;
}

InitialValues one_number(const Graph&) {
  return {{1.0}, "", 0};
}

}  // namespace

TEST_CASE("guard: a vertex type that throws where its place or motion is asked for is named") {
  CHECK(find_gauge(one_point<Throws::nothing>()).messages.empty());
  CHECK_THROWS_MATCHES(find_gauge(one_point<Throws::position>()), PluginError,
                       Message("VERTEX_TEST_POINT: position: threw: no place"));
  CHECK_THROWS_MATCHES(find_gauge(one_point<Throws::rigid_motion>()), PluginError,
                       Message("VERTEX_TEST_POINT: rigid_motion: threw: no motion"));
}

TEST_CASE("guard: a sight that throws is told with its edge") {
  Graph graph = pose_and_point();
  graph.add_edge(EdgeUnprepared{5}, {0, 1}, Eigen::Matrix<double, 1, 1>(1));
  CHECK_THROWS_MATCHES(graph.batch(0).sight(0), PluginError,
                       Message("EDGE_TEST_UNPREPARED number 1: sight: threw: no sight"));
}

TEST_CASE("guard: an edge whose prepare throws is named and does not enter, on either way") {
  Graph graph = pose_and_point();
  const EdgeType type = make_edge_type<EdgeUnprepared>();
  const Eigen::MatrixXd one = Eigen::MatrixXd::Identity(1, 1);
  graph.add_edge(type, std::array{0, 1}, std::array{5.0}, one);
  const char* told = "EDGE_TEST_UNPREPARED number 2: prepare: threw: negative range";
  CHECK_THROWS_MATCHES(graph.add_edge(type, std::array{0, 1}, std::array{-5.0}, one), PluginError,
                       Message(told));
  CHECK_THROWS_MATCHES(graph.add_edge(EdgeUnprepared{-5}, {0, 1}, Eigen::Matrix<double, 1, 1>(1)),
                       PluginError, Message(told));
  CHECK(graph.edge_count() == 1);
  CHECK(graph.chi2() == 0);
}

TEST_CASE("guard: a loss that throws is named, and not the edge that has it") {
  Graph graph = pose_and_point();
  graph.add_edge(EdgeUnprepared{1}, {0, 1}, Eigen::Matrix<double, 1, 1>(1));
  graph.batch(0).set_loss(
      Loss{"steep", [](double, double) -> LossValue { throw std::domain_error("too far"); }});
  try {
    (void)graph.chi2();
    FAIL("it throws");
  } catch (const PluginError& error) {
    CHECK(std::string(error.what()) == "loss 'steep': threw: too far");
    CHECK(error.type() == "steep");
  }
}

TEST_CASE("guard: an initial guess of another length is named, also where the best one is searched for") {
  TypeRegistry registry = full_registry();
  registry.set_origin("guesses");
  registry.add_start({"one_number", "", one_number});
  const char* told =
      "plugin 'guesses': initial guess 'one_number': made 1 numbers for a graph of 5; they must be in the "
      "layout of Graph::values()";
  CHECK_THROWS_MATCHES(registry.make_start("one_number", pose_and_point()), PluginError, Message(told));
  CHECK_THROWS_MATCHES(registry.starts().back().type.make(pose_and_point()), PluginError, Message(told));
}

}  // namespace guarded_types_test
