// Every option of every registered type: its default is allowed, and its text names all of its words.
#include <algorithm>

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

TEST_CASE(
    "every sensor: the loss of its measurements is registered, and its search for noise has values allowed") {
  const TypeRegistry registry = waymark_test::full_registry();
  for (const auto& [type, origin] : registry.sensor_models()) {
    INFO(type.name << " of " << origin);
    if (type.loss != "none") CHECK(registry.find_loss(type.loss.substr(0, type.loss.find(':'))) != nullptr);
    for (const auto& [name, value] : type.noise_search.options) {
      const Options alone = {{name, value}};
      const auto option = std::find_if(type.options.begin(), type.options.end(),
                                       [&of = name](const OptionInfo& known) { return known.name == of; });
      REQUIRE(option != type.options.end());
      CHECK_NOTHROW(CheckedOptions(type.name, alone, {&*option, 1}));
    }
  }
}

TEST_CASE("every odometry model: the option that takes the gap's factor is one of its numbers") {
  const TypeRegistry registry = waymark_test::full_registry();
  for (const auto& [type, origin] : registry.odometry_models()) {
    INFO(type.name);
    if (type.gap_factor_option.empty()) continue;
    CHECK_NOTHROW(CheckedOptions(type.name, {}, type.options).number(type.gap_factor_option));
  }
}
