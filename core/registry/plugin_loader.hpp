/// Loading plugins: built-in ones by their descriptor, modules by file name. Modules are never unloaded.
#pragma once

#include <string>

#include <waymark/core/registry/plugin.hpp>

namespace waymark {

/// Checks a descriptor against this build and lets the plugin register its types under its name; all of them
/// or, where the registration throws, none.
/// @param place  where the plugin comes from: a file, "built in"
/// @throws UsageError naming the plugin, what differs and the remedy; what the registration throws, with the
/// name added.
void enter_plugin(const PluginDescriptor& descriptor, PluginEntry enter, const std::string& place,
                  TypeRegistry& registry);

/// Reads a module's descriptor from its file, and only where that fits this build loads it and registers its
/// types. A file without the descriptor, of another build or ABI, or one that was linked with -ffast-math or
/// -Ofast (its start-up code would make the whole process flush denormal numbers to zero) is refused before
/// any of its code runs.
/// @throws UsageError for a file that cannot be loaded, is no plugin or does not fit.
void load_plugin(const std::string& file, TypeRegistry& registry);

}  // namespace waymark
