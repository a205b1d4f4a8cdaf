/// A case that lacks something skips itself: it says so and returns.
#pragma once

#include <optional>
#include <string>

namespace waymark_test {

/// Whether the tests are built with AddressSanitizer, whose shadow memory takes all of the address space.
#if defined(__SANITIZE_ADDRESS__)
inline constexpr bool kAddressSanitized = true;
#elif defined(__has_feature)
inline constexpr bool kAddressSanitized = __has_feature(address_sanitizer);
#else
inline constexpr bool kAddressSanitized = false;
#endif

/// Prints "SKIPPED: reason", by which ctest counts the case as skipped.
void skip(const std::string& reason);

/// Returns the path of a file or folder of the shared data (shared_data_dir). If it is missing,
/// says that the case is skipped and returns nothing.
[[nodiscard]] std::optional<std::string> shared_data(const std::string& name);

}  // namespace waymark_test
