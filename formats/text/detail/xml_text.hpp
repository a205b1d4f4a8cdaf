/// Text as XML 1.0, and HTML, may hold it.
#pragma once

#include <string>
#include <string_view>

namespace waymark::formats {

/// Escapes & < > " ' for elements and quoted attributes alike. Bytes that are no UTF-8, characters that
/// XML 1.0 does not allow even when escaped, and the other control characters but tab and line feed become
/// U+FFFD.
[[nodiscard]] std::string xml_text(std::string_view text);

}  // namespace waymark::formats
