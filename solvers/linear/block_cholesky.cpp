#include <waymark/core/block_cholesky.hpp>
#include <waymark/solvers/linear/backends.hpp>

namespace waymark {

LinearSolverType block_cholesky_solver() {
  return {"block_cholesky", "Waymark's own: chains link by link, dense fronts elsewhere; parallel",
          "BSD-3-Clause", [] { return std::make_unique<BlockCholesky>(); }};
}

}  // namespace waymark
