#include <numeric>

#include <Eigen/OrderingMethods>
#include <Eigen/SparseCore>

#include <waymark/core/base/detail/index.hpp>
#include <waymark/core/linear/detail/factor_rows.hpp>
#include <waymark/core/system/structure.hpp>

namespace waymark {
namespace {

using detail::at;

}  // namespace

std::int64_t count_fill(std::span<const std::int64_t> begin, std::span<const int> rows,
                        std::span<const char> left_out, std::int64_t limit) {
  const std::size_t n = begin.size() - 1;
  detail::FactorRows factor(n);
  std::int64_t fill = 0;
  for (std::size_t k = 0; k < n; ++k) {
    if (left_out[k]) continue;
    factor.begin(k);
    for (auto e = begin[k]; e < begin[k + 1]; ++e) {
      if (left_out[at(rows[at(e)])]) continue;
      factor.follow(rows[at(e)], [&](int) { ++fill; });
      if (fill > limit) return -1;
    }
  }
  return fill;
}

namespace {

/// Returns the only neighbour of each node that has just one, and -1 for all others. If two nodes
/// have only each other, the later one is the leaf.
std::vector<int> find_leaves(std::span<const std::int64_t> begin, std::span<const int> rows,
                             std::span<const char> dense) {
  const std::size_t n = begin.size() - 1;
  std::vector<int> neighbour(n, -1);
  std::vector<int> degree(n, 0);
  for (std::size_t j = 0; j < n; ++j) {
    for (auto e = begin[j]; e < begin[j + 1]; ++e) {
      const int i = rows[at(e)];
      if (dense[j] || dense[at(i)]) continue;
      ++degree[j];
      ++degree[at(i)];
      neighbour[j] = i;
      neighbour[at(i)] = static_cast<int>(j);
    }
  }
  for (std::size_t j = 0; j < n; ++j) {
    const int other = neighbour[j];
    const bool pair = other > static_cast<int>(j) && degree[at(other)] == 1;
    if (degree[j] != 1 || pair) neighbour[j] = -1;
  }
  return neighbour;
}

/// Returns the nodes in their natural order, with the leaves of each node before it.
std::vector<int> leaves_first(const std::vector<int>& leaf_of, std::span<const char> dense) {
  const std::size_t n = leaf_of.size();
  std::vector<std::int64_t> begin(n + 1, 0);
  for (const int node : leaf_of) {
    if (node >= 0) ++begin[at(node) + 1];
  }
  std::partial_sum(begin.begin(), begin.end(), begin.begin());
  std::vector<int> leaves(at(begin.back()));
  std::vector<std::int64_t> next(begin.begin(), begin.end() - 1);
  for (std::size_t j = 0; j < n; ++j) {
    if (leaf_of[j] >= 0) leaves[at(next[at(leaf_of[j])]++)] = static_cast<int>(j);
  }
  std::vector<int> order;
  order.reserve(n);
  for (std::size_t j = 0; j < n; ++j) {
    if (leaf_of[j] >= 0 || dense[j]) continue;
    for (auto e = begin[j]; e < begin[j + 1]; ++e) order.push_back(leaves[at(e)]);
    order.push_back(static_cast<int>(j));
  }
  return order;
}

/// Returns the order of the nodes that are not dense.
std::vector<int> minimum_degree(std::span<const std::int64_t> begin, std::span<const int> rows,
                                std::span<const char> dense) {
  std::vector<int> node;
  std::vector<int> place(dense.size(), -1);
  for (std::size_t j = 0; j < dense.size(); ++j) {
    if (dense[j]) continue;
    place[j] = static_cast<int>(node.size());
    node.push_back(static_cast<int>(j));
  }
  const auto n = static_cast<Eigen::Index>(node.size());
  Eigen::SparseMatrix<double> upper(n, n);
  upper.reserve(static_cast<Eigen::Index>(rows.size()) + n);
  for (Eigen::Index k = 0; k < n; ++k) {
    upper.startVec(k);
    const auto j = at(node[at(k)]);
    for (auto e = begin[j]; e < begin[j + 1]; ++e) {
      const int row = place[at(rows[at(e)])];
      if (row >= 0) upper.insertBack(row, k) = 1;
    }
    upper.insertBack(k, k) = 1;
  }
  upper.finalize();
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> permutation;
  const Eigen::SparseMatrix<double> full = upper.selfadjointView<Eigen::Upper>();
  Eigen::AMDOrdering<int>()(full, permutation);
  std::vector<int> order;
  order.reserve(dense.size());
  for (Eigen::Index k = 0; k < n; ++k) order.push_back(node[at(permutation.indices()[k])]);
  return order;
}

}  // namespace

BlockOrder order_blocks(std::span<const std::int64_t> begin, std::span<const int> rows,
                        std::span<const char> dense) {
  const std::size_t n = begin.size() - 1;
  std::int64_t entries = 0;
  for (std::size_t j = 0; j < n; ++j) {
    for (auto e = begin[j]; e < begin[j + 1]; ++e) entries += !dense[j] && !dense[at(rows[at(e)])];
  }
  // A banded pattern (a chain) has little fill in its natural order. Reordering would only
  // scatter the memory.
  const std::int64_t limit = entries + entries / 4 + 16;
  BlockOrder result;
  std::int64_t natural_fill = count_fill(begin, rows, dense, limit);
  if (natural_fill != entries) {
    const std::vector<int> leaf_of = find_leaves(begin, rows, dense);
    std::vector<char> left_out(dense.begin(), dense.end());
    std::int64_t leaves = 0;
    for (std::size_t j = 0; j < n; ++j) {
      if (leaf_of[j] < 0) continue;
      left_out[j] = 1;
      ++leaves;
    }
    const std::int64_t core_fill = count_fill(begin, rows, left_out, limit - leaves);
    if (core_fill >= 0 && (natural_fill < 0 || core_fill + leaves < natural_fill)) {
      result = {leaves_first(leaf_of, dense), "leaves first"};
      natural_fill = core_fill + leaves;
    }
  }
  if (natural_fill < 0) {
    result = {minimum_degree(begin, rows, dense), "amd"};
  } else if (result.order.empty()) {
    result.method = "natural";
    for (std::size_t j = 0; j < n; ++j) {
      if (!dense[j]) result.order.push_back(static_cast<int>(j));
    }
  }
  for (std::size_t j = 0; j < n; ++j) {
    if (dense[j]) result.order.push_back(static_cast<int>(j));
  }
  return result;
}

}  // namespace waymark
