/// Minimises a graph in the way of a setting.
#pragma once

#include <atomic>
#include <string>

#include <waymark/core/optimize/optimizer.hpp>
#include <waymark/core/registry/registry.hpp>
#include <waymark/tools/reproduction/experiment/setting.hpp>

namespace waymark::reproduction {

/// How a minimisation ended.
struct Ending {
  /// by the rule of its setting; whether it is at a minimum is another question
  bool converged = false;
  std::string message;     ///< why it ended, with the numbers
  int iterations = 0;      ///< accepted steps
  int rejected_steps = 0;  ///< rejected steps
  double initial_chi2 = 0;
  double chi2 = 0;
};

/// Returns the ending of a run with our stopping rule.
[[nodiscard]] Ending describe(const Summary& summary);

/// Minimises with a setting. Afterwards the graph holds the best values found. @param cancel as
/// OptimizerOptions::cancel
/// @throws what optimize() throws
[[nodiscard]] Ending minimize(Graph& graph, const Setting& setting, const TypeRegistry& registry,
                              const std::atomic<bool>* cancel);

}  // namespace waymark::reproduction
