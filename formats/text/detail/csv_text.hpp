/// Fields of comma-separated values (RFC 4180 with "\n" line ends).
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace waymark::formats {

/// Appends a text. It is quoted if it contains a separator, a quote or a line end. A text that a
/// spreadsheet would compute, because it begins with = + - @ and is no number, gets a ' before it.
void append_csv_text(std::string& out, std::string_view text);

/// Appends a separator and the shortest digits that read back to the same double. The field is
/// empty if there is no value or it is not finite.
void append_csv_number(std::string& out, const std::optional<double>& value);

}  // namespace waymark::formats
