/// The median of a list.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace waymark {

/// Returns the upper median. @param values at least one
template <class T>
[[nodiscard]] T upper_median(std::vector<T> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace waymark
