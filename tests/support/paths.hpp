/// Where tests find their data and may write. The folders come from the build (compile definitions), so that
/// tests run from any working directory.
#pragma once

#include <filesystem>
#include <string>

#include <unistd.h>

namespace waymark_test {

/// Large drives and benchmark graphs; may be absent: such a test prints "SKIPPED: reason" and returns.
[[nodiscard]] inline std::filesystem::path shared_data_dir() {
  return WAYMARK_SHARED_DATA;
}

/// The small files of tests/data.
[[nodiscard]] inline std::filesystem::path test_data_dir() {
  return WAYMARK_TEST_DATA;
}

/// A folder of this process for files that a test writes; made on first use.
[[nodiscard]] inline std::filesystem::path scratch_dir() {
  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / ("waymark_test_" + std::to_string(::getpid()));
  std::filesystem::create_directories(folder);
  return folder;
}

}  // namespace waymark_test
