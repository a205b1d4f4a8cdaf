/// Loading plugins: built-in ones by their descriptor, modules by file name. Modules are never unloaded.
#pragma once

#include <string>

#include <waymark/core/plugin.hpp>

namespace waymark {

/// Checks a descriptor against this build and lets the plugin register its types under its name.
/// @throws UsageError naming the plugin, what differs and the remedy; what the registration throws, with the
/// name added.
void enter_plugin(const PluginDescriptor& descriptor, const std::string& place, TypeRegistry& registry);

/// dlopens a module, reads its descriptor before any of its code is called, and registers its types. The
/// floating-point environment is restored afterwards: a module linked with -Ofast would switch the process to
/// flush-to-zero.
/// @throws UsageError for a file that cannot be loaded or is no plugin.
void load_plugin(const std::string& file, TypeRegistry& registry);

}  // namespace waymark
