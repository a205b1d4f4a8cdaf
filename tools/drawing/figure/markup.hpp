/// Pieces of HTML and SVG text.
#pragma once

#include <string>
#include <string_view>

namespace waymark::drawing {

/// Text as it may stand in an element or a quoted attribute: & < > " ' become references; control characters,
/// which neither format may hold, and bytes that are not UTF-8 become the replacement character.
[[nodiscard]] std::string escaped(std::string_view text);

/// A coordinate in px with one decimal at most: "12", "12.5". What is not finite is 0.
[[nodiscard]] std::string px(double value);

/// A number for reading: four significant digits, "-" where it is not finite.
[[nodiscard]] std::string readable(double value);

}  // namespace waymark::drawing
