/// Fields of comma-separated values (RFC 4180 with "\n" line ends).
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace waymark::formats {

/// A text, quoted where it holds a separator, a quote or a line end.
void append_csv_text(std::string& out, std::string_view text);

/// A separator and the shortest digits that read back to the same double; an empty field where there is no
/// value or it is not finite.
void append_csv_number(std::string& out, const std::optional<double>& value);

}  // namespace waymark::formats
