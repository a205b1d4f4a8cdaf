/// Loads plugins: built-in ones by their descriptor, modules by file name. Modules are
/// never unloaded.
///
/// Only one thread at a time may load plugins, because loading changes the process.
#pragma once

#include <string>

#include <waymark/core/base/export.hpp>
#include <waymark/core/registry/plugin.hpp>

namespace WAYMARK_EXPORT waymark {

/// Checks a descriptor against this build and lets the plugin register its types under its name. If
/// the registration throws, none of them is registered.
/// @param place origin of the plugin: a file, or "built in"
/// @throws UsageError that names the plugin, the difference and the remedy; errors of the
/// registration with the name added
void enter_plugin(const PluginDescriptor& descriptor, PluginEntry enter, const std::string& place,
                  TypeRegistry& registry);

/// Reads the descriptor of a module from its file. Only if it fits this build, the module is loaded
/// and its types are registered. A file is refused before any of its code runs if it has no
/// descriptor, belongs to another build or ABI, or was linked with -ffast-math or -Ofast. The
/// start-up code of the last would make the whole process flush denormal numbers to zero.
/// @throws UsageError for a file that cannot be loaded, is no plugin or does not fit
void load_plugin(const std::string& file, TypeRegistry& registry);

}  // namespace waymark
