#include <waymark/core/linear/block_cholesky.hpp>
#include <waymark/solvers/linear/detail/backends.hpp>

namespace waymark::solvers {

LinearSolverType block_cholesky_solver() {
  return {"block_cholesky", "Waymark's own: chains link by link, dense fronts elsewhere; parallel",
          "BSD-3-Clause", [](const CheckedOptions&) { return std::make_unique<BlockCholesky>(); }};
}

}  // namespace waymark::solvers
