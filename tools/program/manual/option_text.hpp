/// What --help, the man pages and the completion say of an option: read off the parser once, for all of them.
///
/// The type name of an option is a small language of its own: alternatives between '|', a list with "[,...]"
/// behind them. `all` (small letters) is a word to be typed as it stands; DIR, FILE, LOG, GRAPH, DRIVE.yaml,
/// FILE.so (anything with a suffix) are files; SOLVER, MODELING, LOSS:SCALE and the like are names that the
/// registry has (completion.hpp); every other word in capitals is for people only.
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
  bool repeated = false;  ///< a positional that takes many
  std::vector<std::string> needs;
  std::vector<std::string> excludes;

  [[nodiscard]] bool positional() const { return names.empty(); }
};

/// Options and positionals of a command in their order, without the hidden ones.
[[nodiscard]] std::vector<OptionText> option_texts(const CLI::App& command);

/// "waymark run [OPTIONS] -o DIR DRIVE.yaml", in pieces: an option with its value is one.
[[nodiscard]] std::vector<std::string> usage_of(const CLI::App& command);

/// "waymark run", "waymark".
[[nodiscard]] std::string full_name(const CLI::App& command);

/// A command's description: its first line, and the paragraphs behind it.
[[nodiscard]] std::string summary_of(const CLI::App& command);
[[nodiscard]] std::string details_of(const CLI::App& command);

/// A command's footer: remarks before "Example:", and the lines behind it without their indentation.
[[nodiscard]] std::string remarks_of(const CLI::App& command);
[[nodiscard]] std::vector<std::string> examples_of(const CLI::App& command);

/// Text between separators.
[[nodiscard]] std::vector<std::string> split_text(std::string_view text, std::string_view separator);

/// Breaks lines at spaces so that none is longer; line breaks that are there stay.
[[nodiscard]] std::string wrap_text(const std::string& text, std::size_t width);

/// The program's help: sections as CLI11 has them, with our usage, values and lines that are not too long.
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
