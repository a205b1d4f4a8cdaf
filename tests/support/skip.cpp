#include "support/skip.hpp"

#include <filesystem>
#include <iostream>

#include "support/paths.hpp"

namespace waymark_test {

void skip(const std::string& reason) {
  std::cout << "SKIPPED: " << reason << "\n";
}

std::optional<std::string> shared_data(const std::string& name) {
  const auto path = shared_data_dir() / name;
  if (std::filesystem::exists(path)) return path.string();
  skip(path.string() + " is absent");
  return std::nullopt;
}

}  // namespace waymark_test
