/// Completion for bash, from the tree of subcommands, and for zsh and fish, which ask bash's. Names of solvers, modelings and the like are
/// requested at the moment of completion, so that plugins can add theirs.
#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include <waymark/core/registry/registry.hpp>

namespace waymark::program {

/// Returns the script that bash sources.
[[nodiscard]] std::string bash_completion(const CLI::App& app);

/// Returns the script that another shell sources. It needs bash, which completes for it.
/// @param shell "zsh" or "fish"
[[nodiscard]] std::string other_completion(const std::string& shell);

/// Tells whether a word in the type name of an option stands for names that completion_values()
/// knows: "SOLVER".
[[nodiscard]] bool is_name_kind(const std::string& kind);

/// Returns the possible names: for SOLVER "cholmod", ...; for LOSS:SCALE "huber:", which the
/// user completes.
/// @throws UsageError for an unknown kind
[[nodiscard]] std::vector<std::string> completion_values(const std::string& kind,
                                                         const TypeRegistry& registry);

}  // namespace waymark::program
