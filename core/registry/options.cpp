#include <waymark/core/registry/options.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <stdexcept>

#include <waymark/core/base/suggest.hpp>

namespace waymark {
namespace {

/// Returns an exponent without its plus sign and zeros: "1e-06" becomes "1e-6".
std::string with_short_exponent(std::string number) {
  const std::size_t exponent = number.find('e');
  if (exponent == std::string::npos) return number;
  const std::size_t digits = exponent + 2;
  number.erase(digits, std::min(number.find_first_not_of('0', digits), number.size() - 1) - digits);
  if (number[exponent + 1] == '+') number.erase(exponent + 1, 1);
  return number;
}

/// Returns a bound as people write it: "1e4", "100", "0.1".
std::string bound(double value) {
  if (!std::isfinite(value)) return value < 0 ? "-inf" : "inf";
  char buffer[32];
  const auto end = std::to_chars(buffer, buffer + sizeof buffer, value, std::chars_format::scientific).ptr;
  const std::string plain = with_short_exponent(shortest(value));
  const std::string scientific = with_short_exponent({buffer, end});
  return scientific.size() < plain.size() ? scientific : plain;
}

/// Returns "'off' or 'constant'".
std::string quoted(const OptionWords& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "'" : " or '") + word + "'";
  return text;
}

std::string problem_with_name(const std::string& name, std::span<const OptionInfo> known) {
  std::vector<std::string_view> names;
  for (const OptionInfo& option : known) names.push_back(option.name);
  std::string hint = did_you_mean(name, names);
  if (hint.empty()) hint = known.empty() ? "; it has none" : "; it has " + joined(names);
  return "unknown option '" + name + "'" + hint;
}

std::optional<double> finite_number(const std::string& text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

template <typename Values>
const auto& declared(const Values& values, const std::string& owner, std::string_view name) {
  const auto found = values.find(name);
  if (found == values.end())
    throw std::logic_error(owner + ": option '" + std::string(name) +
                           "' is not declared with the type that is read");
  return found->second;
}

}  // namespace

bool OptionRange::contains(double value) const {
  return (low_open ? value > low : value >= low) && (high_open ? value < high : value <= high);
}

std::string OptionRange::text() const {
  std::string text(1, low_open || std::isinf(low) ? '(' : '[');
  text += bound(low);
  text += ", ";
  text += bound(high);
  text += high_open || std::isinf(high) ? ')' : ']';
  return text;
}

std::string OptionInfo::description() const {
  const auto* range = std::get_if<OptionRange>(&allowed);
  return range == nullptr ? text : text + "; in " + range->text();
}

OptionError::OptionError(const std::string& message, std::string owner, std::string option, std::string value)
    : UsageError(message), owner_(std::move(owner)), option_(std::move(option)), value_(std::move(value)) {}
OptionError::~OptionError() = default;

CheckedOptions::CheckedOptions(std::string_view owner, const Options& given,
                               std::span<const OptionInfo> known)
    : owner_(owner) {
  for (const auto& [name, value] : given) {
    if (!has_option(known, name))
      throw OptionError(owner_ + ": " + problem_with_name(name, known), owner_, name, value);
  }
  for (const OptionInfo& option : known) {
    const auto stated = given.find(option.name);
    add(option, stated == given.end() ? option.value : stated->second);
  }
}

void CheckedOptions::add(const OptionInfo& option, const std::string& value) {
  const auto refuse = [&](const std::string& rule, const std::string& got) {
    throw OptionError(owner_ + ": option '" + option.name + "' must " + rule + ", got " + got, owner_,
                      option.name, value);
  };
  if (const auto* words = std::get_if<OptionWords>(&option.allowed)) {
    if (std::find(words->begin(), words->end(), value) == words->end())
      refuse("be " + quoted(*words), "'" + value + "'");
    words_[option.name] = value;
    return;
  }
  const OptionRange& range = std::get<OptionRange>(option.allowed);
  const std::optional<double> number = finite_number(value);
  if (!number) refuse("be a number", "'" + value + "'");
  if (!range.contains(*number)) refuse("lie in " + range.text(), value);
  numbers_[option.name] = *number;
}

double CheckedOptions::number(std::string_view name) const {
  return declared(numbers_, owner_, name);
}

const std::string& CheckedOptions::word(std::string_view name) const {
  return declared(words_, owner_, name);
}

std::string shortest(double value) {
  char buffer[32];
  return {buffer, std::to_chars(buffer, buffer + sizeof buffer, value).ptr};
}

bool has_option(std::span<const OptionInfo> known, std::string_view name) {
  return std::any_of(known.begin(), known.end(), [&](const OptionInfo& o) { return o.name == name; });
}

}  // namespace waymark
