/// The folders of the tests' data, and of their output. The folders come from the build, so tests
/// run from any working directory. Only paths.cpp is compiled with their names: the other objects
/// are the same in every build folder.
#pragma once

#include <filesystem>
#include <string>

#include <unistd.h>

namespace waymark_test {

/// Large drives and benchmark graphs. They may be missing: a case asks shared_data (support/skip.hpp)
/// for a file, and skips itself.
[[nodiscard]] std::filesystem::path shared_data_dir();

/// The drives, graphs and descriptions that come with the repository.
[[nodiscard]] std::filesystem::path examples_dir();

/// The sources of Waymark.
[[nodiscard]] std::string source_dir();
/// The modules of the plugins that come with Waymark.
[[nodiscard]] std::string plugin_dir();
/// The modules that are made for the tests (modules/sample.cpp).
[[nodiscard]] std::string test_module_dir();
/// The modules of examples/extensions.
[[nodiscard]] std::string extension_dir();
/// The program that was built.
[[nodiscard]] std::string program_path();

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
