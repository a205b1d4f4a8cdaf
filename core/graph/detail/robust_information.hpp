/// The second-order term of a robust loss, as a change of the information matrix of an edge.
///
/// With s = e^T Omega e and e linear in the unknowns, half the Hessian of rho(s) is
///   J^T (rho' Omega + 2 rho'' Omega e e^T Omega) J
/// (Triggs, McLauchlan, Hartley, Fitzgibbon, "Bundle Adjustment: A Modern Synthesis", 2000, section
/// 4.3). The second term changes the information only along e, from rho' to rho' + 2 s rho''. All
/// losses bend down (rho'' <= 0).
///
/// The term is left out if it leaves less than kLeastCurvature of rho'. The loss is then flat or
/// concave along e, and no quadratic model with a minimum describes it. The rest, rho' Omega,
/// bounds the loss from above (rho is concave in s), so a full step cannot increase the loss.
/// Holding the factor at a small positive number would make steps wild (core/MEASUREMENTS.md has
/// the figures). g = rho' J^T Omega e has no such term.
#pragma once

#include <Eigen/Core>

#include <waymark/core/base/export.hpp>
#include <waymark/core/graph/loss.hpp>

namespace WAYMARK_EXPORT waymark {

/// The second-order term is left out if its factor is below this share of rho'.
inline constexpr double kLeastCurvature = 0.4;

/// Returns the information along e relative to rho' Omega, in [kLeastCurvature, 1].
[[nodiscard]] inline double curvature_factor(const LossValue& loss, double squared) {
  const double factor = 1 + 2 * squared * loss.curvature / loss.weight;
  // for weight 0 the factor is NaN, so the result is 1
  return factor >= kLeastCurvature && factor < 1 ? factor : 1;
}

/// Returns the information of the linearised edge: rho' Omega, with the second-order term unless
/// that is left out.
/// @param squared e^T Omega e
template <typename Information, typename Error>
[[nodiscard]] auto robust_information(const LossValue& loss, double squared, const Information& information,
                                      const Error& error) {
  using Matrix = Eigen::Matrix<double, Information::RowsAtCompileTime, Information::ColsAtCompileTime>;
  Matrix result = loss.weight * information;
  const double factor = curvature_factor(loss, squared);
  if (factor < 1) {
    const auto along = (information * error).eval();
    result -= loss.weight * (1 - factor) / squared * along * along.transpose();
  }
  return result;
}

}  // namespace waymark
