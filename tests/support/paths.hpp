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

/// The drives, graphs and descriptions that come with the repository.
[[nodiscard]] inline std::filesystem::path examples_dir() {
  return WAYMARK_SOURCE_DIR "/examples";
}

/// A folder of this process for files that a test writes; made on first use, removed at the end.
[[nodiscard]] inline std::filesystem::path scratch_dir() {
  struct Folder {
    std::filesystem::path path =
        std::filesystem::temp_directory_path() / ("waymark_test_" + std::to_string(::getpid()));
    Folder() { std::filesystem::create_directories(path); }
    ~Folder() {
      std::error_code ignored;
      std::filesystem::remove_all(path, ignored);
    }
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;
  };
  static const Folder folder;
  return folder.path;
}

}  // namespace waymark_test
