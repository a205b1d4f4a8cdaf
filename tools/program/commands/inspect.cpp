#include <memory>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include <waymark/tools/inspection/inspection.hpp>
#include <waymark/tools/program/commands/commands.hpp>
#include <waymark/tools/program/jobs/log_inspection.hpp>
#include <waymark/tools/program/jobs/program_registry.hpp>
#include <waymark/tools/program/terminal/output.hpp>

namespace waymark::program {
namespace {

ExitCode inspect(const InspectCommand& command) {
  const Console console(command.common);
  const std::vector<inspection::LogInspection> logs = inspect_files(command, console);
  if (command.common.json) {
    nlohmann::ordered_json json = nlohmann::ordered_json::array();
    for (const inspection::LogInspection& log : logs) json.push_back(inspection::inspection_json(log));
    console.result(json_document("inspect", {{"logs", json}}), is_stdout(command.output));
  } else {
    std::string text;
    for (const inspection::LogInspection& log : logs)
      text += (text.empty() ? "" : "\n") +
              inspection::inspection_text(log, console.look(is_stdout(command.output)));
    console.result(text, is_stdout(command.output));
  }
  if (!command.output.empty()) write_proposal(command, logs, console);
  return kSuccess;
}

}  // namespace

void add_inspect(CLI::App& app, Action& action) {
  auto* command = app.add_subcommand(
      "inspect",
      "What is in raw logs: streams, rates, gaps, what looks wrong\n\n"
      "Formats are known by their content. With -o a drive.yaml is written as well, as 'waymark init' does.");
  const auto options = std::make_shared<InspectCommand>();
  command->add_option("logs", options->logs, "Logs, and the DBC of CAN logs")->required()->type_name("LOG");
  add_inspection_options(*command, *options);
  command->footer("Example:\n  waymark inspect candump.log.gz --dbc car.dbc -o drive.yaml");
  command->callback([options, &action] { action = [options] { return inspect(*options); }; });
}

}  // namespace waymark::program
