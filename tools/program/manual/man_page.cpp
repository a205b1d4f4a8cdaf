#include <waymark/tools/program/manual/man_page.hpp>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cstdlib>

#include <fmt/format.h>

#include <waymark/core/base/error.hpp>
#include <waymark/tools/program/command_line.hpp>
#include <waymark/tools/program/manual/option_text.hpp>
#include <waymark/version.hpp>

namespace waymark::program {
namespace {

/// Escapes text so that roff prints it unchanged. Quotes and hyphens can then be copied
/// into a shell.
std::string escaped(std::string_view text) {
  std::string roff;
  bool line_begins = true;
  for (const char c : text) {
    if (line_begins && c == '.') roff += "\\&";  // otherwise it would be a macro
    switch (c) {
      case '\\':
        roff += "\\e";
        break;
      case '-':
        roff += "\\-";
        break;
      case '\'':
        roff += "\\(aq";
        break;
      case '`':
        roff += "\\(ga";
        break;
      case '^':
        roff += "\\(ha";
        break;
      case '~':
        roff += "\\(ti";
        break;
      case '"':
        roff += "\\(dq";
        break;
      default:
        roff += c;
    }
    line_begins = c == '\n';
  }
  return roff;
}

std::string bold(const std::string& text) {
  return "\\fB" + escaped(text) + "\\fR";
}

/// Formats "SOLVER|auto": words to be typed are bold, placeholders are italic.
std::string value_text(const std::string& value) {
  std::string text;
  for (const std::string& alternative : split_text(value, "|")) {
    if (!text.empty()) text += "|";
    const bool literal =
        std::none_of(alternative.begin(), alternative.end(), [](char c) { return c >= 'A' && c <= 'Z'; });
    text += literal ? bold(alternative) : "\\fI" + escaped(alternative) + "\\fR";
  }
  return text;
}

/// Formats text for the macros: each sentence begins a line, and no line is long.
std::string prose(std::string text) {
  constexpr std::size_t kSourceWidth = 72;
  std::size_t end = 0;
  while ((end = text.find(". ", end)) != std::string::npos) text[++end] = '\n';
  return escaped(wrap_text(text, kSourceWidth));
}

std::string paragraphs(const std::string& text) {
  std::string roff;
  for (const std::string& paragraph : split_text(text, "\n\n")) {
    if (!roff.empty()) roff += ".PP\n";
    roff += prose(paragraph.substr(0, paragraph.find_last_not_of('\n') + 1)) + "\n";
  }
  return roff;
}

std::string entry(const std::string& term, const std::string& meaning) {
  return ".TP\n" + term + "\n" + meaning + "\n";
}

std::string synopsis(const CLI::App& command) {
  const std::vector<std::string> usage = usage_of(command);
  std::string text = bold(usage[0]);
  for (std::size_t i = 1; i < usage.size(); ++i) {
    text += " ";
    const auto space = usage[i].find(' ');
    if (space == std::string::npos) {
      text += value_text(usage[i]);
    } else {
      text += bold(usage[i].substr(0, space)) + "\\ " + value_text(usage[i].substr(space + 1));
    }
  }
  return text + "\n";
}

std::string option_entry(const OptionText& option) {
  std::string term;
  for (const std::string& name : option.names) term += (term.empty() ? "" : ", ") + bold(name);
  if (!option.value.empty()) term += (term.empty() ? "" : " ") + value_text(option.value);
  if (option.repeated) term += "...";
  std::string meaning = prose(option.description + ".");
  if (!option.range.empty()) meaning += "\nFrom " + escaped(option.range) + ".";
  if (option.required) meaning += "\nRequired.";
  if (!option.initial.empty()) meaning += "\nDefault: " + bold(option.initial) + ".";
  for (const std::string& other : option.needs) meaning += "\nOnly with " + bold(other) + ".";
  for (const std::string& other : option.excludes) meaning += "\nNot with " + bold(other) + ".";
  return entry(term, meaning);
}

std::string arguments_and_options(const CLI::App& command) {
  const std::vector<OptionText> options = option_texts(command);
  std::string text;
  for (const OptionText& option : options) {
    if (option.positional()) text += option_entry(option);
  }
  if (!text.empty()) text = ".SH ARGUMENTS\n" + text;
  text += ".SH OPTIONS\n";
  for (const std::string& group : command.get_groups()) {
    if (group.empty()) continue;
    if (group != "Options") text += ".SS " + escaped(group) + "\n";
    for (const OptionText& option : options) {
      if (option.group == group && !option.positional()) text += option_entry(option);
    }
  }
  return text;
}

std::vector<const CLI::App*> subcommands_of(const CLI::App& command) {
  return command.get_subcommands([](const CLI::App*) { return true; });
}

std::string subcommand_list(const CLI::App& command) {
  if (subcommands_of(command).empty()) return {};
  std::string text = ".SH SUBCOMMANDS\n";
  for (const CLI::App* sub : subcommands_of(command)) {
    text += entry(bold(page_name(*sub)) + "(1)", escaped(summary_of(*sub)) + ".");
  }
  return text;
}

std::string exit_status() {
  std::string text = ".SH EXIT STATUS\n";
  for (const auto& [code, meaning] : kExitCodeMeanings) text += entry(bold(std::to_string(code)), meaning);
  return text;
}

std::string surroundings(const char* heading, const std::vector<Surrounding>& things) {
  std::string text = fmt::format(".SH {}\n", heading);
  for (const Surrounding& thing : things) text += entry(bold(thing.name), prose(thing.meaning));
  return text;
}

std::string examples(const CLI::App& command) {
  std::string text = ".SH EXAMPLES\n.nf\n";
  for (const std::string& line : examples_of(command)) text += escaped(line) + "\n";
  return text + ".fi\n";
}

/// Returns the page of the program, and those of the subcommands that this text names. The
/// program's page names all.
std::string see_also(const CLI::App& command, const std::string& page) {
  const CLI::App* program = command.get_parent();
  std::string text = program == nullptr ? "" : "\\fBwaymark\\fR(1)";
  for (const CLI::App* other : subcommands_of(program == nullptr ? command : *program)) {
    const bool named = page.find("waymark " + other->get_name()) != std::string::npos;
    if (other == &command || (program != nullptr && !named)) continue;
    text += (text.empty() ? "" : ",\n") + bold(page_name(*other)) + "(1)";
  }
  return ".SH SEE ALSO\n" + text + "\n";
}

}  // namespace

std::string page_name(const CLI::App& command) {
  return command.get_parent() == nullptr ? "waymark" : "waymark-" + command.get_name();
}

std::string man_page(const CLI::App& command, const std::string& date) {
  std::string title = escaped(page_name(command));
  std::transform(title.begin(), title.end(), title.begin(),
                 [](char c) { return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c; });
  std::string summary = summary_of(command);
  if (summary.starts_with("Waymark: ")) summary.erase(0, 9);
  if (summary.ends_with('.')) summary.pop_back();
  std::string page =
      fmt::format(".TH {} 1 \"{}\" \"waymark {}\" \"Waymark manual\"\n", title, date, WAYMARK_VERSION);
  page += ".nh\n.ad l\n";  // names such as WAYMARK_PLUGIN_PATH must not be hyphenated
  page += ".SH NAME\n" + escaped(page_name(command)) + " \\- " + escaped(summary) + "\n";
  page += ".SH SYNOPSIS\n" + synopsis(command);
  const std::string details = details_of(command);
  page += ".SH DESCRIPTION\n" + paragraphs(details.empty() ? summary + "." : details);
  page += subcommand_list(command);
  page += arguments_and_options(command);
  const std::string remarks = command.get_parent() == nullptr ? "" : remarks_of(command);
  if (!remarks.empty()) page += ".SH NOTES\n" + paragraphs(remarks);
  page += exit_status();
  page += surroundings("ENVIRONMENT", environment_variables());
  page += surroundings("FILES", known_files());
  page += examples(command);
  return page + see_also(command, page);
}

std::string source_date() {
  const char* variable = std::getenv("SOURCE_DATE_EPOCH");
  if (variable == nullptr || *variable == 0) return {};
  const std::string_view text = variable;
  std::int64_t seconds = 0;
  const auto [stopped, error] = std::from_chars(text.data(), text.data() + text.size(), seconds);
  constexpr std::int64_t kYear10000 = 253402300800;
  if (error != std::errc() || stopped != text.data() + text.size() || seconds < 0 || seconds >= kYear10000) {
    throw UsageError("SOURCE_DATE_EPOCH: expected seconds since 1970, got '" + std::string(text) + "'");
  }
  const std::chrono::year_month_day day(
      std::chrono::floor<std::chrono::days>(std::chrono::sys_seconds(std::chrono::seconds(seconds))));
  return fmt::format("{:04}-{:02}-{:02}", static_cast<int>(day.year()), static_cast<unsigned>(day.month()),
                     static_cast<unsigned>(day.day()));
}

}  // namespace waymark::program
