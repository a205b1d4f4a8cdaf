#include <waymark/solvers/algorithms/detail/algorithms.hpp>
#include <waymark/solvers/linear/detail/backends.hpp>
#include <waymark/solvers/register.hpp>

namespace waymark::solvers {

void register_solvers(TypeRegistry& registry) {
  registry.add_linear_solver(block_cholesky_solver());
#ifdef WAYMARK_WITH_CHOLMOD
  for (const LinearSolverType& solver : cholmod_solvers()) registry.add_linear_solver(solver);
#endif
#ifdef WAYMARK_WITH_CSPARSE
  registry.add_linear_solver(csparse_solver());
#endif
  registry.add_linear_solver(eigen_solver());
  registry.add_algorithm(gauss_newton());
  registry.add_algorithm(levenberg_marquardt());
  registry.add_algorithm(dogleg());
}

}  // namespace waymark::solvers
