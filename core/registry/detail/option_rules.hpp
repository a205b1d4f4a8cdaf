/// What an option may be, in words for messages and lists.
#pragma once

#include <string>

#include <waymark/core/registry/options.hpp>

namespace waymark {

/// Returns "'off' or 'constant'".
[[nodiscard]] std::string quoted(const OptionWords& words);

/// Returns "3 or more", "2 to 4", "3": the elements of a list.
[[nodiscard]] std::string count_text(const OptionList& list);

/// Returns "number m in [0, 1]", "file", "list of ...".
[[nodiscard]] std::string kind_text(const OptionInfo& option);

/// Returns what its text does not say: "in [0, 1]", "list of ..."; empty for words and texts.
[[nodiscard]] std::string allowed_text(const OptionInfo& option);

}  // namespace waymark
