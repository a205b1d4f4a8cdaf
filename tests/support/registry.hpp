/// The registry that the program uses, for tests.
#pragma once

#include <waymark/core/registry.hpp>
#include <waymark/plugins/builtin.hpp>
#include <waymark/solvers/register.hpp>
#include <waymark/types_se2/register.hpp>

namespace waymark_test {

/// Core, SE(2), all solvers and algorithms, all built-in plugins.
[[nodiscard]] inline waymark::TypeRegistry full_registry() {
  waymark::TypeRegistry registry;
  waymark::register_core_types(registry);
  waymark::register_se2_types(registry);
  waymark::register_solvers(registry);
  waymark::register_builtin_plugins(registry);
  return registry;
}

}  // namespace waymark_test
