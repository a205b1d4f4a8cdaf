/// Fills the registry of the program: its own types, its built-in plugins, and modules from folders
/// or by request.
#pragma once

#include <string>
#include <vector>

#include <waymark/core/registry/registry.hpp>
#include <waymark/tools/program/terminal/console.hpp>

namespace waymark::program {

/// Returns the plugin that brought a vertex or edge type into the last registry of this process; empty for
/// types of Waymark itself and unknown ones. Messages need it where no registry is at hand.
[[nodiscard]] std::string plugin_of(const std::string& type);

/// Returns a registry with core, SE(2), solvers, built-in plugins and log readers, and then with
/// these modules, each file once:
/// 1. the modules of --plugin, then those of a drive.yaml: a file, or a name that is looked up in
///    the folders;
/// 2. by name, the modules of the folder of installed plugins and of every folder of
///    WAYMARK_PLUGIN_PATH (separated by ':'). If one does not fit, or its name was loaded before,
///    it is left out with a warning.
/// @param plugins those of a drive.yaml
/// @throws UsageError for a module of the first kind that cannot be found or does not fit
[[nodiscard]] TypeRegistry make_registry(const CommonOptions& options,
                                         const std::vector<std::string>& plugins = {});
/// The same, with warnings on this console.
[[nodiscard]] TypeRegistry make_registry(const CommonOptions& options,
                                         const std::vector<std::string>& plugins, const Console& console);

/// A folder that is searched for plugins.
struct PluginFolder {
  std::string path;
  bool installed = false;  ///< the folder of the program; else one of WAYMARK_PLUGIN_PATH
  std::string problem;     ///< why it cannot provide plugins; empty: no problem
};

/// A module that was requested or found in a folder.
struct PluginModule {
  enum class State { loaded, refused, no_plugin };
  std::string file;        ///< the name, if no file was found
  bool asked_for = false;  ///< by --plugin or a drive.yaml
  State state = State::loaded;
  std::string problem;  ///< if it was not loaded: reason and remedy
};

/// The registry, and the record of the search for plugins.
struct PluginSearch {
  TypeRegistry registry;
  std::vector<PluginFolder> folders;
  std::vector<PluginModule> modules;  ///< in the order in which they were tried
};

/// Does the work of make_registry without messages. The result lists modules that cannot be loaded.
/// @param wanted files or names
[[nodiscard]] PluginSearch search_plugins(const std::vector<std::string>& wanted);

/// Returns the names by which --plugin finds the modules of the folders.
[[nodiscard]] std::vector<std::string> installed_plugin_names();

}  // namespace waymark::program
