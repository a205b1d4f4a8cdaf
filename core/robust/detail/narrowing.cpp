#include <algorithm>
#include <cmath>
#include <utility>

#include <waymark/core/robust/detail/narrowing.hpp>
#include <waymark/core/robust/edge_selection.hpp>

namespace waymark::detail {
namespace {

/// There are verdicts at this stretch, at a quarter of it, ..., and at 1. The default width of
/// Geman-McClure is then 4, 2 and 1 standard deviations. The best width depends on how far the
/// stated noise is from the true one.
constexpr double kFirstVerdict = 16;
/// Steps towards the minimum with the loss before a verdict.
constexpr int kConverge = 30;

LossValue no_loss(double squared, double) {
  return {squared, 1, 0};
}

/// Tells whether m rho(s / m) is still convex in the error at s: it has no negative curvature
/// along the error.
bool convex_at(const Loss& loss, double squared) {
  const LossValue value = loss.at(squared);
  return value.weight > 0 && value.weight + 2 * squared * value.curvature >= -1e-9 * value.weight;
}

// Returns the smallest power of two at which the loss is convex at every candidate.
double first_stretch(const Splits& splits) {
  double largest = 0;
  for (const EdgePlace place : splits.roles().candidates)
    largest = std::max(largest, squared_error(splits.graph(), place));
  Loss loss = splits.options().loss;
  while (std::isfinite(largest) && std::isfinite(loss.stretch) && !convex_at(loss, largest)) {
    loss.stretch *= 2;
  }
  return loss.stretch;
}

// Returns the graph with candidates that have the loss of their batch, which narrows. The other edges keep their own,
// or none.
Graph with_losses_of_batches(const Splits& splits) {
  Graph result = splits.graph();
  const std::vector<EdgePlace>& candidates = splits.roles().candidates;
  auto candidate = candidates.begin();
  for (std::size_t b = 0; b < result.batch_count(); ++b) {
    for (std::size_t e = 0; e < result.batch(b).size(); ++e) {
      const Loss* own = splits.graph().batch(b).loss(e);
      const bool doubted = candidate != candidates.end() && *candidate == EdgePlace{b, e};
      if (!doubted) result.batch(b).set_loss(e, own != nullptr ? *own : Loss{"none", &no_loss});
      candidate += doubted;
    }
  }
  return result;
}

}  // namespace

int narrow(Splits& splits) {
  OptimizerOptions inner = splits.options().optimizer;
  inner.max_iterations = splits.options().inner_iterations;
  OptimizerOptions converge = inner;
  converge.max_iterations = kConverge;
  Loss loss = splits.options().loss;
  loss.stretch = first_stretch(splits);
  Graph narrowing = with_losses_of_batches(splits);
  double next_verdict = kFirstVerdict;
  int rounds = 0;
  while (!splits.interrupted()) {
    for (std::size_t b = 0; b < narrowing.batch_count(); ++b) narrowing.batch(b).set_loss(loss);
    (void)splits.optimized(narrowing, inner);
    ++rounds;
    if (loss.stretch <= next_verdict) {
      Graph settled = narrowing;  // the narrowing itself continues from its own values
      if (!splits.interrupted()) (void)splits.optimized(settled, converge);
      splits.graph().set_values(settled.values());
      splits.judge(splits.beyond_bound(splits.roles().candidates));
      next_verdict = std::max(1.0, loss.stretch / 4);
    }
    if (loss.stretch <= 1) break;
    loss.stretch = std::max(1.0, loss.stretch / splits.options().factor);
  }
  return rounds;
}

}  // namespace waymark::detail
