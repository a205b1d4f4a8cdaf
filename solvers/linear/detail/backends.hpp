/// The linear backends of this folder, as registry entries.
#pragma once

#include <vector>

#include <waymark/core/linear/linear_solver.hpp>

namespace waymark::solvers {

[[nodiscard]] LinearSolverType block_cholesky_solver();
[[nodiscard]] std::vector<LinearSolverType> cholmod_solvers();
[[nodiscard]] LinearSolverType csparse_solver();
[[nodiscard]] LinearSolverType eigen_solver();

}  // namespace waymark::solvers
