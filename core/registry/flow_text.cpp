#include <waymark/core/registry/flow_text.hpp>

#include <algorithm>
#include <cctype>

#include <waymark/core/base/error.hpp>

namespace waymark {
namespace {

/// Deeper values would exhaust the stack; nobody writes them.
constexpr int kDeepest = 32;

bool is_plain(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 ||
         std::string_view("_+-./:#").find(c) != std::string_view::npos || static_cast<signed char>(c) < 0;
}

class FlowParser {
 public:
  explicit FlowParser(std::string_view text) : text_(text) {}

  FlowValue whole() {
    FlowValue value = any(0);
    skip_blanks();
    if (at_ < text_.size()) fail("nothing more");
    return value;
  }

 private:
  void skip_blanks() {
    while (at_ < text_.size() && std::isspace(static_cast<unsigned char>(text_[at_])) != 0) ++at_;
  }
  bool takes(char c) {
    skip_blanks();
    if (at_ == text_.size() || text_[at_] != c) return false;
    ++at_;
    return true;
  }
  [[noreturn]] void fail(const std::string& expected) const {
    throw UsageError("expected " + expected + " at character " + std::to_string(at_ + 1));
  }

  FlowValue any(int depth) {
    if (depth > kDeepest) fail("no deeper list or mapping");
    if (takes('[')) return {list(depth)};
    if (takes('{')) return {mapping(depth)};
    return {scalar()};
  }
  FlowValue::List list(int depth) {
    FlowValue::List values;
    while (!takes(']')) {
      values.push_back(any(depth + 1));
      if (takes(',')) continue;
      if (!takes(']')) fail("',' or ']'");
      break;
    }
    return values;
  }
  FlowValue::Mapping mapping(int depth) {
    FlowValue::Mapping entries;
    while (!takes('}')) {
      std::string key = scalar();
      if (key.ends_with(':')) {
        key.pop_back();
      } else if (!takes(':')) {
        fail("':'");
      }
      const bool known =
          std::any_of(entries.begin(), entries.end(), [&](const auto& entry) { return entry.name == key; });
      if (known) fail("no second '" + key + "'");
      entries.push_back({key, any(depth + 1)});
      if (takes(',')) continue;
      if (!takes('}')) fail("',' or '}'");
      break;
    }
    return entries;
  }
  std::string scalar() {
    skip_blanks();
    if (takes('"')) return quoted();
    const std::size_t begin = at_;
    while (at_ < text_.size() && is_plain(text_[at_])) ++at_;
    if (at_ == begin) fail("a value");
    return std::string(text_.substr(begin, at_ - begin));
  }
  std::string quoted() {
    std::string value;
    for (; at_ < text_.size() && text_[at_] != '"'; ++at_) {
      if (text_[at_] == '\\' && at_ + 1 < text_.size()) ++at_;
      value += text_[at_];
    }
    if (!takes('"')) fail("'\"'");
    return value;
  }

  std::string_view text_;
  std::size_t at_ = 0;
};

std::string scalar_text(const std::string& value) {
  const bool plain =
      !value.empty() && value.back() != ':' && std::all_of(value.begin(), value.end(), is_plain);
  if (plain) return value;
  std::string text = "\"";
  for (const char c : value) {
    if (c == '"' || c == '\\') text += '\\';
    text += c;
  }
  return text + '"';
}

std::string nested_text(const FlowValue& value) {
  if (const auto* scalar = std::get_if<std::string>(&value.content)) return scalar_text(*scalar);
  return flow_text(value);
}

}  // namespace

std::string FlowValue::description() const {
  if (const auto* scalar = std::get_if<std::string>(&content)) return "'" + *scalar + "'";
  return std::holds_alternative<List>(content) ? "a list" : "a mapping";
}

FlowValue parse_flow(std::string_view text) {
  if (!text.starts_with('[') && !text.starts_with('{')) return {std::string(text)};
  return FlowParser(text).whole();
}

std::string flow_text(const FlowValue& value) {
  if (const auto* scalar = std::get_if<std::string>(&value.content)) return *scalar;
  std::string text;
  if (const auto* list = std::get_if<FlowValue::List>(&value.content)) {
    for (const FlowValue& entry : *list) text += (text.empty() ? "" : ", ") + nested_text(entry);
    return "[" + text + "]";
  }
  for (const auto& [key, entry] : std::get<FlowValue::Mapping>(value.content))
    text += (text.empty() ? "" : ", ") + scalar_text(key) + ": " + nested_text(entry);
  return "{" + text + "}";
}

}  // namespace waymark
