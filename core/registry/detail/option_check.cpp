#include <waymark/core/registry/detail/option_check.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <stdexcept>

#include <waymark/core/base/error.hpp>
#include <waymark/core/base/suggest.hpp>
#include <waymark/core/registry/detail/option_rules.hpp>
#include <waymark/core/registry/flow_text.hpp>

namespace waymark {
namespace {

std::optional<double> finite_number(const std::string& text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

/// Checks the values of one owner, and remembers where in them it is, for messages.
class OptionChecker {
 public:
  OptionChecker(const std::string& owner, const std::string& option, const std::string& value)
      : owner_(owner), option_(option), value_(value) {}

  OptionValue checked(const OptionInfo& info, const FlowValue& given, const std::string& path) const {
    const auto check = [&](const auto& allowed) { return of(allowed, given, path); };
    return std::visit(check, info.allowed);
  }

  [[noreturn]] void refuse(const std::string& path, const std::string& rule, const std::string& got) const {
    throw OptionError(owner_ + ": option '" + path + "' must " + rule + ", got " + got, owner_, option_,
                      value_);
  }

 private:
  const std::string& scalar(const FlowValue& given, const std::string& path, const std::string& rule) const {
    const auto* text = std::get_if<std::string>(&given.content);
    if (text == nullptr) refuse(path, rule, given.description());
    return *text;
  }
  OptionValue of(const OptionRange& range, const FlowValue& given, const std::string& path) const {
    const std::string& text = scalar(given, path, "be a number");
    const std::optional<double> number = finite_number(text);
    if (!number) refuse(path, "be a number", given.description());
    if (!range.contains(*number)) refuse(path, "lie in " + range.text(), text);
    return OptionValue(*number);
  }
  OptionValue of(const OptionWords& words, const FlowValue& given, const std::string& path) const {
    const std::string& text = scalar(given, path, "be " + quoted(words));
    if (std::find(words.begin(), words.end(), text) == words.end())
      refuse(path, "be " + quoted(words), given.description());
    return OptionValue(text);
  }
  OptionValue of(const OptionText&, const FlowValue& given, const std::string& path) const {
    return OptionValue(scalar(given, path, "be a text"));
  }
  OptionValue of(const OptionList& list, const FlowValue& given, const std::string& path) const {
    const auto* elements = std::get_if<FlowValue::List>(&given.content);
    if (elements == nullptr) refuse(path, "be a list", given.description());
    if (elements->size() < list.fewest || elements->size() > list.most)
      refuse(path, "have " + count_text(list) + " elements", std::to_string(elements->size()));
    OptionValue::List values;
    for (const FlowValue& element : *elements)
      values.push_back(
          checked(list.each.front(), element, path + "[" + std::to_string(values.size() + 1) + "]"));
    return OptionValue(std::move(values));
  }
  const FlowValue::Mapping& mapping_in(const FlowValue& given, const std::string& path) const {
    const auto* entries = std::get_if<FlowValue::Mapping>(&given.content);
    if (entries == nullptr) refuse(path, "be a mapping", given.description());
    return *entries;
  }
  OptionValue of(const OptionMapping& mapping, const FlowValue& given, const std::string& path) const {
    OptionValue::Entries values;
    for (const auto& [key, value] : mapping_in(given, path))
      values.emplace(key, checked(mapping.each.front(), value, path + "." + key));
    return OptionValue(std::move(values));
  }
  OptionValue of(const OptionRecord& record, const FlowValue& given, const std::string& path) const {
    const FlowValue::Mapping& entries = mapping_in(given, path);
    for (const auto& [key, value] : entries) {
      if (!has_option(record.fields, key))
        throw OptionError(owner_ + ": option '" + path + "': " + problem_with_name("key", key, record.fields),
                          owner_, option_, value_);
    }
    OptionValue::Entries values;
    for (const OptionInfo& field : record.fields) {
      const auto stated = std::find_if(entries.begin(), entries.end(),
                                       [&](const auto& entry) { return entry.name == field.name; });
      const std::string place = path + "." + field.name;
      if (stated == entries.end() && field.required) refuse(place, "be given", "nothing");
      values.emplace(
          field.name,
          checked(field, stated == entries.end() ? parse_flow(field.value) : stated->value, place));
    }
    return OptionValue(std::move(values));
  }

  const std::string& owner_;
  const std::string& option_;
  const std::string& value_;
};

}  // namespace

std::string problem_with_name(const char* what, const std::string& name, std::span<const OptionInfo> known) {
  std::vector<std::string_view> names;
  for (const OptionInfo& option : known) names.push_back(option.name);
  std::string hint = did_you_mean(name, names);
  if (hint.empty()) hint = known.empty() ? "; it has none" : "; it has " + joined(names);
  return std::string("unknown ") + what + " '" + name + "'" + hint;
}

bool has_structure(const OptionInfo& option) {
  return std::holds_alternative<OptionList>(option.allowed) ||
         std::holds_alternative<OptionMapping>(option.allowed) ||
         std::holds_alternative<OptionRecord>(option.allowed);
}

OptionValue checked_value(const std::string& owner, const OptionInfo& option, const std::string& value) {
  const OptionChecker checker(owner, option.name, value);
  FlowValue given{value};
  try {
    if (has_structure(option)) given = parse_flow(value);
  } catch (const UsageError& error) {
    checker.refuse(option.name, std::string("be written as ") + kind_text(option),
                   "'" + value + "': " + error.what());
  }
  return checker.checked(option, given, option.name);
}

OptionList list_of(OptionInfo each, std::size_t fewest, std::size_t most) {
  return {{std::move(each)}, fewest, most};
}

OptionMapping mapping_of(OptionInfo each) {
  return {{std::move(each)}};
}

const OptionValue& OptionValue::at(std::string_view key) const {
  const auto found = entries().find(key);
  if (found == entries().end()) throw std::logic_error("an option has no key '" + std::string(key) + "'");
  return found->second;
}

std::vector<double> OptionValue::numbers() const {
  std::vector<double> numbers;
  for (const OptionValue& element : list()) numbers.push_back(element.number());
  return numbers;
}

void OptionValue::wrong_kind(const char* kind) {
  throw std::logic_error(std::string("an option is read as ") + kind + ", which it is not declared to be");
}

void require_sound_priors(const std::string& owner, std::span<const OptionInfo> options) {
  for (const OptionInfo& option : options) {
    if (!option.prior) continue;
    const NoisePrior& prior = *option.prior;
    const auto require = [&](bool holds, const std::string& rule) {
      if (!holds) throw UsageError(owner + ": the prior of option '" + option.name + "' " + rule);
    };
    const auto* range = std::get_if<OptionRange>(&option.allowed);
    require(range != nullptr, "needs an option that is a number");
    require(range->contains(prior.mean), "has its mean outside " + range->text());
    require(prior.linear || prior.mean > 0, "is one of a logarithm and needs a mean above 0");
    require(prior.deviation > 0, "needs a deviation above 0");
    if (prior.where_option.empty()) continue;
    const auto where = std::find_if(options.begin(), options.end(), [&](const OptionInfo& other) {
      return other.name == prior.where_option;
    });
    require(where != options.end(), "names an option '" + prior.where_option + "' that is not there");
    const auto* words = std::get_if<OptionWords>(&where->allowed);
    require(words != nullptr && std::find(words->begin(), words->end(), prior.where_word) != words->end(),
            "names a word '" + prior.where_word + "' that option '" + prior.where_option + "' does not have");
  }
}

}  // namespace waymark
