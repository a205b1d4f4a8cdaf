/// Which unknowns the edges determine least, and whether they determine them at all.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <waymark/core/linear/linear_solver.hpp>
#include <waymark/core/system/normal_equations.hpp>

namespace waymark {

/// Tells whether the factor of H may be rounding in the direction in which chi2 grows least: d^T H d there is less than a
/// thousand times its rounding. It takes one solve, and any scale of the unknowns and of the information is alike.
/// @param solver holds a factor of H, or of one that was linearised nearby
[[nodiscard]] bool is_on_the_verge(const NormalEquations& equations, LinearSolver& solver);

/// Tells whether the factor of H is rounding in that direction: d^T H d, which a variance is the reciprocal of, is more
/// than ten times what the edges say of d. The elimination of a singular H leaves such a pivot, and half of them are
/// positive. It takes one solve and, on the verge, a pass over the edges, which know sum |J d|^2_Omega up to eps^2.
/// @param values in the layout of graph.values(), where the equations are linearised
/// @param solver holds the factor of H
[[nodiscard]] bool is_lost_in_rounding(const Graph& graph, const std::vector<double>& values,
                                       const NormalEquations& equations, LinearSolver& solver);

/// Returns the direction d in which chi2 grows least: the smallest d^T H d for d^T diag(H) d = 1, so that metres and
/// radians count alike. Found by inverse iteration with slight damping, from the present linearisation.
/// @param solver analysed for the pattern of the equations; it holds another factor afterwards
[[nodiscard]] Eigen::VectorXd weakest_direction(const NormalEquations& equations, LinearSolver& solver);

/// Returns a sentence about that direction: the vertex of its unknown and what it lacks or, if several vertices move
/// in it, that their scale or a combination of them is not determined.
[[nodiscard]] std::string describe_weakest(const Graph& graph, const NormalEquations& equations,
                                           LinearSolver& solver);

}  // namespace waymark
