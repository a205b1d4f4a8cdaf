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

  /// Returns the unknowns, or nothing if the equations do not determine them.
  [[nodiscard]] std::optional<std::vector<Complex>> solve() {
    std::vector<Complex> solution = right_;
    if (unknowns_ == 0) return solution;
    const std::vector<double> numbers = assemble();
    BlockCholesky factor;
    factor.analyze(pattern_);
    if (factor.factorize(numbers) != FactorStatus::ok) return std::nullopt;
    const std::span<double> real(reinterpret_cast<double*>(solution.data()), 2 * solution.size());
    factor.solve(real, real);
    for (const Complex& q : solution) {
      if (!std::isfinite(q.real() + q.imag())) return std::nullopt;
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
