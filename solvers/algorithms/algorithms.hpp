/// The algorithms of this folder, as registry entries.
#pragma once

#include <waymark/core/algorithm.hpp>

namespace waymark {

[[nodiscard]] AlgorithmType gauss_newton();
[[nodiscard]] AlgorithmType levenberg_marquardt();
[[nodiscard]] AlgorithmType dogleg();

}  // namespace waymark
