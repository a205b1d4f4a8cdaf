#include "support/paths.hpp"

namespace waymark_test {

std::filesystem::path shared_data_dir() {
  return WAYMARK_SHARED_DATA;
}

std::filesystem::path examples_dir() {
  return WAYMARK_SOURCE_DIR "/examples";
}

std::string source_dir() {
  return WAYMARK_SOURCE_DIR;
}

std::string plugin_dir() {
  return WAYMARK_BINARY_DIR "/plugins";
}

std::string test_module_dir() {
  return WAYMARK_BINARY_DIR "/test_modules";
}

std::string extension_dir() {
  return WAYMARK_BINARY_DIR "/examples/extensions";
}

std::string program_path() {
  return WAYMARK_BINARY_DIR "/bin/waymark";
}

}  // namespace waymark_test
