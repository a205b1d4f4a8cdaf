/// Robust losses rho(s) of the squared error s = e^T Omega e. chi2 becomes sum rho(s); the weight of an edge
/// is rho'(s).
///
/// Every weight is in [0, 1] and rho(s) = s for small s. Losses are values: a name, a scale, a function
/// pointer; a plugin registers its own LossType.
#pragma once

#include <span>
#include <string>

namespace waymark {

/// rho and its first two derivatives with respect to s.
struct LossValue {
  double rho = 0;
  double weight = 1;     ///< rho'(s), >= 0
  double curvature = 0;  ///< rho''(s), <= 0; H leaves its term out, so that it stays positive semi-definite
};

/// A kind of loss. @param squared s >= 0; @param scale in standard deviations (DCS: Phi, in s), > 0.
struct LossType {
  std::string name;
  LossValue (*evaluate)(double squared, double scale) = nullptr;
  std::string formula;  ///< for `waymark info`
};

/// A loss as attached to an edge or a batch.
struct Loss {
  std::string name;
  LossValue (*evaluate)(double squared, double scale) = nullptr;
  double scale = 1;

  friend bool operator==(const Loss& a, const Loss& b) { return a.name == b.name && a.scale == b.scale; }
};

/// huber, cauchy, tukey, geman_mcclure, welsch, dcs.
[[nodiscard]] std::span<const LossType> builtin_losses();

}  // namespace waymark
