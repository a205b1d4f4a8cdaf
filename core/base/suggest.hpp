/// "Did you mean ...?" for messages about unknown words.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include <waymark/core/base/export.hpp>

namespace WAYMARK_EXPORT waymark {

/// Returns the number of insertions, deletions, replacements and swaps of neighbours that turn `a`
/// into `b` (optimal string alignment). Capital letters count as small ones. O(|a| |b|).
[[nodiscard]] std::size_t edit_distance(std::string_view a, std::string_view b);

/// Returns "; did you mean 'columns'?" for the nearest candidate, the first of equals. The distance
/// may be a third of its length (at least one edit). Empty if no candidate is near.
[[nodiscard]] std::string did_you_mean(std::string_view word, std::span<const std::string_view> candidates);

/// Returns the end of a message about an unknown word: did_you_mean if one candidate is nearer than
/// all others, or else "; there are: a, b, c".
[[nodiscard]] std::string suggestion(std::string_view word, std::span<const std::string_view> candidates);

/// Returns "a, b, c".
[[nodiscard]] std::string joined(std::span<const std::string_view> words);
[[nodiscard]] std::string joined(std::span<const std::string> words);

/// Returns the text with ASCII letters in lower case, in any locale.
[[nodiscard]] std::string lower_case(std::string_view text);

}  // namespace waymark
