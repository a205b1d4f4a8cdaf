#include <catch2/catch.hpp>

#include <waymark/core/drive/kept_vertex.hpp>
#include <waymark/core/window/marginalization.hpp>
#include <waymark/types_se2/edge_se2.hpp>
#include <waymark/types_se2/vertex_se2.hpp>

namespace kept_vertex_test {

using namespace waymark;

TEST_CASE("kept vertex: it is made once, and found again after earlier vertices have left") {
  Graph graph;
  KeptVertex first;
  KeptVertex last;
  const auto add_pose = [&] { return graph.add_vertex<VertexSe2>(graph.free_id(), {0, 0, 0}); };
  CHECK(last.in(graph) == -1);
  const VertexIndex begin = first.in_or(graph, add_pose);
  const VertexIndex middle = add_pose();
  const VertexIndex end = last.in_or(graph, add_pose);
  CHECK(last.in_or(graph, add_pose) == end);
  REQUIRE(graph.vertex_count() == 3);
  const VertexId id = graph.id(end);
  graph.add_edge(gaussian_prior_type(), std::array{begin}, std::array{0.0, 0.0, 0.0, 0.0, 0.0, 0.0},
                 Eigen::MatrixXd::Identity(3, 3));
  graph.add_edge(EdgeSe2{{1, 0, 0}}, {begin, middle}, Eigen::Matrix3d::Identity());
  graph.add_edge(EdgeSe2{{1, 0, 0}}, {middle, end}, Eigen::Matrix3d::Identity());

  (void)marginalize_prefix(graph, 2);

  CHECK(last.in(graph) == 0);
  CHECK(graph.id(last.in(graph)) == id);
  CHECK(first.in(graph) == -1);
  CHECK(first.in_or(graph, add_pose) == 1);
}

}  // namespace kept_vertex_test
