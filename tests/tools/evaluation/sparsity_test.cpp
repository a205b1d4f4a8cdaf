#include <numeric>
#include <utility>
#include <vector>

#include <catch2/catch.hpp>

#include <waymark/core/base/error.hpp>
#include <waymark/core/optimize/optimizer.hpp>
#include <waymark/tools/evaluation/document/sparsity.hpp>
#include <waymark/types_se2/edge_se2.hpp>
#include "support/problems.hpp"
#include "support/registry.hpp"

namespace sparsity_test {

using namespace waymark;
using namespace waymark::evaluation;

namespace {

/// Poses joined by relative edges, the first tied to the frame, so that all are unknowns.
Graph joined(int poses, const std::vector<std::pair<int, int>>& edges) {
  Graph graph;
  for (int i = 0; i < poses; ++i) graph.add_vertex<VertexSe2>(VertexId(i), {1.0 * i, 0, 0});
  const Eigen::Matrix3d information = Eigen::Matrix3d::Identity();
  graph.add_edge(EdgePriorSe2{}, {0}, information);
  for (const auto& [from, to] : edges)
    graph.add_edge(EdgeSe2{{1.0 * (to - from), 0, 0}}, {from, to}, information);
  return graph;
}

std::vector<std::pair<int, int>> chain(int poses) {
  std::vector<std::pair<int, int>> edges;
  for (int i = 0; i + 1 < poses; ++i) edges.emplace_back(i, i + 1);
  return edges;
}

std::int64_t total(const DensityRaster& raster) {
  return std::accumulate(raster.count.begin(), raster.count.end(), std::int64_t{0});
}

/// Numbers in blocks of three: 6 of each diagonal one, 9 of each other.
std::int64_t numbers(std::int64_t columns, std::int64_t below) {
  return 6 * columns + 9 * below;
}

}  // namespace

TEST_CASE("sparsity: a chain has no fill") {
  const int poses = GENERATE(1, 2, 50, 5000);  // long ones are eliminated from both ends
  const Sparsity s = sparsity_of(joined(poses, chain(poses)));
  CHECK(s.columns == static_cast<std::size_t>(poses));
  CHECK(s.dimension == 3 * poses);
  CHECK(s.matrix.blocks == 2 * poses - 1);
  CHECK(s.matrix.scalars == numbers(poses, poses - 1));
  CHECK(s.factor.blocks == s.matrix.blocks);
  CHECK(s.factor.scalars == s.matrix.scalars);
  CHECK(s.fill_ratio() == 1);
  CHECK(s.ordering == "natural");
}

TEST_CASE("sparsity: a ring fills one block per pose between its ends, in any order") {
  // Eliminating a pose of a ring joins its two neighbours: a ring of n - 1 remains, until three are
  // left.
  constexpr int kPoses = 40;
  auto edges = chain(kPoses);
  edges.emplace_back(0, kPoses - 1);
  const Sparsity s = sparsity_of(joined(kPoses, edges));
  CHECK(s.matrix.blocks == 2 * kPoses);
  CHECK(s.factor.blocks == 2 * kPoses + kPoses - 3);
  CHECK(s.factor.scalars == numbers(kPoses, kPoses + kPoses - 3));
}

TEST_CASE("sparsity: an arrow whose head goes last has no fill") {
  constexpr int kPoses = 120;  // the head, vertex 0, touches all others and counts as a dense column
  std::vector<std::pair<int, int>> edges;
  for (int i = 1; i < kPoses; ++i) edges.emplace_back(0, i);
  const Sparsity s = sparsity_of(joined(kPoses, edges));
  CHECK(s.factor.blocks == 2 * kPoses - 1);
  CHECK(s.fill_ratio() == 1);
  // By vertices the head is the first column, in the order of elimination the last row.
  for (std::size_t k = 0; k < kPoses; ++k) {
    CHECK(s.natural.at(k, 0) == 1);
    CHECK(s.ordered.at(kPoses - 1, k) == 1);
    CHECK(s.factor_raster.at(kPoses - 1, k) == 1);
  }
}

TEST_CASE("sparsity: small patterns are shown block by block") {
  const Sparsity s = sparsity_of(joined(4, {{0, 1}, {1, 2}, {2, 3}, {0, 3}}));
  CHECK(s.natural.cells == 4);
  const std::vector<std::uint32_t> expected = {1, 0, 0, 0,  //
                                               1, 1, 0, 0,  //
                                               0, 1, 1, 0,  //
                                               1, 0, 1, 1};
  CHECK(s.natural.count == expected);
  CHECK(total(s.ordered) == 8);
  CHECK(total(s.factor_raster) == 9);
}

TEST_CASE("sparsity: every block is in one cell, and no cell holds more than it has places") {
  const Graph graph = waymark_test::grid_walk(1003, 20);
  const Sparsity s = sparsity_of(graph, 64);
  CHECK(s.natural.cells == 64);
  CHECK(total(s.natural) == s.matrix.blocks);
  CHECK(total(s.ordered) == s.matrix.blocks);
  CHECK(total(s.factor_raster) == s.factor.blocks);
  std::int64_t places = 0;
  for (std::size_t r = 0; r < 64; ++r) {
    for (std::size_t c = 0; c < 64; ++c) {
      places += s.factor_raster.possible(r, c);
      CHECK(std::int64_t{s.natural.at(r, c)} <= s.natural.possible(r, c));
      CHECK(std::int64_t{s.factor_raster.at(r, c)} <= s.factor_raster.possible(r, c));
    }
  }
  const auto n = static_cast<std::int64_t>(s.columns);
  CHECK(places == n * (n + 1) / 2);
}

TEST_CASE("sparsity: the factor is as large as solvers say") {
  const TypeRegistry registry = waymark_test::full_registry();
  Graph graph = GENERATE(waymark_test::grid_walk(800, 12), waymark_test::noisy_circle(300));
  const Sparsity s = sparsity_of(graph);
  const auto algorithm = registry.make_algorithm("gauss_newton", {});
  OptimizerOptions once;
  once.max_iterations = 1;
  for (const auto& entry : registry.linear_solvers()) {
    const auto solver = registry.make_linear_solver(entry.type.name);
    Graph copy = graph;
    const Summary summary = optimize(copy, *algorithm, *solver, once);
    INFO(entry.type.name);
    CHECK(summary.unknowns == s.dimension);
    // These two store nothing else; fronts and supernodes hold zeros beside it.
    const bool exact = entry.type.name == "csparse" || entry.type.name == "eigen";
    if (exact) CHECK(summary.factor_size == s.factor.scalars);
    CHECK(summary.factor_size >= s.factor.scalars);
  }
}

TEST_CASE("sparsity: held and fixed vertices are no unknowns") {
  Graph loose;
  for (int i = 0; i < 3; ++i) loose.add_vertex<VertexSe2>(VertexId(i), {1.0 * i, 0, 0});
  for (int i = 0; i < 2; ++i) loose.add_edge(EdgeSe2{{1, 0, 0}}, {i, i + 1}, Eigen::Matrix3d::Identity());
  CHECK(sparsity_of(loose).columns == 2);  // the first is held for the gauge
  loose.set_fixed(1, true);
  CHECK(sparsity_of(loose).matrix.blocks == 2);
  const Sparsity none = sparsity_of(Graph());
  CHECK(none.columns == 0);
  CHECK(none.factor_raster.count.empty());
  CHECK(none.fill_ratio() == 0);
  CHECK_THROWS_AS(sparsity_of(loose, 0), UsageError);
}

}  // namespace sparsity_test
