/// Receives a text piece by piece, so that a large text need not be in memory as a whole.
#pragma once

#include <functional>
#include <string>
#include <string_view>

namespace waymark::formats {

/// Called with the pieces in order. A piece is valid only during the call. The sink may throw.
using TextSink = std::function<void(std::string_view)>;

/// Collects the whole text that `produce` gives to its sink.
template <typename Produce>
[[nodiscard]] std::string collect_text(Produce produce) {
  std::string text;
  produce(TextSink([&text](std::string_view piece) { text += piece; }));
  return text;
}

}  // namespace waymark::formats
