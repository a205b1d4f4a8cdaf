/// The second-order term of a robust loss, as a change of the edge's information matrix.
///
/// With s = e^T Omega e and e linear in the unknowns, half the Hessian of rho(s) is
///   J^T (rho' Omega + 2 rho'' Omega e e^T Omega) J
/// (Triggs, McLauchlan, Hartley, Fitzgibbon, "Bundle Adjustment: A Modern Synthesis", 2000, section 4.3). The
/// second term changes the information along e alone, from rho' to rho' + 2 s rho''. All losses bend down
/// (rho'' <= 0). Where that leaves less than kLeastCurvature of rho', the edge lies where the loss is flat or
/// concave along e and no quadratic model with a minimum describes it: there the term is left out. What
/// remains, rho' Omega, bounds the loss from above (rho is concave in s), so that a full step cannot climb
/// for it; holding the factor at a small positive number instead makes steps wild (core/MEASUREMENTS.md has
/// the figures). g = rho' J^T Omega e has no such term.
#pragma once

#include <Eigen/Core>

#include <waymark/core/graph/loss.hpp>

namespace waymark {

/// Below this share of rho' the second-order term is left out.
inline constexpr double kLeastCurvature = 0.4;

/// The information along e relative to rho' Omega, in [kLeastCurvature, 1].
[[nodiscard]] inline double curvature_factor(const LossValue& loss, double squared) {
  const double factor = 1 + 2 * squared * loss.curvature / loss.weight;
  return factor >= kLeastCurvature && factor < 1 ? factor : 1;  // weight 0: not a number, so 1
}

/// The information of the linearised edge: rho' Omega, with its second-order term where that is kept.
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
