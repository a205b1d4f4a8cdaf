/// Robust losses rho(s) of the squared error s = e^T Omega e. chi2 becomes the sum of rho(s), and
/// the weight of an edge is rho'(s).
///
/// Every weight is in [0, 1], and rho(s) = s for small s. A loss is a value: a name, a scale, a
/// function pointer. A plugin registers its own LossType.
///
/// Several threads evaluate losses at the same time, so evaluate must be a pure function.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include <waymark/core/base/export.hpp>
#include <waymark/core/base/guard.hpp>

namespace WAYMARK_EXPORT waymark {

/// rho and its first two derivatives with respect to s.
struct LossValue {
  double rho = 0;
  double weight = 1;     ///< rho'(s), >= 0
  double curvature = 0;  ///< rho''(s), <= 0; robust_information.hpp says which part of it enters H
};

/// A kind of loss. @param squared s >= 0; @param scale in standard deviations (DCS:
/// Phi, in s), > 0.
struct LossType {
  std::string name;
  LossValue (*evaluate)(double squared, double scale) = nullptr;
  std::string formula;  ///< for `waymark info`
};

/// A loss that is attached to an edge or a batch: m rho(s / m) with the stretch m.
struct Loss {
  std::string name;
  LossValue (*evaluate)(double squared, double scale) = nullptr;
  double scale = 1;
  /// Widens any loss by sqrt(m) in standard deviations, whatever its scale means. graduation.hpp
  /// narrows it to 1, the only value in files.
  double stretch = 1;

  [[nodiscard]] LossValue at(double squared) const {
    const LossValue value = guarded([&] { return "loss '" + name + "'"; }, name,
                                    [&] { return evaluate(squared / stretch, scale); });
    return {stretch * value.rho, value.weight, value.curvature / stretch};
  }
  friend bool operator==(const Loss& a, const Loss& b) {
    return a.name == b.name && a.scale == b.scale && a.stretch == b.stretch;
  }
};

/// Returns huber, cauchy, tukey, geman_mcclure, welsch and dcs.
[[nodiscard]] std::span<const LossType> builtin_losses();

/// Returns a built-in loss: builtin_loss("cauchy", 2). @throws UsageError for an unknown name or a
/// scale that is not > 0
[[nodiscard]] Loss builtin_loss(std::string_view name, double scale);

}  // namespace waymark
