/// Tests a single edge type with numbers that make derivatives difficult. `waymark check
/// --derivatives` and the conformance tests use it, for built-in types and for plugins.
#pragma once

#include <random>
#include <span>
#include <string>

#include <waymark/core/base/export.hpp>
#include <waymark/core/graph/checks/gradient_check.hpp>
#include <waymark/core/graph/checks/relative_check.hpp>
#include <waymark/core/registry/registry.hpp>

namespace WAYMARK_EXPORT waymark {

/// The ranges from which the numbers of a trial are drawn.
struct EdgeScenario {
  const char* name;
  double place;    ///< half range of the numbers of a vertex, in m and the like
  double heading;  ///< its headings are around this
  double spread;   ///< and at most this far from it
  double field;    ///< half range of the fields of the edge
};

/// Returns the scenarios: identity, tiny motions (also at pi), headings on both sides of pi,
/// random, far away.
[[nodiscard]] std::span<const EdgeScenario> edge_scenarios();

/// Returns a graph with one edge of the type and its vertices. All numbers are drawn from
/// the scenario. Vertices of a type with fewer degrees of freedom than numbers, such as a unit
/// vector, start from one valid value (random numbers, normalised by a retraction by 0) and are
/// moved from it by the retraction, so their values are valid.
/// @throws UsageError if a vertex type that the edge joins is not registered
[[nodiscard]] Graph single_edge(const TypeRegistry& registry, const EdgeType& type,
                                const EdgeScenario& scenario, std::mt19937_64& random);

/// A larger difference of normal equations is a wrong promise: carry() of the vertices, or kRelative.
inline constexpr double kNormalTolerance = 1e-9;

/// A larger error where a sight says that it is zero is a wrong sight.
inline constexpr double kSightTolerance = 1e-6;

/// The largest difference between the Jacobians of a type and differences of its error, over
/// all scenarios.
struct EdgeTypeCheck {
  GradientCheck worst;
  std::string scenario;        ///< the scenario with this difference
  Graph graph;                 ///< the edge with this difference
  std::size_t not_finite = 0;  ///< trials whose error or Jacobians are not finite
  std::size_t trials = 0;
  std::size_t judged = 0;  ///< Jacobians that differences could check
  RelativeCheck relative;  ///< the largest change by a rigid motion, if the type says kRelative
  /// The largest difference between the normal equations of the edge and those of its Jacobians, relative
  /// to their size. A type whose vertices have a wrong carry() has wrong ones.
  double normal_error = 0;
  /// The largest error of the edge where its sight says that it is zero (base/sight.hpp); 0 without a sight.
  double sight_error = 0;

  [[nodiscard]] bool sound() const {
    return worst.error <= kGradientTolerance && not_finite == 0 && judged > 0 &&
           relative.error <= kRelativeTolerance && normal_error <= kNormalTolerance &&
           sight_error <= kSightTolerance;
  }
};

/// Checks a type. The result is the same in every run. @param repetitions trials per scenario
[[nodiscard]] EdgeTypeCheck check_edge_type(const TypeRegistry& registry, const EdgeType& type,
                                            int repetitions = 20);

}  // namespace waymark
