#include <waymark/tools/drive/description/yaml_section.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <set>

#include <fmt/format.h>

#include <waymark/core/base/error.hpp>
#include <waymark/core/base/suggest.hpp>
#include <waymark/core/registry/flow_text.hpp>
#include <waymark/formats/text/detail/line_scanner.hpp>

namespace waymark::drive {
namespace {

// Beyond them squares and quotients soon are infinite or 0.
constexpr double kLeast = 1e-12;
constexpr double kMost = 1e12;

std::string place_at(const std::string& file, const YAML::Mark& mark) {
  if (mark.is_null()) return file + ": ";
  return fmt::format("{}:{}:{}: ", file, mark.line + 1, mark.column + 1);
}

std::string described(const YAML::Node& node) {
  constexpr std::size_t kLongest = 200;  // a log in place of a drive.yaml is one scalar
  if (node.IsScalar() && node.Scalar().size() > kLongest)
    return fmt::format("'{}'", formats::shown_name(node.Scalar()));
  if (node.IsScalar()) return fmt::format("'{}'", node.Scalar());
  if (node.IsSequence()) return fmt::format("a list of {}", node.size());
  if (node.IsMap()) return "a mapping";
  return "nothing";
}

/// @throws YAML::Exception for keys that are no scalars
FlowValue flow_of(const YAML::Node& node) {
  if (node.IsSequence()) {
    FlowValue::List list;
    for (const auto& entry : node) list.push_back(flow_of(entry));
    return {list};
  }
  if (node.IsMap()) {
    FlowValue::Mapping entries;
    for (const auto& entry : node) entries.push_back({entry.first.as<std::string>(), flow_of(entry.second)});
    return {entries};
  }
  return {node.IsScalar() ? node.Scalar() : std::string()};
}

std::optional<double> number_from(const YAML::Node& node) {
  if (!node.IsScalar()) return std::nullopt;
  std::string_view text = node.Scalar();
  if (text.starts_with('+')) text.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

}  // namespace

YamlSection::YamlSection(YAML::Node node, std::string name, std::string file)
    : node_(std::move(node)), name_(std::move(name)), file_(std::move(file)) {
  if (!node_.IsMap())
    throw InputError(fmt::format("{}{}: expected a mapping (key: value), got {}", place_of(node_),
                                 name_.empty() ? "the file" : name_, described(node_)));
  std::set<std::string> seen;
  for (const auto& entry : node_) {
    if (!entry.first.IsScalar()) throw InputError(place_of(entry.first) + "a key must be a word");
    if (!seen.insert(entry.first.Scalar()).second)
      throw InputError(fmt::format("{}key '{}' is given twice", place_of(entry.first), entry.first.Scalar()));
  }
}

YamlSection::YamlSection(YAML::Node node, std::string name, std::string file,
                         std::span<const std::string_view> keys)
    : YamlSection(std::move(node), std::move(name), std::move(file)) {
  for (const auto& entry : node_) {
    const std::string& key = entry.first.Scalar();
    if (std::find(keys.begin(), keys.end(), key) != keys.end()) continue;
    std::string hint = did_you_mean(key, keys);
    if (hint.empty()) hint = fmt::format("; known: {}", joined(keys));
    throw InputError(fmt::format("{}unknown key '{}'{}{}", place_of(entry.first), key,
                                 name_.empty() ? "" : fmt::format(" in {}", name_), hint));
  }
}

bool YamlSection::has(std::string_view key) const {
  return node(key).IsDefined();
}

YAML::Node YamlSection::node(std::string_view key) const {
  const YAML::Node& constant = node_;  // operator[] of a mutable node would create the key
  return constant[std::string(key)];
}

std::vector<std::string> YamlSection::keys() const {
  std::vector<std::string> result;
  for (const auto& entry : node_) result.push_back(entry.first.Scalar());
  return result;
}

void YamlSection::read(std::string_view key, std::string& value) const {
  if (!has(key)) return;
  if (!node(key).IsScalar() || node(key).Scalar().empty()) fail_value(key, "a word or text");
  value = node(key).Scalar();
}

void YamlSection::read(std::string_view key, bool& value) const {
  if (!has(key)) return;
  const std::string word = node(key).IsScalar() ? node(key).Scalar() : "";
  if (word != "true" && word != "false") fail_value(key, "true or false");
  value = word == "true";
}

void YamlSection::read(std::string_view key, double& value, const NumberRule& rule) const {
  if (!has(key)) return;
  const std::optional<double> number = number_from(node(key));
  if (!number || *number < rule.smallest || *number > rule.largest) fail_value(key, rule.words);
  if (*number != 0 && (std::abs(*number) < kLeast || std::abs(*number) > kMost))
    fail_value(key, "a number that something in the world may have (0, or 1e-12 to 1e12)");
  value = *number;
}

void YamlSection::read(std::string_view key, int& value, const NumberRule& rule) const {
  if (!has(key)) return;
  const std::optional<double> number = number_from(node(key));
  const bool whole = number && *number == std::floor(*number) && std::abs(*number) < 1e9;
  if (!whole || *number < rule.smallest || *number > rule.largest) fail_value(key, rule.words);
  value = static_cast<int>(*number);
}

void YamlSection::read(std::string_view key, std::optional<double>& value, const NumberRule& rule) const {
  if (!has(key)) return;
  double number = 0;
  read(key, number, rule);
  value = number;
}

void YamlSection::read(std::string_view key, Eigen::Vector2d& value) const {
  if (!has(key)) return;
  const YAML::Node list = node(key);
  if (!list.IsSequence() || list.size() != 2) fail_value(key, "two numbers [x, y]");
  const std::optional<double> x = number_from(list[0]);
  const std::optional<double> y = number_from(list[1]);
  if (!x || !y) fail_value(key, "two numbers [x, y]");
  value = Eigen::Vector2d(*x, *y);
}

void YamlSection::read(std::string_view key, std::vector<std::string>& values) const {
  if (!has(key)) return;
  const YAML::Node list = node(key);
  if (list.IsScalar()) {
    values.emplace_back();
    return read(key, values.back());
  }
  if (!list.IsSequence() || list.size() == 0) fail_value(key, "a text, or a list of texts");
  for (const YAML::Node& entry : list) {
    if (!entry.IsScalar() || entry.Scalar().empty()) fail_value(key, "a text, or a list of texts");
    values.push_back(entry.Scalar());
  }
}

void YamlSection::read_option(std::string_view key, std::string& value) const {
  if (!has(key)) return;
  if (node(key).IsScalar()) return read(key, value);
  if (!node(key).IsSequence() && !node(key).IsMap()) fail_value(key, "a value, a list or a mapping");
  value = flow_text(flow_of(node(key)));
}

std::optional<std::size_t> YamlSection::read_word(std::string_view key,
                                                  std::span<const std::string_view> words) const {
  if (!has(key)) return std::nullopt;
  const std::string word = node(key).IsScalar() ? node(key).Scalar() : "";
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (word == words[i]) return i;
  }
  fail_value(key, fmt::format("one of {}", joined(words)));
}

std::optional<YamlSection> YamlSection::section(std::string_view key,
                                                std::initializer_list<std::string_view> keys) const {
  if (!has(key)) return std::nullopt;
  return YamlSection(node(key), full_name(key), file_, keys);
}

std::optional<YamlSection> YamlSection::free_section(std::string_view key) const {
  if (!has(key)) return std::nullopt;
  return YamlSection(node(key), full_name(key), file_);
}

void YamlSection::fail_value(std::string_view key, std::string_view expected) const {
  fail(key, fmt::format("expected {}, got {}", expected, described(node(key))));
}

void YamlSection::fail(std::string_view key, const std::string& what) const {
  throw InputError(fmt::format("{}{}: {}", place(key), full_name(key), what));
}

std::string YamlSection::place_of(const YAML::Node& node) const {
  return place_at(file_, node.Mark());
}

std::string YamlSection::full_name(std::string_view key) const {
  return name_.empty() ? std::string(key) : fmt::format("{}.{}", name_, key);
}

}  // namespace waymark::drive
