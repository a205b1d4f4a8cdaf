/// How messages count the iterations of a run.
#pragma once

#include <string>

namespace waymark::detail {

/// Returns "after 7 iterations". A run that is put together from two parts counts anew.
[[nodiscard]] inline std::string after_iterations(int count) {
  return "after " + std::to_string(count) + " iterations";
}

}  // namespace waymark::detail
