#include <waymark/core/registry/detail/option_rules.hpp>

#include <charconv>
#include <cmath>

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

/// Returns "{x: number m, z: number m, default 0}".
std::string fields_text(const OptionRecord& record) {
  std::string text;
  for (const OptionInfo& field : record.fields)
    text += (text.empty() ? "" : ", ") + field.name + ": " + kind_text(field) +
            (field.required ? "" : ", default " + field.value);
  return "{" + text + "}";
}

}  // namespace

std::string OptionRange::text() const {
  std::string text(1, low_open || std::isinf(low) ? '(' : '[');
  text += bound(low);
  text += ", ";
  text += bound(high);
  text += high_open || std::isinf(high) ? ')' : ']';
  return text;
}

std::string quoted(const OptionWords& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "'" : " or '") + word + "'";
  return text;
}

std::string count_text(const OptionList& list) {
  std::string text = std::to_string(list.fewest);
  if (list.most == std::numeric_limits<std::size_t>::max()) return text + " or more";
  return list.most == list.fewest ? text : text + " to " + std::to_string(list.most);
}

std::string kind_text(const OptionInfo& option) {
  const std::string unit = option.unit.empty() ? std::string() : " " + option.unit;
  if (const auto* range = std::get_if<OptionRange>(&option.allowed))
    return "number" + unit +
           (std::isinf(range->low) && std::isinf(range->high) ? "" : " in " + range->text());
  if (const auto* words = std::get_if<OptionWords>(&option.allowed)) return quoted(*words);
  if (const auto* text = std::get_if<OptionText>(&option.allowed)) return text->is_file ? "file" : "text";
  return allowed_text(option);
}

std::string allowed_text(const OptionInfo& option) {
  if (const auto* text = std::get_if<OptionText>(&option.allowed)) return text->is_file ? "a file" : "";
  if (const auto* range = std::get_if<OptionRange>(&option.allowed)) return "in " + range->text();
  if (const auto* list = std::get_if<OptionList>(&option.allowed)) {
    const bool any = list->fewest == 0 && list->most == std::numeric_limits<std::size_t>::max();
    return "list of " + (any ? std::string() : count_text(*list) + ": ") + kind_text(list->each.front());
  }
  if (const auto* mapping = std::get_if<OptionMapping>(&option.allowed))
    return "mapping of names to " + kind_text(mapping->each.front());
  if (const auto* record = std::get_if<OptionRecord>(&option.allowed)) return fields_text(*record);
  return "";
}

}  // namespace waymark
