/// The forms of words that all fields of a column may have: dates, angles with letters, letters alone.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include <waymark/tools/inspection/survey/header_words.hpp>

namespace waymark::inspection {

/// A set of forms, one bit each.
using FieldForms = std::uint32_t;
inline constexpr FieldForms kAllForms = ~FieldForms{0};

/// Returns those of `among` that a field may have.
[[nodiscard]] FieldForms forms_of(std::string_view field, FieldForms among);

/// Tells whether fields of these forms hold dates with times of day.
[[nodiscard]] bool holds_instants(FieldForms forms);
/// Reads a field of such a column in s since 1970; 0 if it is none.
[[nodiscard]] double instant_seconds(std::string_view field, FieldForms forms);

/// Completes or replaces the proposal of a column whose fields are all words of these forms. It is empty if the
/// words have no meaning here.
/// @param by_name the proposal by the name of the column
[[nodiscard]] ColumnProposal proposal_of_forms(FieldForms forms, const ColumnProposal& by_name);

}  // namespace waymark::inspection
