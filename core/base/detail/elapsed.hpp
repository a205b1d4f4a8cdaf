/// Measures elapsed time with the clock that nobody sets.
#pragma once

#include <chrono>

namespace waymark::detail {

using Clock = std::chrono::steady_clock;

[[nodiscard]] inline double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

}  // namespace waymark::detail
