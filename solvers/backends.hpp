/// The backends and algorithms of this folder, as registry entries.
#pragma once

#include <vector>

#include <waymark/core/algorithm.hpp>
#include <waymark/core/linear_solver.hpp>

namespace waymark {

[[nodiscard]] std::vector<LinearSolverType> cholmod_solvers();
[[nodiscard]] LinearSolverType csparse_solver();
[[nodiscard]] LinearSolverType eigen_solver();

[[nodiscard]] AlgorithmType gauss_newton();
[[nodiscard]] AlgorithmType levenberg_marquardt();
[[nodiscard]] AlgorithmType dogleg();

}  // namespace waymark
