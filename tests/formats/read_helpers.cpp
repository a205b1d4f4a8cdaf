#include "formats/read_helpers.hpp"

#include <waymark/plugins/builtin.hpp>
#include <waymark/types_se2/register.hpp>

const waymark::TypeRegistry& test_registry() {
  static const waymark::TypeRegistry registry = [] {
    waymark::TypeRegistry made;
    waymark::register_core_types(made);
    waymark::register_se2_types(made);
    waymark::plugins::register_builtin_plugins(made);
    return made;
  }();
  return registry;
}
