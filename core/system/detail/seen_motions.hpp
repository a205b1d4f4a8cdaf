/// The rigid motions of a component that its edges see.
#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

#include <waymark/core/system/detail/components.hpp>

namespace waymark::detail {

/// Returns how many eigenvalues are above the noise of the largest. 0 if all of them are only rounding.
/// @param unit of the information of the graph
[[nodiscard]] int rank_of(const Eigen::Matrix3d& information, double unit);

/// Returns the motions that the edges do not see, 3 x (3 - rank). @param information as rank_of takes it
[[nodiscard]] Eigen::MatrixXd unseen_motions(const Eigen::Matrix3d& information, double unit);

/// Returns per component the sum of d d^T over the directions d in which the edges move an error by a rigid motion of
/// the component, however faintly: metres of 1e4 m beside radians of 1e-6 are as good as any. Its unit is 1. It takes
/// its time, and is asked before components are held in part.
/// @param asked per component: not 0 if it is wanted; zero is returned for the others
[[nodiscard]] std::vector<Eigen::Matrix3d> seen_directions(const Graph& graph, const Components& components,
                                                           std::span<const char> asked);

/// Returns the directions that the edges would see if the vertices of the asked components stood at other, generic
/// places. These are more than seen_directions() where the present places are special: fixes of vertices that stand
/// at one place see no turn of it, but will see one of the minimum.
[[nodiscard]] std::vector<Eigen::Matrix3d> seen_elsewhere(const Graph& graph, const Components& components,
                                                          std::span<const char> asked);

}  // namespace waymark::detail
