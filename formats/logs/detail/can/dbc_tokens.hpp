/// Tokens of one line of a DBC file; private to its parser.
#pragma once

#include <charconv>
#include <cmath>
#include <cstddef>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>

#include <fmt/format.h>

#include <waymark/core/base/error.hpp>
#include <waymark/formats/text/detail/line_scanner.hpp>

namespace waymark::formats {

/// Tells whether a character may be part of the name of a message or signal.
[[nodiscard]] inline bool is_name_character(char c) {
  return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_';
}

/// Reads tokens of one line. An error names the place and the object.
class DbcTokens {
 public:
  DbcTokens(std::string_view line, std::size_t number, const std::string& path)
      : line_(line), number_(number), path_(path) {}

  void set_object(std::string object) { object_ = std::move(object); }
  /// Marks the next token as the place of errors from fail().
  void mark() {
    skip_blanks();
    mark_ = at_;
  }
  [[noreturn]] void fail(const std::string& what) const { fail_at(mark_, what); }
  /// Returns the text that fail() would throw.
  [[nodiscard]] std::string complaint(const std::string& what) const { return placed(mark_, what); }
  [[noreturn]] void fail_expected(std::string_view what) const {
    fail_at(at_, fmt::format("expected {}, got {}", what, quote_word(line_.substr(at_, 20))));
  }
  void skip_blanks() {
    while (at_ < line_.size() && (line_[at_] == ' ' || line_[at_] == '\t')) ++at_;
  }
  [[nodiscard]] bool accept(char c) {
    skip_blanks();
    if (at_ >= line_.size() || line_[at_] != c) return false;
    ++at_;
    return true;
  }
  void expect(char c) {
    if (!accept(c)) fail_expected(fmt::format("'{}'", c));
  }
  std::string name(std::string_view what) {
    skip_blanks();
    const std::size_t begin = at_;
    while (at_ < line_.size() && is_name_character(line_[at_])) ++at_;
    if (at_ == begin) fail_expected(what);
    if (at_ - begin > kLongestName)
      fail_at(begin,
              fmt::format("a name of {} characters: none has more than {}", at_ - begin, kLongestName));
    return std::string(line_.substr(begin, at_ - begin));
  }
  template <typename Number>
  Number number(std::string_view what) {
    skip_blanks();
    const std::size_t plus = at_ < line_.size() && line_[at_] == '+' ? 1 : 0;
    Number value = 0;
    const auto [end, error] = std::from_chars(line_.data() + at_ + plus, line_.data() + line_.size(), value);
    if (error != std::errc()) fail_expected(what);
    if constexpr (std::is_floating_point_v<Number>) {
      if (!std::isfinite(value)) fail_expected(what);
    }
    at_ = static_cast<std::size_t>(end - line_.data());
    return value;
  }
  std::string_view quoted(std::string_view what) {
    if (!accept('"')) fail_expected(what);
    const std::size_t end = line_.find('"', at_);
    if (end == std::string_view::npos) fail_at(at_ - 1, "the text's closing '\"' is missing");
    const std::string_view text = line_.substr(at_, end - at_);
    at_ = end + 1;
    return text;
  }

 private:
  static constexpr std::size_t kLongestName = 128;
  [[noreturn]] void fail_at(std::size_t place, const std::string& what) const {
    throw InputError(placed(place, what));
  }
  [[nodiscard]] std::string placed(std::size_t place, const std::string& what) const {
    return fmt::format("{}:{}:{}: {}: {}", path_, number_, place + 1, object_, what);
  }

  std::string_view line_;
  std::size_t number_;
  const std::string& path_;
  std::string object_ = "DBC";
  std::size_t at_ = 0;
  std::size_t mark_ = 0;
};

}  // namespace waymark::formats
