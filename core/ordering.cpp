#include <numeric>

#include <Eigen/OrderingMethods>
#include <Eigen/SparseCore>

#include <waymark/core/structure.hpp>

namespace waymark {

// Row i of the factor is the union of the paths in the elimination tree from its entries towards i (Gilbert,
// Ng, Peyton); tree and paths are walked together, without recursion.
std::int64_t count_fill(std::span<const std::int64_t> begin, std::span<const int> neighbours,
                        std::span<const int> order, std::int64_t limit) {
  const std::size_t n = order.size();
  std::vector<int> position(n);
  for (std::size_t k = 0; k < n; ++k) position[static_cast<std::size_t>(order[k])] = static_cast<int>(k);
  std::vector<int> parent(n, -1);
  std::vector<int> seen(n, -1);
  std::int64_t fill = 0;
  for (std::size_t k = 0; k < n; ++k) {
    const int row = static_cast<int>(k);
    seen[k] = row;
    const auto node = static_cast<std::size_t>(order[k]);
    for (auto e = begin[node]; e < begin[node + 1]; ++e) {
      int j = position[static_cast<std::size_t>(neighbours[static_cast<std::size_t>(e)])];
      while (j < row && seen[static_cast<std::size_t>(j)] != row) {
        auto& up = parent[static_cast<std::size_t>(j)];
        if (up < 0) up = row;
        seen[static_cast<std::size_t>(j)] = row;
        if (++fill > limit) return -1;
        j = up;
      }
    }
  }
  return fill;
}

namespace {

std::vector<int> minimum_degree(std::span<const std::int64_t> begin, std::span<const int> neighbours, int n) {
  Eigen::SparseMatrix<double> matrix(n, n);
  matrix.reserve(static_cast<Eigen::Index>(neighbours.size()) + n);
  for (int i = 0; i < n; ++i) {
    matrix.startVec(i);
    bool diagonal = false;
    for (auto e = begin[static_cast<std::size_t>(i)]; e < begin[static_cast<std::size_t>(i) + 1]; ++e) {
      const int j = neighbours[static_cast<std::size_t>(e)];
      if (j > i && !diagonal) {
        matrix.insertBack(i, i) = 1;
        diagonal = true;
      }
      matrix.insertBack(j, i) = 1;
    }
    if (!diagonal) matrix.insertBack(i, i) = 1;
  }
  matrix.finalize();
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> permutation;
  Eigen::AMDOrdering<int>()(matrix, permutation);
  return {permutation.indices().data(), permutation.indices().data() + n};
}

}  // namespace

BlockOrder order_blocks(std::span<const std::int64_t> begin, std::span<const int> neighbours) {
  const int n = static_cast<int>(begin.size()) - 1;
  BlockOrder natural{std::vector<int>(static_cast<std::size_t>(n)), "natural"};
  std::iota(natural.order.begin(), natural.order.end(), 0);
  // A banded pattern (a chain) fills little as it is; reordering it would only scatter the memory.
  const auto entries = static_cast<std::int64_t>(neighbours.size()) / 2;
  const std::int64_t natural_fill = count_fill(begin, neighbours, natural.order, entries + entries / 4 + 16);
  if (natural_fill >= 0) return natural;
  return {minimum_degree(begin, neighbours, n), "amd"};
}

}  // namespace waymark
