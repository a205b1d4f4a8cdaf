/// The common part of all algorithms: the factorisation of H (damped or not) and the step
/// that follows.
#pragma once

#include <algorithm>
#include <cmath>
#include <new>
#include <vector>

#include <waymark/core/optimize/algorithm.hpp>
#include <waymark/core/system/normal_equations.hpp>

namespace waymark::solvers {

/// Solves (H + diag(damping)) d = -g.
/// @param damping empty for none
/// @param scratch reused between calls
/// @param slope g^T d
/// @return ok or not_positive_definite; the latter also if the step is not finite. `delta` is
/// then arbitrary.
[[nodiscard]] inline FactorStatus solve_step(const NormalEquations& equations, LinearSolver& solver,
                                             const Eigen::VectorXd& damping, std::vector<double>& scratch,
                                             Eigen::VectorXd& delta, double& slope) {
  std::span<const double> numbers = equations.hessian();
  if (damping.size() > 0) {
    equations.add_to_diagonal(damping, scratch);
    numbers = scratch;
  }
  const FactorStatus status = solver.factorize(numbers);
  if (status == FactorStatus::out_of_memory) throw std::bad_alloc();  // damping would not help
  if (status != FactorStatus::ok) return status;
  const auto gradient = equations.gradient();
  const auto size = static_cast<std::size_t>(gradient.size());
  delta.resize(gradient.size());
  solver.solve({gradient.data(), size}, {delta.data(), size});
  // One pass in pieces that stay in the cache negates the solution: the step is -H^-1 g.
  constexpr Eigen::Index kPiece = 1024;
  slope = 0;
  for (Eigen::Index first = 0; first < delta.size(); first += kPiece) {
    auto piece = delta.segment(first, std::min(kPiece, delta.size() - first));
    piece = -piece;
    slope += piece.dot(gradient.segment(first, piece.size()));
  }
  // A number that is not finite makes the sum not finite, even times zero.
  return std::isfinite(slope) ? FactorStatus::ok : FactorStatus::not_positive_definite;
}

/// Marks a step whose delta is the full Newton step. The model promises the decrement g^T
/// H^-1 g = -g^T d.
/// @param slope g^T d
inline void describe_newton_step(double slope, Step& step) {
  step.newton_decrement = -slope;
  step.predicted_decrease = step.newton_decrement;
  step.full_newton = true;
  step.kind = "newton";
}

}  // namespace waymark::solvers
