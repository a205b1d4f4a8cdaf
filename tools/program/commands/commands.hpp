/// The subcommands. Each adds itself to the parser. Its action runs after parsing and returns
/// the exit code.
#pragma once

#include <functional>

#include <CLI/CLI.hpp>

#include <waymark/tools/program/terminal/console.hpp>
#include <waymark/tools/program/terminal/exit_codes.hpp>

namespace waymark::program {

/// The work of the chosen subcommand.
using Action = std::function<ExitCode()>;

void add_convert(CLI::App& app, Action& action);
void add_optimize(CLI::App& app, Action& action);
void add_evaluate(CLI::App& app, Action& action);
void add_compare(CLI::App& app, Action& action);
void add_bench(CLI::App& app, Action& action);
void add_run(CLI::App& app, Action& action);
void add_view(CLI::App& app, Action& action);
void add_live(CLI::App& app, Action& action);
void add_fleet(CLI::App& app, Action& action);
void add_sync(CLI::App& app, Action& action);
void add_info(CLI::App& app, Action& action);
void add_check(CLI::App& app, Action& action);
void add_simulate(CLI::App& app, Action& action);
void add_inspect(CLI::App& app, Action& action);
void add_init(CLI::App& app, Action& action);
void add_reproduce(CLI::App& app, Action& action);
void add_doctor(CLI::App& app, Action& action);
void add_help(CLI::App& app, Action& action);
void add_completion(CLI::App& app, Action& action);

/// Options that are added while this object lives appear under this heading in the help.
class OptionHeading {
 public:
  OptionHeading(CLI::App& command, const std::string& heading)
      : command_(command), before_(command.option_defaults()->get_group()) {
    command_.option_defaults()->group(heading);
  }
  ~OptionHeading() { command_.option_defaults()->group(before_); }
  OptionHeading(const OptionHeading&) = delete;
  OptionHeading& operator=(const OptionHeading&) = delete;

 private:
  CLI::App& command_;
  std::string before_;
};

/// Adds --quiet, -v, --json and --plugin.
void add_common_options(CLI::App& command, CommonOptions& options);
/// Adds only --plugin.
void add_plugin_option(CLI::App& command, CommonOptions& options);

}  // namespace waymark::program
