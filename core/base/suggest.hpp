/// "Did you mean ...?" for messages about words that do not exist.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace waymark {

/// Number of insertions, deletions, replacements and swaps of neighbours that turn `a` into `b`, capital
/// letters counted as small ones (optimal string alignment). O(|a| |b|).
[[nodiscard]] std::size_t edit_distance(std::string_view a, std::string_view b);

/// "; did you mean 'columns'?" for the nearest candidate within a third of its length (at least one edit),
/// the first of equals; empty where none is near.
[[nodiscard]] std::string did_you_mean(std::string_view word, std::span<const std::string_view> candidates);

/// What ends a message about an unknown word: did_you_mean where one candidate is nearer than all others,
/// else "; there are: a, b, c".
[[nodiscard]] std::string suggestion(std::string_view word, std::span<const std::string_view> candidates);

/// "a, b, c".
[[nodiscard]] std::string joined(std::span<const std::string_view> words);
[[nodiscard]] std::string joined(std::span<const std::string> words);

/// The same text with ASCII letters in lower case, whatever the locale.
[[nodiscard]] std::string lower_case(std::string_view text);

}  // namespace waymark
