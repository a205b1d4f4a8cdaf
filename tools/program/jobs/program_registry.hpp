/// What the program knows: its own types, its built-in plugins and the modules that it finds or is told of.
#pragma once

#include <string>
#include <vector>

#include <waymark/core/registry/registry.hpp>
#include <waymark/tools/program/terminal/console.hpp>

namespace waymark::program {

/// Core, SE(2), solvers, built-in plugins and log readers; then, each file once,
///   1. the modules of --plugin, then those of a drive.yaml: a file, or a name that is looked up in the
///   folders,
///   2. the modules of the folder of installed plugins and of every folder of WAYMARK_PLUGIN_PATH (separated
///   by
///      ':'), by name; one that does not fit, or whose name was loaded before, is left out with a warning.
/// @param plugins  of a drive.yaml
/// @throws UsageError for a module of the first kind that cannot be found or does not fit
[[nodiscard]] TypeRegistry make_registry(const CommonOptions& options,
                                         const std::vector<std::string>& plugins = {});

/// A folder in which plugins are looked for.
struct PluginFolder {
  std::string path;
  bool installed = false;  ///< the program's own; else of WAYMARK_PLUGIN_PATH
  std::string problem;     ///< why nothing can come from it; empty: none
};

/// A module that was asked for or lay in a folder.
struct PluginModule {
  enum class State { loaded, refused, no_plugin };
  std::string file;        ///< where it was not found: the name
  bool asked_for = false;  ///< by --plugin or a drive.yaml
  State state = State::loaded;
  std::string problem;  ///< reason and remedy where it was not loaded
};

/// The registry, and how the search for plugins went.
struct PluginSearch {
  TypeRegistry registry;
  std::vector<PluginFolder> folders;
  std::vector<PluginModule> modules;  ///< in the order in which they were tried
};

/// What make_registry does, without a word: what cannot be loaded is in the result.
/// @param wanted  files or names
[[nodiscard]] PluginSearch search_plugins(const std::vector<std::string>& wanted);

/// Names by which --plugin finds the modules of the folders.
[[nodiscard]] std::vector<std::string> installed_plugin_names();

}  // namespace waymark::program
