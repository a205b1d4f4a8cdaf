// How a program puts values and edges into a graph, and takes them out.
#include <array>
#include <numbers>
#include <type_traits>

#include <catch2/catch.hpp>

#include <waymark/core/base/error.hpp>
#include <waymark/core/graph/graph.hpp>
#include <waymark/types_se2/edge_se2.hpp>
#include <waymark/version.hpp>

#include "support/scalar_types.hpp"

namespace graph_test {

using namespace waymark;
using namespace waymark_test;
using Catch::Contains;

TEST_CASE("graph: a value has the type that its vertex gives it") {
  Graph graph;
  const VertexIndex pose = graph.add_vertex<VertexSe2>(VertexId{7}, {1, 2, 0.5});
  const VertexIndex point = graph.add_vertex<VertexXy>(VertexId{8}, Eigen::Vector2d(3, 4));
  const VertexIndex scale = graph.add_vertex<VertexScale>(VertexId{9}, 1.5);
  static_assert(std::is_same_v<decltype(graph.value<VertexSe2>(pose)), Pose2<double>>);
  CHECK(graph.value<VertexSe2>(pose).vector() == Eigen::Vector3d(1, 2, 0.5));
  CHECK(graph.value<VertexXy>(point) == Eigen::Vector2d(3, 4));
  CHECK(graph.value<VertexScale>(scale) == 1.5);

  graph.set_value<VertexSe2>(pose, {5, 6, 3 * std::numbers::pi});
  CHECK(graph.value(pose)[2] == Approx(std::numbers::pi));
  graph.set_value<VertexXy>(point, {0, -1});
  graph.set_value<VertexScale>(scale, 2);
  CHECK(graph.values() == std::vector<double>{5, 6, graph.value(pose)[2], 0, -1, 2});

  CHECK_THROWS_WITH(graph.value<VertexXy>(pose), "vertex 7 is a VERTEX_SE2, not a VERTEX_XY");
  CHECK_THROWS_AS(graph.set_value<VertexSe2>(scale, {}), UsageError);
}

TEST_CASE("graph: ids and indices do not convert into each other") {
  static_assert(!std::is_convertible_v<VertexId, VertexIndex> &&
                !std::is_convertible_v<VertexIndex, VertexId>);
  static_assert(!std::is_convertible_v<int, VertexId> && !std::is_convertible_v<VertexId, std::int64_t>);
  CHECK(to_string(VertexId{-3}) == "-3");
  CHECK(to_number(VertexId{1LL << 40}) == 1LL << 40);
}

TEST_CASE("graph: an edge is named, and may come with a loss of its own") {
  Graph graph;
  const VertexIndex a = graph.add_vertex<VertexSe2>(VertexId{0}, {0, 0, 0});
  const VertexIndex b = graph.add_vertex<VertexSe2>(VertexId{1}, {3, 0, 0});
  const auto information = Eigen::Matrix3d::Identity();
  const EdgePlace plain = graph.add_edge(EdgeSe2{}, {a, b}, information);
  const EdgePlace prior = graph.add_edge(EdgePriorSe2{}, {b}, information);
  const EdgePlace robust = graph.add_edge(EdgeSe2{}, {a, b}, information, builtin_loss("huber", 1));
  CHECK(plain == EdgePlace{0, 0});
  CHECK(prior == EdgePlace{1, 0});
  CHECK(robust == EdgePlace{0, 1});
  CHECK(graph.batch(plain.batch).loss(plain.edge) == nullptr);
  REQUIRE(graph.batch(robust.batch).loss(robust.edge) != nullptr);
  CHECK(graph.batch(robust.batch).loss(robust.edge)->name == "huber");
  CHECK(graph.chi2() == Approx(9 + 9 + 5));  // huber: 2 k r - k^2
  graph.set_loss(prior, builtin_loss("huber", 1));
  CHECK(graph.chi2() == Approx(9 + 5 + 5));

  CHECK_THROWS_WITH(builtin_loss("hubert", 1), Contains("did you mean 'huber'?"));
  CHECK_THROWS_AS(builtin_loss("huber", 0), UsageError);
}

TEST_CASE("graph: information is its lower triangle, and an upper one that says something else is refused") {
  Graph graph;
  graph.add_vertex<VertexSe2>(VertexId{1}, {0, 0, 0});
  graph.add_vertex<VertexSe2>(VertexId{2}, {1, 0, 0});
  const EdgeType type = make_edge_type<EdgeSe2>();
  Eigen::Matrix3d lower = Eigen::Vector3d(4, 5, 6).asDiagonal();
  lower(1, 0) = 2;
  Eigen::Matrix3d mirrored = lower;
  mirrored(0, 1) = 2 * (1 + 1e-9);  // an inverse has such rounding
  for (const Eigen::Matrix3d& usable : {lower, mirrored}) {
    graph.add_edge(EdgeSe2{{1, 0, 0}}, {0, 1}, usable);
    CHECK(graph.batch(0).information(graph.edge_count() - 1)(0, 1) == 2);
  }
  const Eigen::Matrix3d upper = lower.transpose();
  const std::string told =
      "EDGE_SE2: the information matrix is not symmetric: its lower triangle is read, and row 1, column 0 is "
      "0 there, 2 above the diagonal";
  CHECK_THROWS_WITH(graph.add_edge(EdgeSe2{{1, 0, 0}}, {0, 1}, upper), told);
  CHECK_THROWS_WITH(graph.add_edge(type, std::array{0, 1}, std::array{1.0, 0.0, 0.0}, upper), told);
  CHECK(graph.edge_count() == 2);
}

TEST_CASE(
    "graph: the triangles of an information of very small or large numbers are compared beside its diagonal") {
  Graph graph;
  graph.add_vertex<VertexSe2>(VertexId{1}, {0, 0, 0});
  graph.add_vertex<VertexSe2>(VertexId{2}, {1, 0, 0});
  for (const double size : {1e-200, 1.0, 1e200}) {  // the square of the first is 0, that of the last infinite
    INFO(size);
    Eigen::Matrix3d rounded = size * Eigen::Matrix3d::Identity();
    rounded(1, 0) = 0.5 * size;
    rounded(0, 1) = 0.5 * size * (1 + 1e-9);
    CHECK_NOTHROW(graph.add_edge(EdgeSe2{{1, 0, 0}}, {0, 1}, rounded));
    Eigen::Matrix3d other = rounded;
    other(0, 1) = 0.6 * size;
    CHECK_THROWS_AS(graph.add_edge(EdgeSe2{{1, 0, 0}}, {0, 1}, other), UsageError);
  }
}

TEST_CASE("graph: the library says the version of its headers") {
  CHECK(version() == WAYMARK_VERSION);
  CHECK(version().starts_with(std::to_string(WAYMARK_VERSION_MAJOR) + "." +
                              std::to_string(WAYMARK_VERSION_MINOR)));
}

TEST_CASE("vertices are found by their ids, however many others have come and gone") {
  Graph graph;
  const std::vector<std::int64_t> lasting{2, 7, 20'000'000, 40'000'000'000, -5};
  for (const std::int64_t id : lasting) graph.add_vertex<VertexXy>(VertexId{id}, {double(id), 0});
  std::int64_t next = 100;
  for (int round = 0; round < 40; ++round) {
    for (int k = 0; k < 1000; ++k, ++next) graph.add_vertex<VertexXy>(VertexId{next}, {double(next), 0});
    if (graph.vertex_count() < 3000) continue;
    std::vector<char> gone(graph.vertex_count(), 0);
    std::fill(gone.begin() + 5, gone.begin() + 1005, 1);
    (void)graph.remove_vertices(gone);
    for (VertexIndex v = 0; v < static_cast<VertexIndex>(graph.vertex_count()); ++v)
      REQUIRE(graph.find(graph.id(v)) == v);
    CHECK_FALSE(graph.find(VertexId{100}));
  }
  for (const std::int64_t id : lasting) CHECK(graph.value(graph.find(VertexId{id}).value())[0] == double(id));
}

}  // namespace graph_test
