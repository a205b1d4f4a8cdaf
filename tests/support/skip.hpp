/// A case that lacks something skips itself: it says so and returns.
#pragma once

#include <optional>
#include <string>

namespace waymark_test {

/// Prints "SKIPPED: reason", by which ctest counts the case as skipped.
void skip(const std::string& reason);

/// Returns the path of a file or folder of the shared data (shared_data_dir). If it is missing,
/// says that the case is skipped and returns nothing.
[[nodiscard]] std::optional<std::string> shared_data(const std::string& name);

}  // namespace waymark_test
