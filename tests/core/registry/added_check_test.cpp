// What a model of a plugin adds to a graph must be usable, or the model is named at once.
#include <catch2/catch.hpp>

#include <cmath>

#include <waymark/core/base/error.hpp>
#include <waymark/types_se2/g2o_edges.hpp>
#include <waymark/types_se2/vertex_se2.hpp>

#include "support/registry.hpp"

namespace added_check_test {

using namespace waymark;
using Catch::Matchers::Contains;

namespace {

using Add = void (*)(Graph& graph);

struct Adding final : SensorModel {
  explicit Adding(Add add) : add_(add) {}
  void extend(const SensorInput&, Graph& graph) override { add_(graph); }
  Add add_;
};

/// Returns a graph with one pose, extended by the model.
Graph extended(Add add) {
  TypeRegistry registry = waymark_test::full_registry();
  registry.set_origin("uwb");
  registry.add_sensor_model(
      {"ranges", "", {}, {}, [add](const CheckedOptions&) { return std::make_unique<Adding>(add); }});
  Graph graph;
  graph.add_vertex<VertexSe2>(VertexId{7}, {0, 0, 0});
  graph.add_edge(EdgePriorSe2Xy{}, {0}, Eigen::Matrix2d::Identity());
  const SensorTable readings;
  registry.make_sensor_model("ranges", {})->extend({{}, {}, {0, 0}, readings}, graph);
  return graph;
}

void add_fix(Graph& graph, double x, const Eigen::Matrix2d& information) {
  graph.add_edge(EdgePriorSe2Xy{Eigen::Vector2d(x, 0)}, {0}, information);
}

}  // namespace

TEST_CASE("added: what is usable enters, also without information on an axis or with a correlation") {
  CHECK(extended([](Graph& graph) { add_fix(graph, 1, Eigen::Vector2d(1, 0).asDiagonal()); }).edge_count() ==
        2);
  CHECK(extended([](Graph& graph) {
          const Eigen::Vector2d direction(3, 4);
          add_fix(graph, 1, direction * direction.transpose());  // singular
        }).edge_count() == 2);
}

TEST_CASE("added: what the graph refuses, and a loss without a function, are told with plugin and model") {
  const auto is_of_plugin = Contains("plugin 'uwb': sensor model 'ranges': ");
  CHECK_THROWS_AS(extended([](Graph& graph) {
                    graph.add_vertex<VertexSe2>(VertexId{7}, {0, 0, 0});
                  }),
                  UsageError);
  CHECK_THROWS_WITH(extended([](Graph& graph) {
                      graph.add_vertex<VertexSe2>(VertexId{7}, {0, 0, 0});
                    }),
                    is_of_plugin && Contains("vertex 7 exists already"));
  CHECK_THROWS_WITH(extended([](Graph& graph) {
                      add_fix(graph, 1, Eigen::Matrix2d::Identity());
                      graph.batch(0).set_loss(1, Loss{"mine", nullptr, 1});
                    }),
                    is_of_plugin && Contains("loss 'mine' has no function"));
}

TEST_CASE("added: numbers that are not finite are told with plugin, model and edge") {
  CHECK_THROWS_MATCHES(
      extended([](Graph& graph) { add_fix(graph, std::nan(""), Eigen::Matrix2d::Identity()); }), PluginError,
      Catch::Matchers::Message(
          "plugin 'uwb': sensor model 'ranges': added EDGE_PRIOR_SE2_XY number 2 (vertex "
          "7): a number of it is not finite"));
  CHECK_THROWS_WITH(
      extended([](Graph& graph) { add_fix(graph, 1, Eigen::Vector2d(std::nan(""), 1).asDiagonal()); }),
      Contains("number 2 (vertex 7): its information is not finite"));
  CHECK_THROWS_WITH(extended([](Graph& graph) {
                      graph.add_vertex<VertexXy>(VertexId{8}, std::array{double{INFINITY}, 0.0});
                    }),
                    Contains("'ranges': added VERTEX_XY 8: its value is not finite"));
}

TEST_CASE("added: indefinite information is told with plugin, model and edge") {
  CHECK_THROWS_WITH(extended([](Graph& graph) { add_fix(graph, 1, Eigen::Vector2d(1, -1).asDiagonal()); }),
                    Contains("sensor model 'ranges': added EDGE_PRIOR_SE2_XY number 2 (vertex 7): its "
                             "information is indefinite"));
}

}  // namespace added_check_test
