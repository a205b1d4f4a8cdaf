#include <waymark/core/registry/options.hpp>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <stdexcept>

#include <waymark/core/registry/detail/option_check.hpp>
#include <waymark/core/registry/detail/option_rules.hpp>
#include <waymark/core/registry/flow_text.hpp>

namespace waymark {
namespace {

/// Puts the files in a value below a folder.
void place_files(const std::string& folder, const OptionInfo& option, FlowValue& value) {
  if (const auto* text = std::get_if<OptionText>(&option.allowed)) {
    auto* file = std::get_if<std::string>(&value.content);
    if (text->is_file && file != nullptr && !file->empty())
      *file = (std::filesystem::path(folder) / *file).lexically_normal().string();
    return;
  }
  if (const auto* list = std::get_if<OptionList>(&option.allowed)) {
    if (auto* elements = std::get_if<FlowValue::List>(&value.content))
      for (FlowValue& element : *elements) place_files(folder, list->each.front(), element);
    return;
  }
  auto* entries = std::get_if<FlowValue::Mapping>(&value.content);
  if (entries == nullptr) return;
  const auto* mapping = std::get_if<OptionMapping>(&option.allowed);
  const auto* record = std::get_if<OptionRecord>(&option.allowed);
  for (auto& [key, entry] : *entries) {
    if (mapping != nullptr) place_files(folder, mapping->each.front(), entry);
    if (record == nullptr) continue;
    for (const OptionInfo& field : record->fields)
      if (field.name == key) place_files(folder, field, entry);
  }
}

}  // namespace

bool OptionRange::contains(double value) const {
  return (low_open ? value > low : value >= low) && (high_open ? value < high : value <= high);
}

std::string OptionInfo::description() const {
  const std::string rule = allowed_text(*this);
  return rule.empty() ? text : text + "; " + rule;
}

OptionError::OptionError(const std::string& message, std::string owner, std::string option, std::string value)
    : UsageError(message), owner_(std::move(owner)), option_(std::move(option)), value_(std::move(value)) {}
OptionError::~OptionError() = default;

CheckedOptions::CheckedOptions(std::string_view owner, const Options& given,
                               std::span<const OptionInfo> known)
    : owner_(owner) {
  for (const auto& [name, value] : given) {
    if (!has_option(known, name))
      throw OptionError(owner_ + ": " + problem_with_name("option", name, known), owner_, name, value);
  }
  for (const OptionInfo& option : known) {
    const auto stated = given.find(option.name);
    if (stated == given.end() && option.required)
      throw OptionError(owner_ + ": option '" + option.name + "' must be given: " + option.description(),
                        owner_, option.name, "");
    values_.emplace(option.name,
                    checked_value(owner_, option, stated == given.end() ? option.value : stated->second));
  }
}

double CheckedOptions::number(std::string_view name) const {
  return value(name).number();
}

const std::string& CheckedOptions::word(std::string_view name) const {
  return value(name).text();
}

const OptionValue& CheckedOptions::value(std::string_view name) const {
  const auto found = values_.find(name);
  if (found == values_.end())
    throw std::logic_error(owner_ + ": option '" + std::string(name) +
                           "' is not declared with the type that is read");
  return found->second;
}

Options with_files_below(const std::string& folder, Options options, std::span<const OptionInfo> known) {
  for (const OptionInfo& option : known) {
    const auto stated = options.find(option.name);
    if (stated == options.end()) continue;
    try {
      FlowValue value = has_structure(option) ? parse_flow(stated->second) : FlowValue{stated->second};
      place_files(folder, option, value);
      stated->second = flow_text(value);
    } catch (const UsageError&) {
      continue;  // refused with its place when it is checked
    }
  }
  return options;
}

std::string shortest(double value) {
  char buffer[32];
  return {buffer, std::to_chars(buffer, buffer + sizeof buffer, value).ptr};
}

bool has_option(std::span<const OptionInfo> known, std::string_view name) {
  return std::any_of(known.begin(), known.end(), [&](const OptionInfo& o) { return o.name == name; });
}

}  // namespace waymark
