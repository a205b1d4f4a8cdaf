/// Which unknown the edges determine least.
#pragma once

#include <cstdint>
#include <string>

#include <waymark/core/linear/linear_solver.hpp>
#include <waymark/core/system/normal_equations.hpp>

namespace waymark {

/// Returns the unknown that moves most in the direction d in which chi2 grows least: the smallest d^T H d
/// for d^T diag(H) d = 1, so that metres and radians count alike. Found by inverse iteration with slight
/// damping, from the present linearisation.
/// @param solver analysed for the pattern of the equations; it holds another factor afterwards
[[nodiscard]] std::int64_t weakest_unknown(const NormalEquations& equations, LinearSolver& solver);

/// Returns a sentence that names the vertex of the weakest unknown, and what it lacks.
[[nodiscard]] std::string describe_weakest(const Graph& graph, const NormalEquations& equations,
                                           LinearSolver& solver);

}  // namespace waymark
