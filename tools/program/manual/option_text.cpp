#include <waymark/tools/program/manual/option_text.hpp>

#include <algorithm>

namespace waymark::program {
namespace {

constexpr std::size_t kHelpWidth = 100;
constexpr std::size_t kHelpColumn = 30;
constexpr std::string_view kExampleHeading = "Example:\n";

/// Splits the value from the range of a number: CLI11 writes "TEXT:{a,b}" and "INT:INT in [1 - 9]".
void split_type(const std::string& type, OptionText& text) {
  const auto choices = type.find(":{");
  const auto range = type.find(" in [");
  if (choices != std::string::npos) {
    text.value = type.substr(choices + 2, type.size() - choices - 3);
    std::replace(text.value.begin(), text.value.end(), ',', '|');
  } else if (range != std::string::npos) {
    text.value = type.substr(0, type.find(':'));
    text.range = type.substr(range + 5, type.find(']', range) - range - 5);
    const auto dash = text.range.find(" - ");
    if (dash != std::string::npos) text.range.replace(dash, 3, " to ");
  } else {
    text.value = type;
  }
  if (text.value == "INT" || text.value == "UINT") text.value = "N";
  if (text.value == "FLOAT") text.value = "NUMBER";
}

std::string name_of(const CLI::Option& option) {
  return option.nonpositional() ? option.get_name() : option.get_type_name();
}

OptionText describe(const CLI::Option& option) {
  OptionText text;
  for (const std::string& name : option.get_snames()) text.names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) text.names.push_back("--" + name);
  if (option.get_type_size() != 0) split_type(option.get_type_name(), text);
  if (text.positional() && text.value == "TEXT") text.value = option.get_name(true, false);
  text.initial = option.get_default_str();
  text.description = option.get_description();
  text.group = option.get_group();
  text.required = option.get_required();
  text.repeated = text.positional() && option.get_expected_max() >= CLI::detail::expected_max_vector_size;
  for (const CLI::Option* other : option.get_needs()) text.needs.push_back(name_of(*other));
  for (const CLI::Option* other : option.get_excludes())
    if (!other->get_group().empty()) text.excludes.push_back(name_of(*other));  // the others are hidden
  std::sort(text.needs.begin(), text.needs.end());  // the parser orders them by address
  std::sort(text.excludes.begin(), text.excludes.end());
  return text;
}

std::string positional_usage(const OptionText& text) {
  const std::string name = text.value + (text.repeated ? "..." : "");
  return text.required ? name : "[" + name + "]";
}

}  // namespace

std::vector<OptionText> option_texts(const CLI::App& command) {
  std::vector<OptionText> texts;
  for (const CLI::Option* option : command.get_options()) {
    if (!option->get_group().empty()) texts.push_back(describe(*option));
  }
  return texts;
}

std::vector<std::string> usage_of(const CLI::App& command) {
  std::vector<std::string> usage = {full_name(command), "[OPTIONS]"};
  const std::vector<OptionText> options = option_texts(command);
  for (const OptionText& option : options) {
    if (!option.positional() && option.required) usage.push_back(option.names[0] + " " + option.value);
  }
  for (const OptionText& option : options) {
    if (option.positional()) usage.push_back(positional_usage(option));
  }
  if (!command.get_subcommands([](const CLI::App*) { return true; }).empty())
    usage.emplace_back("SUBCOMMAND");
  return usage;
}

std::string full_name(const CLI::App& command) {
  return command.get_parent() == nullptr ? "waymark" : "waymark " + command.get_name();
}

std::string summary_of(const CLI::App& command) {
  return split_text(command.get_description(), "\n").front();
}

std::string details_of(const CLI::App& command) {
  const std::string text = command.get_description();
  const auto gap = text.find("\n\n");
  return gap == std::string::npos ? "" : text.substr(gap + 2);
}

std::string remarks_of(const CLI::App& command) {
  const std::string footer = command.get_footer();
  return footer.substr(0, footer.find(kExampleHeading));
}

std::vector<std::string> examples_of(const CLI::App& command) {
  const std::string footer = command.get_footer();
  const auto heading = footer.find(kExampleHeading);
  if (heading == std::string::npos) return {};
  std::vector<std::string> lines = split_text(footer.substr(heading + kExampleHeading.size()), "\n");
  for (std::string& line : lines) line.erase(0, line.find_first_not_of(' '));
  return lines;
}

std::vector<std::string> split_text(std::string_view text, std::string_view separator) {
  std::vector<std::string> parts;
  while (true) {
    const auto end = text.find(separator);
    parts.emplace_back(text.substr(0, end));
    if (end == std::string_view::npos) return parts;
    text.remove_prefix(end + separator.size());
  }
}

std::string wrap_text(const std::string& text, std::size_t width) {
  std::string wrapped;
  for (const std::string& line : split_text(text, "\n")) {
    if (!wrapped.empty()) wrapped += '\n';
    std::size_t length = 0;
    for (const std::string& word : split_text(line, " ")) {
      if (length > 0 && length + 1 + word.size() > width) {
        wrapped += '\n';
        length = 0;
      } else if (length > 0) {
        wrapped += ' ';
        ++length;
      }
      wrapped += word;
      length += word.size();
    }
  }
  return wrapped;
}

std::string HelpFormatter::make_description(const CLI::App* command) const {
  const std::string details = details_of(*command);
  return summary_of(*command) + "\n" +
         (details.empty() ? "" : "\n" + wrap_text(details, kHelpWidth) + "\n\n");
}

std::string HelpFormatter::make_group(std::string group, bool positional,
                                      std::vector<const CLI::Option*> options) const {
  // The caller adds its own empty line between two groups of options.
  const std::string text = CLI::Formatter::make_group(group, positional, std::move(options));
  return positional || group == "Options" ? text : text.substr(1);
}

std::string HelpFormatter::make_usage(const CLI::App* command, std::string) const {
  std::string usage = "Usage:";
  for (const std::string& piece : usage_of(*command)) usage += " " + piece;
  return usage + "\n";
}

std::string HelpFormatter::make_subcommand(const CLI::App* command) const {
  std::ostringstream out;
  CLI::detail::format_help(out, command->get_name(), summary_of(*command), kHelpColumn);
  return out.str();
}

std::string HelpFormatter::make_footer(const CLI::App* command) const {
  const std::string examples = command->get_footer().substr(remarks_of(*command).size());
  return wrap_text(remarks_of(*command), kHelpWidth) + examples + "\n";
}

std::string HelpFormatter::make_option_name(const CLI::Option* option, bool positional) const {
  const OptionText text = describe(*option);
  return positional ? text.value : CLI::detail::join(text.names, ",");
}

std::string HelpFormatter::make_option_opts(const CLI::Option* option) const {
  const OptionText text = describe(*option);
  std::string more = text.positional() || text.value.empty() ? "" : " " + text.value;
  if (text.repeated) more += "...";
  if (text.required) more += " (required)";
  return more;
}

std::string HelpFormatter::make_option_desc(const CLI::Option* option) const {
  const OptionText text = describe(*option);
  std::string words = text.description;
  if (!text.range.empty()) words += " (" + text.range + ")";
  if (!text.initial.empty()) words += " [" + text.initial + "]";
  if (!text.needs.empty()) words += " (with " + CLI::detail::join(text.needs, ", ") + ")";
  if (!text.excludes.empty()) words += " (not with " + CLI::detail::join(text.excludes, ", ") + ")";
  return wrap_text(words, kHelpWidth - kHelpColumn);
}

}  // namespace waymark::program
