/// Completion for bash, from the tree of subcommands. Names of solvers, modelings and the like are asked for
/// when they are completed, so that plugins add theirs.
#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include <waymark/core/registry/registry.hpp>

namespace waymark::program {

/// The script to be sourced.
[[nodiscard]] std::string bash_completion(const CLI::App& app);

/// Whether a word in an option's type name stands for names that completion_values() knows: "SOLVER".
[[nodiscard]] bool is_name_kind(const std::string& kind);

/// The names that a word may be: of SOLVER "cholmod", ...; of LOSS:SCALE "huber:", to be continued.
/// @throws UsageError for an unknown kind
[[nodiscard]] std::vector<std::string> completion_values(const std::string& kind,
                                                         const TypeRegistry& registry);

}  // namespace waymark::program
