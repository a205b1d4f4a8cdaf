#include <algorithm>
#include <charconv>
#include <cmath>

#include <waymark/core/base/error.hpp>
#include <waymark/core/base/suggest.hpp>
#include <waymark/core/registry/options.hpp>

namespace waymark {
namespace {

std::string prefix(std::string_view owner, const std::string& name) {
  return std::string(owner) + ": option '" + name + "' ";
}

const std::string& given_or_default(const Options& given, std::span<const OptionInfo> known,
                                    const std::string& name) {
  const auto found = given.find(name);
  if (found != given.end()) return found->second;
  const auto info =
      std::find_if(known.begin(), known.end(), [&](const OptionInfo& o) { return o.name == name; });
  if (info == known.end()) throw UsageError("option '" + name + "' is not declared");
  return info->value;
}

}  // namespace

std::string shortest(double value) {
  char buffer[32];
  return {buffer, std::to_chars(buffer, buffer + sizeof buffer, value).ptr};
}

bool has_option(std::span<const OptionInfo> known, std::string_view name) {
  return std::any_of(known.begin(), known.end(), [&](const OptionInfo& o) { return o.name == name; });
}

void check_option_names(std::string_view owner, const Options& given, std::span<const OptionInfo> known) {
  for (const auto& entry : given) {
    const std::string& name = entry.first;
    if (has_option(known, name)) continue;
    std::vector<std::string_view> names;
    for (const OptionInfo& option : known) names.push_back(option.name);
    std::string hint = did_you_mean(name, names);
    if (hint.empty()) hint = known.empty() ? "; it has none" : "; it has " + joined(names);
    throw UsageError(std::string(owner) + ": unknown option '" + name + "'" + hint);
  }
}

double number_option(std::string_view owner, const Options& given, std::span<const OptionInfo> known,
                     const std::string& name) {
  const std::string& text = given_or_default(given, known, name);
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) {
    throw UsageError(prefix(owner, name) + "must be a number, got '" + text + "'");
  }
  return value;
}

double number_option(std::string_view owner, const Options& given, std::span<const OptionInfo> known,
                     const std::string& name, double low, double high) {
  const double value = number_option(owner, given, known, name);
  if (value < low || value > high) {
    throw UsageError(prefix(owner, name) + "must lie in [" + shortest(low) + ", " + shortest(high) +
                     "], got " + shortest(value));
  }
  return value;
}

std::string word_option(std::string_view owner, const Options& given, std::span<const OptionInfo> known,
                        const std::string& name, std::span<const std::string_view> allowed) {
  const std::string& text = given_or_default(given, known, name);
  if (std::find(allowed.begin(), allowed.end(), text) != allowed.end()) return text;
  std::string message = prefix(owner, name) + "must be";
  for (std::size_t i = 0; i < allowed.size(); ++i)
    message += (i > 0 ? " or '" : " '") + std::string(allowed[i]) + "'";
  throw UsageError(message + ", got '" + text + "'");
}

}  // namespace waymark
