/// Registers the plugins that were built into this library.
#pragma once

#include <waymark/core/registry/registry.hpp>

namespace waymark::plugins {

/// Registers every built-in plugin, in the same way as a plugin module does.
void register_builtin_plugins(TypeRegistry& registry);

}  // namespace waymark::plugins
