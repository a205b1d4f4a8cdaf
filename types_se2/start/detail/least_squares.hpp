/// Sparse linear least squares over complex unknowns. A complex number stands for a point or a
/// direction of the plane.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include <waymark/core/linear/block_cholesky.hpp>

namespace waymark::linear_start_detail {

using Complex = std::complex<double>;

/// A quantity in an equation: the unknown with number `index`, or a known value if `index`
/// is negative.
struct Quantity {
  int index = -1;
  Complex value = 0;
};

/// Minimises the sum of w |sum_k a_k q_k - b|^2 over complex unknowns q. Unknowns are eliminated in
/// the order in which they were added.
class LeastSquares {
 public:
  int add_unknown() { return unknowns_++; }

  template <std::size_t N>
  void add_equation(double weight, const std::array<Complex, N>& factors, const std::array<Quantity, N>& of,
                    Complex right = 0) {
    for (std::size_t k = 0; k < N; ++k) {
      if (of[k].index < 0) right -= factors[k] * of[k].value;
    }
    right_.resize(static_cast<std::size_t>(unknowns_), 0);
    for (std::size_t k = 0; k < N; ++k) {
      if (of[k].index < 0 || factors[k] == Complex(0)) continue;
      const Complex weighted = weight * std::conj(factors[k]);
      right_[static_cast<std::size_t>(of[k].index)] += weighted * right;
      for (std::size_t l = 0; l < N; ++l) {
        if (of[l].index < 0 || of[l].index > of[k].index || factors[l] == Complex(0)) continue;
        normal_.push_back({of[k].index, of[l].index, weighted * factors[l]});
      }
    }
  }

  /// The unknowns, and the largest error that rounding has left in them.
  struct Solution {
    std::vector<Complex> unknowns;
    double rounding = 0;
  };

  /// Returns the unknowns, or nothing if the equations do not determine them.
  [[nodiscard]] std::optional<Solution> solve() {
    Solution solution{.unknowns = right_};
    if (unknowns_ == 0) return solution;
    const std::vector<double> numbers = assemble();
    BlockCholesky factor;
    factor.analyze(pattern_);
    if (factor.factorize(numbers) != FactorStatus::ok) return std::nullopt;
    solve_by(factor, solution.unknowns);
    // A step of iterative refinement is about as large as the errors. It is not taken: where weights differ by
    // many orders of magnitude, the solution is better than its residual.
    std::vector<Complex> correction = residual(solution.unknowns);
    solve_by(factor, correction);
    for (std::size_t k = 0; k < correction.size(); ++k) {
      solution.rounding = std::max(solution.rounding, std::abs(correction[k]));
      if (!std::isfinite(std::abs(solution.unknowns[k]))) return std::nullopt;
    }
    return solution;
  }

 private:
  /// An addend of the normal matrix, at its diagonal or below.
  struct Addend {
    int row = 0;
    int column = 0;
    Complex value = 0;
  };

  static void solve_by(BlockCholesky& factor, std::vector<Complex>& right) {
    const std::span<double> real(reinterpret_cast<double*>(right.data()), 2 * right.size());
    factor.solve(real, real);
  }

  /// Returns what the normal equations leave at these unknowns: right side minus left side.
  [[nodiscard]] std::vector<Complex> residual(const std::vector<Complex>& unknowns) const {
    std::vector<Complex> rest = right_;
    for (const Addend& addend : normal_) {
      const auto row = static_cast<std::size_t>(addend.row);
      const auto column = static_cast<std::size_t>(addend.column);
      rest[row] -= addend.value * unknowns[column];
      if (row != column) rest[column] -= std::conj(addend.value) * unknowns[row];
    }
    return rest;
  }

  /// Assembles the normal matrix over real and imaginary parts: a complex number z is the block [re
  /// -im; im re]. The result is the upper triangle, so it holds the conjugates of the addends.
  std::vector<double> assemble() {
    std::sort(normal_.begin(), normal_.end(), [](const Addend& a, const Addend& b) {
      return std::pair(a.row, a.column) < std::pair(b.row, b.column);
    });
    pattern_ = BlockPattern();
    std::vector<double> numbers;
    std::vector<Addend> column;
    auto next = normal_.begin();
    for (int j = 0; j < unknowns_; ++j) {
      column.clear();
      for (; next != normal_.end() && next->row == j; ++next) {
        if (!column.empty() && column.back().column == next->column) {
          column.back().value += next->value;
        } else {
          column.push_back(*next);
        }
      }
      if (column.empty() || column.back().column != j) column.push_back({j, j, 0});
      add_column(column, numbers);
    }
    return numbers;
  }

  void add_column(const std::vector<Addend>& column, std::vector<double>& numbers) {
    const int height = 2 * static_cast<int>(column.size());
    const std::size_t first = numbers.size();
    numbers.resize(first + 2 * static_cast<std::size_t>(height));
    for (std::size_t k = 0; k < column.size(); ++k) {
      pattern_.row.push_back(column[k].column);
      pattern_.row_offset.push_back(2 * static_cast<int>(k));
      double* block = numbers.data() + first + 2 * k;
      block[0] = block[height + 1] = column[k].value.real();
      block[1] = -column[k].value.imag();
      block[height] = column[k].value.imag();
    }
    pattern_.size.push_back(2);
    pattern_.start.push_back(pattern_.start.back() + 2);
    pattern_.column.push_back(static_cast<std::int64_t>(pattern_.row.size()));
    pattern_.height.push_back(height);
    pattern_.value.push_back(static_cast<std::int64_t>(numbers.size()));
  }

  int unknowns_ = 0;
  std::vector<Addend> normal_;
  std::vector<Complex> right_;
  BlockPattern pattern_;
};

}  // namespace waymark::linear_start_detail
