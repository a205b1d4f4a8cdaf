// The vertex that the edges determine least is named, also if no unknown of it lacks information by itself.
#include <array>

#include <catch2/catch.hpp>

#include <waymark/core/linear/block_cholesky.hpp>
#include <waymark/core/system/structure.hpp>
#include <waymark/core/system/weakest_unknown.hpp>
#include <waymark/types_se2/edge_se2.hpp>

namespace weakest_unknown_test {

using namespace waymark;

TEST_CASE("weakest unknown: the end of the loosest link, not the smallest number on the diagonal") {
  // 0 is fixed. 1 and 2 hang on it by a link of 1e-8 and are joined by one of 100: both diagonals are 100, and both
  // move together. 3 hangs on 0 by a link of 1, the smallest number on the diagonal.
  Graph graph;
  std::array<VertexIndex, 4> v{};
  for (int i = 0; i < 4; ++i)
    v[static_cast<std::size_t>(i)] = graph.add_vertex<VertexSe2>(VertexId{i}, {0, 0, 0});
  graph.set_fixed(v[0], true);
  const auto link = [&](int from, int to, double information) {
    graph.add_edge(EdgeSe2{}, {v[static_cast<std::size_t>(from)], v[static_cast<std::size_t>(to)]},
                   information * Eigen::Matrix3d::Identity());
  };
  link(0, 1, 1e-8);
  link(1, 2, 100);
  link(0, 3, 1);
  Structure structure;
  structure.build(graph, std::vector<char>(4, 0));
  NormalEquations equations(graph, structure);
  (void)equations.linearize(graph.values());
  BlockCholesky cholesky;
  cholesky.analyze(structure.pattern());
  const VertexIndex weakest = equations.vertex_of_unknown(weakest_unknown(equations, cholesky));
  CHECK((weakest == v[1] || weakest == v[2]));
}

}  // namespace weakest_unknown_test
