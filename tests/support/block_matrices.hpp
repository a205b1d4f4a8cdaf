/// Block patterns and symmetric positive definite matrices on them, for tests of linear solvers.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <set>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include <waymark/core/linear/block_pattern.hpp>

namespace waymark_test {

/// Off-diagonal blocks, each as (row, column) with row < column.
using Pairs = std::set<std::pair<int, int>>;

/// Returns the pattern of blocks with these sizes and off-diagonal blocks.
[[nodiscard]] inline waymark::BlockPattern make_pattern(const std::vector<int>& sizes, const Pairs& pairs,
                                                        std::uint64_t version = 1) {
  std::vector<std::vector<int>> rows(sizes.size());
  for (const auto& [row, column] : pairs) rows[static_cast<std::size_t>(column)].push_back(row);
  waymark::BlockPattern pattern;
  pattern.version = version;
  for (std::size_t j = 0; j < sizes.size(); ++j) {
    pattern.size.push_back(sizes[j]);
    pattern.start.push_back(pattern.start.back() + sizes[j]);
    rows[j].push_back(static_cast<int>(j));
    int height = 0;
    for (const int i : rows[j]) {
      pattern.row.push_back(i);
      pattern.row_offset.push_back(height);
      height += sizes[static_cast<std::size_t>(i)];
    }
    pattern.column.push_back(static_cast<std::int64_t>(pattern.row.size()));
    pattern.height.push_back(height);
    pattern.value.push_back(pattern.value.back() + std::int64_t{height} * sizes[j]);
  }
  return pattern;
}

/// Returns the numbers of a symmetric matrix on the pattern.
[[nodiscard]] inline std::vector<double> gather(const waymark::BlockPattern& pattern,
                                                const Eigen::MatrixXd& matrix) {
  const waymark::ScalarPattern<int> scalar = waymark::to_scalar<int>(pattern);
  std::vector<double> values;
  for (std::size_t j = 0; j + 1 < scalar.column.size(); ++j) {
    for (int k = scalar.column[j]; k < scalar.column[j + 1]; ++k)
      values.push_back(matrix(scalar.row[static_cast<std::size_t>(k)], static_cast<Eigen::Index>(j)));
  }
  return values;
}

/// Returns a symmetric positive definite matrix on the pattern: the sum of small ones over its
/// blocks, plus `diagonal` times the identity.
[[nodiscard]] inline Eigen::MatrixXd random_spd(const waymark::BlockPattern& pattern, std::uint64_t seed,
                                                double diagonal = 0.1) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> unit(-1, 1);
  const auto n = static_cast<Eigen::Index>(pattern.dimension());
  Eigen::MatrixXd matrix = diagonal * Eigen::MatrixXd::Identity(n, n);
  for (std::size_t j = 0; j < pattern.size.size(); ++j) {
    for (auto k = pattern.column[j]; k < pattern.column[j + 1]; ++k) {
      const auto i = static_cast<std::size_t>(pattern.row[static_cast<std::size_t>(k)]);
      std::vector<Eigen::Index> place;
      for (int c = 0; c < pattern.size[i]; ++c) place.push_back(pattern.start[i] + c);
      for (int c = 0; c < pattern.size[j] && i != j; ++c) place.push_back(pattern.start[j] + c);
      const auto m = static_cast<Eigen::Index>(place.size());
      const Eigen::MatrixXd root = Eigen::MatrixXd::NullaryExpr(m, m, [&] { return unit(random); });
      matrix(place, place) += root * root.transpose();
    }
  }
  return 0.5 * (matrix + matrix.transpose());
}

/// Returns a chain of blocks and some random pairs.
[[nodiscard]] inline Pairs random_pairs(int blocks, int count, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  Pairs pairs;
  for (int j = 1; j < blocks; ++j) pairs.insert({j - 1, j});
  for (int k = 0; k < count; ++k) {
    const int a = static_cast<int>(random() % static_cast<unsigned>(blocks));
    const int b = static_cast<int>(random() % static_cast<unsigned>(blocks));
    if (a != b) pairs.insert({std::min(a, b), std::max(a, b)});
  }
  return pairs;
}

/// Returns a right side without pattern.
[[nodiscard]] inline Eigen::VectorXd right_side(Eigen::Index n) {
  return Eigen::VectorXd::NullaryExpr(n,
                                      [](Eigen::Index i) { return std::sin(1.0 + static_cast<double>(i)); });
}

}  // namespace waymark_test
