/// Structured values as text, in the flow style of YAML 1.2 (section 7.4): `[1, 2]`, `{x: 1, y: 2}`,
/// and both within each other. Words with other characters than letters, digits and `_+-./:#` stand
/// in double quotes, with `\` before `"` and `\`.
#pragma once

#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include <waymark/core/base/export.hpp>

namespace WAYMARK_EXPORT waymark {

struct FlowEntry;

/// A value as it is written: a text, a list, or a mapping in the order of the text.
struct FlowValue {
  using List = std::vector<FlowValue>;
  using Mapping = std::vector<FlowEntry>;
  std::variant<std::string, List, Mapping> content;

  /// Returns "'abc'", "a list" or "a mapping", for messages.
  [[nodiscard]] std::string description() const;
};

/// A name of a mapping, and its value.
struct FlowEntry {
  std::string name;
  FlowValue value;
};

/// Parses a text that begins with `[` or `{`; any other text is itself the value.
/// @throws UsageError "expected ',' or ']' at character 7" and the like
[[nodiscard]] FlowValue parse_flow(std::string_view text);

/// The inverse of parse_flow.
[[nodiscard]] std::string flow_text(const FlowValue& value);

}  // namespace waymark
