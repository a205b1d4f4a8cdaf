// Every option of every registered type: its default is allowed, and its text names all of its words.
#include <catch2/catch.hpp>

#include "support/registry.hpp"

using namespace waymark;

namespace {

template <typename T>
void check_options(const RegistryTable<T>& table) {
  for (const auto& [type, origin] : table) {
    INFO(type.name << " of " << origin);
    CHECK_NOTHROW(CheckedOptions(type.name, {}, type.options));
    for (const OptionInfo& option : type.options) {
      INFO(option.name);
      CHECK_FALSE(option.text.empty());
      const auto* words = std::get_if<OptionWords>(&option.allowed);
      if (words == nullptr) continue;
      CHECK(words->size() > 1);
      CHECK_FALSE(option.prior.has_value());  // only a number can be estimated
      for (const std::string& word : *words) CHECK(option.text.find("'" + word + "'") != std::string::npos);
    }
  }
}

}  // namespace

TEST_CASE("every option: its default is allowed, and its text names all of its words") {
  const TypeRegistry registry = waymark_test::full_registry();
  check_options(registry.algorithms());
  check_options(registry.odometry_models());
  check_options(registry.gnss_modelings());
  check_options(registry.sensor_models());
}

TEST_CASE("every odometry model: the option that takes the gap's factor is one of its numbers") {
  const TypeRegistry registry = waymark_test::full_registry();
  for (const auto& [type, origin] : registry.odometry_models()) {
    INFO(type.name);
    if (type.gap_factor_option.empty()) continue;
    CHECK_NOTHROW(CheckedOptions(type.name, {}, type.options).number(type.gap_factor_option));
  }
}
