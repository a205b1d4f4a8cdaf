/// Checks the values of options against what they may be.
#pragma once

#include <span>
#include <string>

#include <waymark/core/registry/options.hpp>

namespace waymark {

/// Returns whether a value may have a structure, in flow style. The text of others is the value.
[[nodiscard]] bool has_structure(const OptionInfo& option);

/// Returns "unknown option 'x'; did you mean 'y'?". @param what "option" or "key"
[[nodiscard]] std::string problem_with_name(const char* what, const std::string& name,
                                            std::span<const OptionInfo> known);

/// Checks what a type says of its own options: a prior belongs to a number, begins within its range, and names
/// an option of words and one of its words if any.
/// @throws UsageError "owner: the prior of option 'sigma' ..." for its author
void require_sound_priors(const std::string& owner, std::span<const OptionInfo> options);

/// @param owner name of the type that has the option
/// @throws OptionError "owner: option 'anchors[2].x' must be a number, got 'a'"
[[nodiscard]] OptionValue checked_value(const std::string& owner, const OptionInfo& option,
                                        const std::string& value);

}  // namespace waymark
