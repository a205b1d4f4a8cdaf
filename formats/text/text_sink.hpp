/// What takes a text piece by piece, so that a large one need not be in memory as a whole.
#pragma once

#include <functional>
#include <string>
#include <string_view>

namespace waymark::formats {

/// Called with one piece after the other, in order; a piece is valid during the call only. May throw.
using TextSink = std::function<void(std::string_view)>;

/// The whole text that `produce` gives to the sink that it is called with.
template <typename Produce>
[[nodiscard]] std::string collect_text(Produce produce) {
  std::string text;
  produce(TextSink([&text](std::string_view piece) { text += piece; }));
  return text;
}

}  // namespace waymark::formats
