/// Helpers for HTML and SVG text.
#pragma once

#include <string>
#include <string_view>

namespace waymark::drawing {

/// Escapes text for an element or a quoted attribute: & < > " ' become references. Control
/// characters, which both formats forbid, and bytes that are not UTF-8 become the
/// replacement character.
[[nodiscard]] std::string escaped(std::string_view text);

/// Returns a coordinate in px with at most one decimal: "12", "12.5". A number that is not
/// finite becomes 0.
[[nodiscard]] std::string px(double value);

}  // namespace waymark::drawing
