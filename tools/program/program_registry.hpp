/// What the program knows: its own types, its built-in plugins and the modules that it finds or is told of.
#pragma once

#include <string>
#include <vector>

#include <waymark/core/registry.hpp>
#include <waymark/tools/program/console.hpp>

namespace waymark {

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

/// The registry for a command whose input may be a drive.yaml: with the plugins that it names.
[[nodiscard]] TypeRegistry make_registry_for(const std::string& input, const CommonOptions& options);

}  // namespace waymark
