#include <waymark/tools/program/manual/usage_hints.hpp>

#include <algorithm>

#include <waymark/core/base/suggest.hpp>

namespace waymark::program {
namespace {

const CLI::Option* find_option(const CLI::App& command, const std::string& name) {
  return command.get_option_no_throw(name);
}

const CLI::App* command_or_null(const CLI::App& app, const std::string& name) {
  for (const CLI::App* command : app.get_subcommands(nullptr)) {
    if (command->get_name() == name) return command;
  }
  return nullptr;
}

/// Returns "--out" for "--out=folder", and "-m" for "-mg2".
std::string name_of(const std::string& word) {
  return word.starts_with("--") ? word.substr(0, word.find('=')) : word.substr(0, 2);
}

bool looks_like_option(const std::string& word) {
  if (word.size() < 2 || word[0] != '-') return false;
  const bool number = word[1] == '.' || (word[1] >= '0' && word[1] <= '9');
  return !number;
}

/// Tells whether the next word is the value of this one, whatever it looks like.
bool takes_next_word(const CLI::Option* option, const std::string& word) {
  const bool has_value = word.size() > name_of(word).size();
  return option != nullptr && option->get_expected_min() > 0 && option->get_items_expected_max() > 0 &&
         !has_value;
}

std::vector<std::string> long_names(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::Option* option : command.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  }
  return names;
}

std::string owners_of(const CLI::App& app, const std::string& name) {
  std::vector<std::string> owners;
  for (const CLI::App* command : app.get_subcommands(nullptr)) {
    if (find_option(*command, name) != nullptr) owners.push_back(command->get_name());
  }
  return joined(owners);
}

std::string explain(const CLI::App& app, const CLI::App& command, const std::string& name) {
  const std::string message = "unknown option '" + name + "'";
  const std::string owners = owners_of(app, name);
  if (!owners.empty()) return message + "; " + name + " belongs to: " + owners;
  const std::vector<std::string> known = long_names(command);
  const std::vector<std::string_view> views(known.begin(), known.end());
  const std::string nearest = name.starts_with("--") ? did_you_mean(name, views) : "";
  if (!nearest.empty()) return message + nearest;
  return message + "; 'waymark " + command.get_name() + " --help' lists all options";
}

}  // namespace

std::string unknown_option(const CLI::App& app, const std::vector<std::string>& words) {
  const CLI::App* command = words.empty() ? nullptr : command_or_null(app, words.front());
  if (command == nullptr) return "";
  for (std::size_t i = 1; i < words.size() && words[i] != "--"; ++i) {
    if (!looks_like_option(words[i])) continue;
    const std::string name = name_of(words[i]);
    const CLI::Option* option = find_option(*command, name);
    if (option == nullptr) return explain(app, *command, name);
    if (takes_next_word(option, words[i])) ++i;
  }
  return "";
}

std::string only_file(const CLI::App& app, const std::vector<std::string>& words) {
  const CLI::App* command = words.empty() ? nullptr : command_or_null(app, words.front());
  if (command == nullptr) return "";
  std::string file;
  for (std::size_t i = 1; i < words.size(); ++i) {
    if (!looks_like_option(words[i])) {
      if (!file.empty()) return "";
      file = words[i];
      continue;
    }
    const std::string name = name_of(words[i]);
    const CLI::Option* option = find_option(*command, name);
    if (option == nullptr || name == "--input-format" || name == "--help" || name == "-h") return "";
    if (takes_next_word(option, words[i])) ++i;
  }
  return file;
}

CLI::Validator one_of(const std::string& kind, const std::vector<std::string>& words) {
  return CLI::Validator(
      [kind, words](const std::string& word) {
        if (std::find(words.begin(), words.end(), word) != words.end()) return std::string();
        const std::vector<std::string_view> views(words.begin(), words.end());
        return "unknown " + kind + " '" + word + "'" + suggestion(word, views);
      },
      "{" + CLI::detail::join(words, ",") + "}");
}

}  // namespace waymark::program
