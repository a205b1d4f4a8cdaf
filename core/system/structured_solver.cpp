#include <waymark/core/system/structured_solver.hpp>

namespace waymark {

LinearSolver& StructuredSolver::analysed() {
  const BlockPattern& pattern = structure_.pattern();
  if (pattern.version != analysed_version_ && pattern.dimension() > 0) {
    solver_.analyze(pattern);
    analysed_version_ = pattern.version;
  }
  return solver_;
}

}  // namespace waymark
