/// Unrolls loops over a few constants before the optimiser sees them, so that small matrices live
/// in registers.
#pragma once

#include <type_traits>
#include <utility>

#include <waymark/core/base/export.hpp>

namespace WAYMARK_EXPORT waymark {

/// Calls body(i) for i = first ... last - 1, where i is an integral constant. With more than 16
/// calls it is a plain loop.
template <int kFirst, int kLast, typename Body>
[[gnu::always_inline]] inline void unrolled(const Body& body) {
  if constexpr (kLast - kFirst <= 16) {
    const auto all = [&]<int... I>(std::integer_sequence<int, I...>) __attribute__((always_inline)) {
      (body(std::integral_constant<int, kFirst + I>()), ...);
    };
    all(std::make_integer_sequence<int, kLast - kFirst>());
  } else {
    for (int i = kFirst; i < kLast; ++i) body(i);
  }
}

}  // namespace waymark
