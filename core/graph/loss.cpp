#include <array>
#include <cmath>
#include <vector>

#include <waymark/core/base/error.hpp>
#include <waymark/core/base/suggest.hpp>
#include <waymark/core/graph/loss.hpp>

namespace waymark {
namespace {

LossValue huber(double s, double k) {
  if (s <= k * k) return {s, 1, 0};
  const double r = std::sqrt(s);
  return {2 * k * r - k * k, k / r, -0.5 * k / (s * r)};
}

LossValue cauchy(double s, double c) {
  const double c2 = c * c;
  const double w = 1 / (1 + s / c2);
  return {c2 * std::log1p(s / c2), w, -w * w / c2};
}

LossValue tukey(double s, double c) {
  const double c2 = c * c;
  if (s >= c2) return {c2 / 3, 0, 0};
  const double x = s / c2;
  const double u = 1 - x;
  return {s * (1 - x * (1 - x / 3)), u * u, -2 * u / c2};  // expanded: no cancellation for small s
}

LossValue geman_mcclure(double s, double c) {
  const double c2 = c * c;
  const double w = c2 / (c2 + s);
  return {s * w, w * w, -2 * w * w / (c2 + s)};
}

LossValue welsch(double s, double c) {
  const double c2 = c * c;
  const double w = std::exp(-s / c2);
  return {c2 * -std::expm1(-s / c2), w, -w / c2};
}

// Dynamic covariance scaling, in the form that is continuous and never negative: rho = s up to Phi,
// then 4 Phi s / (Phi + s) - Phi.
LossValue dcs(double s, double phi) {
  if (s <= phi) return {s, 1, 0};
  const double w = 2 * phi / (phi + s);
  return {2 * w * s - phi, w * w, -2 * w * w / (phi + s)};
}

}  // namespace

std::span<const LossType> builtin_losses() {
  static const std::array<LossType, 6> losses = {{
      {"huber", &huber, "s if s <= k^2, else 2 k sqrt(s) - k^2"},
      {"cauchy", &cauchy, "c^2 log(1 + s/c^2)"},
      {"tukey", &tukey, "c^2/3 (1 - (1 - s/c^2)^3) if s < c^2, else c^2/3"},
      {"geman_mcclure", &geman_mcclure, "c^2 s / (c^2 + s)"},
      {"welsch", &welsch, "c^2 (1 - exp(-s/c^2))"},
      {"dcs", &dcs, "s if s <= Phi, else 4 Phi s / (Phi + s) - Phi"},
  }};
  return losses;
}

Loss builtin_loss(std::string_view name, double scale) {
  std::vector<std::string_view> names;
  for (const LossType& type : builtin_losses()) {
    names.push_back(type.name);
    if (type.name != name) continue;
    if (!(scale > 0)) throw UsageError(type.name + ": the scale of a loss must be > 0");
    return {type.name, type.evaluate, scale};
  }
  throw UsageError("unknown loss '" + std::string(name) + "'" + suggestion(name, names));
}

}  // namespace waymark
