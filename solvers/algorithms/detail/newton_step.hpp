/// What all algorithms share: the factorisation of H (damped or not) and the step it gives.
#pragma once

#include <algorithm>
#include <cmath>
#include <new>
#include <vector>

#include <waymark/core/optimize/algorithm.hpp>
#include <waymark/core/system/normal_equations.hpp>

namespace waymark::solvers {

/// Solves (H + diag(damping)) d = -g. @param damping empty: none. @param scratch reused between calls.
/// @param slope g^T d
/// Returns ok, or not_positive_definite also where the step is not finite; `delta` is then arbitrary.
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
  // One pass, in pieces that stay in the cache: what is wanted is not H^-1 g but its negative.
  constexpr Eigen::Index kPiece = 1024;
  slope = 0;
  for (Eigen::Index first = 0; first < delta.size(); first += kPiece) {
    auto piece = delta.segment(first, std::min(kPiece, delta.size() - first));
    piece = -piece;
    slope += piece.dot(gradient.segment(first, piece.size()));
  }
  // Any number that is not finite makes the sum so, even times zero.
  return std::isfinite(slope) ? FactorStatus::ok : FactorStatus::not_positive_definite;
}

/// Says of a step whose delta is the full Newton step what it is; its decrement g^T H^-1 g = -g^T d is what
/// the model promises. @param slope g^T d
inline void describe_newton_step(double slope, Step& step) {
  step.newton_decrement = -slope;
  step.predicted_decrease = step.newton_decrement;
  step.full_newton = true;
  step.kind = "newton";
}

}  // namespace waymark::solvers
