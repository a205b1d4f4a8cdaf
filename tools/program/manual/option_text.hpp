/// The description of an option for --help, the man pages and the completion, read from the parser
/// once for all of them.
///
/// The type name of an option has its own small language: alternatives separated by '|', and
/// "[,...]" after them for a list. `all` (small letters) is a word that is typed as it is. DIR,
/// FILE, LOG, GRAPH, DRIVE.yaml, FILE.so (anything with a suffix) are files. SOLVER, MODELING,
/// LOSS:SCALE and the like are names in the registry (completion.hpp). Every other word in capitals
/// is only for people.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <CLI/CLI.hpp>

namespace waymark::program {

struct OptionText {
  std::vector<std::string> names;  ///< "-s", "--solver"; empty for a positional
  std::string value;               ///< "SOLVER|auto", "graph|g2o"; empty for a flag
  std::string initial;             ///< the default; empty: none
  std::string range;               ///< "1 to 256"; empty: none
  std::string description;
  std::string group;
  bool required = false;
  bool repeated = false;  ///< a positional that may be repeated
  std::vector<std::string> needs;
  std::vector<std::string> excludes;

  [[nodiscard]] bool positional() const { return names.empty(); }
};

/// Returns the options and positionals of a command in their order, without hidden ones.
[[nodiscard]] std::vector<OptionText> option_texts(const CLI::App& command);

/// Returns "waymark run [OPTIONS] -o DIR DRIVE.yaml" in pieces; an option with its value
/// is one piece.
[[nodiscard]] std::vector<std::string> usage_of(const CLI::App& command);

/// Returns "waymark run", "waymark".
[[nodiscard]] std::string full_name(const CLI::App& command);

/// Returns the description of a command: its first line, and the paragraphs after it.
[[nodiscard]] std::string summary_of(const CLI::App& command);
[[nodiscard]] std::string details_of(const CLI::App& command);

/// Returns the footer of a command: remarks before "Example:", and the lines after it without their
/// indentation.
[[nodiscard]] std::string remarks_of(const CLI::App& command);
[[nodiscard]] std::vector<std::string> examples_of(const CLI::App& command);

/// Splits text at separators.
[[nodiscard]] std::vector<std::string> split_text(std::string_view text, std::string_view separator);

/// Breaks lines at spaces, so that none is longer. Existing line breaks are kept.
[[nodiscard]] std::string wrap_text(const std::string& text, std::size_t width);

/// The help of the program: the sections of CLI11, with our usage and values, and with short lines.
class HelpFormatter final : public CLI::Formatter {
 public:
  HelpFormatter() { label("Positionals", "Arguments"); }
  std::string make_description(const CLI::App* command) const override;
  std::string make_group(std::string group, bool positional,
                         std::vector<const CLI::Option*> options) const override;
  std::string make_usage(const CLI::App* command, std::string name) const override;
  std::string make_subcommand(const CLI::App* command) const override;
  std::string make_footer(const CLI::App* command) const override;
  std::string make_option_name(const CLI::Option* option, bool positional) const override;
  std::string make_option_opts(const CLI::Option* option) const override;
  std::string make_option_desc(const CLI::Option* option) const override;
};

}  // namespace waymark::program
