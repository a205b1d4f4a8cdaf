/// The registry that the program uses, for tests.
#pragma once

#include <cstdlib>
#include <sstream>
#include <string>

#include <waymark/core/registry/plugin_loader.hpp>
#include <waymark/core/registry/registry.hpp>
#include <waymark/plugins/builtin.hpp>
#include <waymark/solvers/register.hpp>
#include <waymark/types_se2/register.hpp>

namespace waymark_test {

/// Returns core, SE(2), all solvers and algorithms, and all built-in plugins. It also loads the
/// modules in the environment variable WAYMARK_TEST_PLUGINS (separated by colons), so that tests of
/// every type also test theirs.
[[nodiscard]] inline waymark::TypeRegistry full_registry() {
  waymark::TypeRegistry registry;
  waymark::register_core_types(registry);
  waymark::register_se2_types(registry);
  waymark::solvers::register_solvers(registry);
  waymark::plugins::register_builtin_plugins(registry);
  const char* named = std::getenv("WAYMARK_TEST_PLUGINS");
  std::istringstream modules(named == nullptr ? "" : named);
  for (std::string file; std::getline(modules, file, ':');) waymark::load_plugin(file, registry);
  return registry;
}

/// Returns full_registry(), made once for all cases that only read it.
[[nodiscard]] inline const waymark::TypeRegistry& registry() {
  static const waymark::TypeRegistry value = full_registry();
  return value;
}

}  // namespace waymark_test
