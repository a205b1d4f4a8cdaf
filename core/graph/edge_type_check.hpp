/// Trying out an edge type by itself, on numbers that are hard on derivatives: for `waymark check
/// --derivatives` and the conformance tests, for types of the house and of plugins alike.
#pragma once

#include <random>
#include <span>
#include <string>

#include <waymark/core/graph/gradient_check.hpp>
#include <waymark/core/registry/registry.hpp>

namespace waymark {

/// How the numbers of a trial are drawn.
struct EdgeScenario {
  const char* name;
  double place;    ///< half range of a vertex's numbers, m and the like
  double heading;  ///< its headings lie around this...
  double spread;   ///< ...within this
  double field;    ///< half range of the edge's fields
};

/// Identity, tiny motions (also at pi), headings on both sides of pi, random, far away.
[[nodiscard]] std::span<const EdgeScenario> edge_scenarios();

/// A graph of one edge of the type on vertices of its own, all numbers drawn from the scenario.
/// @throws UsageError where a vertex type that it joins is not registered
[[nodiscard]] Graph single_edge(const TypeRegistry& registry, const EdgeType& type,
                                const EdgeScenario& scenario, std::mt19937_64& random);

/// The largest disagreement of a type's Jacobians with differences of its error, over all scenarios.
struct EdgeTypeCheck {
  GradientCheck worst;
  std::string scenario;        ///< where it was found
  Graph graph;                 ///< the edge it was found at
  std::size_t not_finite = 0;  ///< trials whose error or Jacobians are no numbers
  std::size_t trials = 0;
  std::size_t judged = 0;  ///< Jacobians that differences could say something of

  [[nodiscard]] bool sound() const {
    return worst.error <= kGradientTolerance && not_finite == 0 && judged > 0;
  }
};

/// Deterministic. @param repetitions  trials per scenario
[[nodiscard]] EdgeTypeCheck check_edge_type(const TypeRegistry& registry, const EdgeType& type,
                                            int repetitions = 20);

}  // namespace waymark
