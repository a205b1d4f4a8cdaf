/// Makes text safe for XML 1.0 and HTML.
#pragma once

#include <string>
#include <string_view>

namespace waymark::formats {

/// Escapes & < > " ' for elements and for quoted attributes. These become U+FFFD: bytes that are no
/// UTF-8, characters that XML 1.0 forbids even when escaped, and control characters other than tab
/// and line feed.
[[nodiscard]] std::string xml_text(std::string_view text);

}  // namespace waymark::formats
