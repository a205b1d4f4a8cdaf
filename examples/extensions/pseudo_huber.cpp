// A robust loss: rho(s) of the squared error s = e^T Omega e, in standard deviations squared. Pseudo-Huber is
// Huber's loss without the edge at k: rho = 2 k^2 (sqrt(1 + s/k^2) - 1).
#include <cmath>

#include <waymark/core/registry/plugin.hpp>

using namespace waymark;

/// rho and its first two derivatives by s. The weight must lie in [0, 1] and never grow with s, and
/// rho(s) = s for small s: then scale, chi2 and sigmas mean the same with any loss.
static LossValue pseudo_huber(double s, double k) {
  const double root = std::sqrt(1 + s / (k * k));
  const double rho = 2 * s / (root + 1);  // the same number, without the cancellation for small s
  return {rho, 1 / root, -0.5 / (k * k * root * root * root)};
}

static void register_types(TypeRegistry& registry) {
  registry.add_loss({"pseudo_huber", &pseudo_huber, "2 k^2 (sqrt(1 + s/k^2) - 1)"});
}
WAYMARK_PLUGIN(pseudo_huber, "1.0.0", register_types);
