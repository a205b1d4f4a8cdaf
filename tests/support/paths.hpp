/// Where tests find their data, and where they may write. The folders are compile definitions of
/// the build, so tests run from any working directory.
#pragma once

#include <filesystem>
#include <string>

#include <unistd.h>

namespace waymark_test {

/// Large drives and benchmark graphs. They may be missing; a test then prints "SKIPPED: reason"
/// and returns.
[[nodiscard]] inline std::filesystem::path shared_data_dir() {
  return WAYMARK_SHARED_DATA;
}

/// The drives, graphs and descriptions that come with the repository.
[[nodiscard]] inline std::filesystem::path examples_dir() {
  return WAYMARK_SOURCE_DIR "/examples";
}

/// A folder of this process for files that a test writes. It is created at first use and
/// removed at the end.
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
