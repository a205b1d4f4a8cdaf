/// Text as XML 1.0 may hold it.
#pragma once

#include <string>
#include <string_view>

namespace waymark {

/// Escapes & < > " ' for content and attributes alike. Bytes that are no UTF-8, and characters that XML 1.0
/// does not allow even when escaped (most control characters), become U+FFFD.
[[nodiscard]] std::string xml_text(std::string_view text);

}  // namespace waymark
