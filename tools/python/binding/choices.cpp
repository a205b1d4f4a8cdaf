#include <waymark/tools/python/binding/choices.hpp>

#include <cmath>

#include <fmt/format.h>

#include <waymark/core/base/error.hpp>

namespace waymark::python {

drive::Minimization minimization_of(const pybind11::dict& given) {
  drive::Minimization how;
  take(given, "start", how.start);
  take(given, "algorithm", how.algorithm);
  take(given, "algorithm_options", how.options);
  take(given, "solver", how.solver);
  take(given, "solver_options", how.solver_options);
  take(given, "covariances", how.covariances);
  if (take(given, "threads", how.threads) && (how.threads < 1 || how.threads > 256))
    throw UsageError(fmt::format("threads: must be from 1 to 256, got {}", how.threads));
  if (take(given, "max_iterations", how.max_iterations) && how.max_iterations < 0)
    throw UsageError(fmt::format("max_iterations: must be at least 0, got {}", how.max_iterations));
  if (take(given, "tolerance", how.tolerance) && !(how.tolerance > 0 && std::isfinite(how.tolerance)))
    throw UsageError(fmt::format("tolerance: must be above 0, got {}", how.tolerance));
  if (how.covariances != "none" && how.covariances != "fixes" && how.covariances != "all")
    throw UsageError(fmt::format("covariances: expected none, fixes or all, got '{}'", how.covariances));
  return how;
}

}  // namespace waymark::python
