#include <waymark/tools/program/command_line.hpp>

#include <waymark/core/base/error.hpp>
#include <waymark/core/base/suggest.hpp>
#include <waymark/tools/program/manual/option_text.hpp>
#include <waymark/version.hpp>

namespace waymark::program {
namespace {

constexpr const char* kDescription =
    "Waymark: fuses odometry with GNSS, optimises pose graphs\n\n"
    "A drive.yaml names the logs of a drive. 'waymark init' writes one for given logs. 'waymark "
    "run' does the whole job: it reads the logs, builds a pose graph, finds its minimum and "
    "compares the result with truth. Each step is also a subcommand. Graphs of other "
    "programs are read and written.";

/// Returns the exit codes as a sentence, and an example.
std::string footer() {
  std::string codes = "Exit codes:";
  for (const auto& [code, meaning] : kExitCodeMeanings) {
    if (code != kSuccess) codes += ",";
    codes += " " + std::to_string(code) + " " + meaning;
  }
  return codes +
         ".\n"
         "'waymark help SUBCOMMAND' explains a subcommand; 'waymark doctor' shows how "
         "the program was built.\n"
         "Example:\n  waymark run drive.yaml --out results --modeling all";
}

}  // namespace

void build_command_line(CLI::App& app, Action& action) {
  app.name("waymark");
  app.description(kDescription);
  app.formatter(std::make_shared<HelpFormatter>());
  app.require_subcommand(1);
  app.set_version_flag("--version", "waymark " WAYMARK_VERSION);
  app.footer(footer());
  add_inspect(app, action);
  add_init(app, action);
  add_sync(app, action);
  add_convert(app, action);
  add_optimize(app, action);
  add_evaluate(app, action);
  add_run(app, action);
  add_view(app, action);
  add_live(app, action);
  add_fleet(app, action);
  add_compare(app, action);
  add_bench(app, action);
  add_info(app, action);
  add_check(app, action);
  add_simulate(app, action);
  add_reproduce(app, action);
  add_doctor(app, action);
  add_help(app, action);
  add_completion(app, action);
}

const CLI::App& find_command(const CLI::App& app, const std::string& name) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) {
    if (command->get_name() == name) return *command;
    names.push_back(command->get_name());
  }
  const std::vector<std::string_view> views(names.begin(), names.end());
  throw UsageError("unknown subcommand '" + name + "'" + suggestion(name, views));
}

std::vector<Surrounding> environment_variables() {
  return {
      {"WAYMARK_PLUGIN_PATH",
       "Folders of plugins, separated by ':'. Their modules are loaded, and --plugin NAME is looked up in "
       "them."},
      {"NO_COLOR", "Any value turns colours off. Output that is not a terminal has no colours."}};
}

std::vector<Surrounding> known_files() {
  return {{"drive.yaml", "Describes a drive: its logs, their columns and units, the vehicle, the settings."},
          {"*.graph", "A graph as text, known by its first line, 'GRAPH 1'."},
          {WAYMARK_PLUGIN_FOLDER "/*.so", "Installed plugins. They are loaded by every subcommand."}};
}

}  // namespace waymark::program
