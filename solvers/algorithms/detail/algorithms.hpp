/// The algorithms of this folder, as registry entries.
#pragma once

#include <waymark/core/optimize/algorithm.hpp>

namespace waymark::solvers {

[[nodiscard]] AlgorithmType gauss_newton();
[[nodiscard]] AlgorithmType levenberg_marquardt();
[[nodiscard]] AlgorithmType dogleg();

}  // namespace waymark::solvers
