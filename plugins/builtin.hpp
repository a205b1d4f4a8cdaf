/// The plugins that were built into this library.
#pragma once

#include <waymark/core/registry/registry.hpp>

namespace waymark::plugins {

/// Enters every built-in plugin, through the same door that modules use.
void register_builtin_plugins(TypeRegistry& registry);

}  // namespace waymark::plugins
