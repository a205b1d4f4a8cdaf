/// Sparse linear least squares over complex unknowns: points and directions of the plane read as one number.
#pragma once

#include <array>
#include <complex>
#include <optional>
#include <type_traits>
#include <vector>

#include <Eigen/SparseCholesky>

namespace waymark::linear_start_detail {

using Complex = std::complex<double>;

/// A quantity in an equation: unknown number `index`, or, where that is negative, a known value.
struct Quantity {
  int index = -1;
  Complex value = 0;
};

/// Sum of w |sum_k a_k q_k - b|^2 over complex unknowns q, with real or complex factors a. The order in which
/// unknowns are added is that of their elimination.
template <typename Factor>
class LeastSquares {
 public:
  int add_unknown() { return unknowns_++; }

  template <std::size_t N>
  void add_equation(double weight, const std::array<Factor, N>& factors, const std::array<Quantity, N>& of,
                    Complex right = 0) {
    for (std::size_t k = 0; k < N; ++k) {
      if (of[k].index < 0) right -= factors[k] * of[k].value;
    }
    right_.resize(static_cast<std::size_t>(unknowns_), 0);
    for (std::size_t k = 0; k < N; ++k) {
      if (of[k].index < 0 || factors[k] == Factor(0)) continue;
      const Factor weighted = weight * Eigen::numext::conj(factors[k]);
      right_[static_cast<std::size_t>(of[k].index)] += weighted * right;
      for (std::size_t l = 0; l < N; ++l) {
        if (of[l].index < 0 || of[l].index > of[k].index || factors[l] == Factor(0)) continue;
        normal_.emplace_back(of[k].index, of[l].index, weighted * factors[l]);
      }
    }
  }

  /// The unknowns; nothing where the equations do not determine them.
  [[nodiscard]] std::optional<std::vector<Complex>> solve() const {
    std::vector<Complex> unknowns = right_;
    if (unknowns_ == 0) return unknowns;
    Eigen::SparseMatrix<Factor> matrix(unknowns_, unknowns_);
    matrix.setFromTriplets(normal_.begin(), normal_.end());
    const Eigen::SimplicialLLT<Eigen::SparseMatrix<Factor>, Eigen::Lower, Eigen::NaturalOrdering<int>> factor(
        matrix);
    if (factor.info() != Eigen::Success) return std::nullopt;
    // With real factors, real and imaginary parts are two right-hand sides.
    constexpr Eigen::Index kColumns = std::is_same_v<Factor, double> ? 2 : 1;
    using Columns =
        Eigen::Matrix<Factor, Eigen::Dynamic, kColumns, kColumns == 2 ? Eigen::RowMajor : Eigen::ColMajor>;
    Eigen::Map<Columns> columns(reinterpret_cast<Factor*>(unknowns.data()), unknowns_, kColumns);
    const Columns solution = factor.solve(columns);
    if (!solution.allFinite()) return std::nullopt;
    columns = solution;
    return unknowns;
  }

 private:
  int unknowns_ = 0;
  std::vector<Eigen::Triplet<Factor>> normal_;  // lower triangle
  std::vector<Complex> right_;
};

}  // namespace waymark::linear_start_detail
