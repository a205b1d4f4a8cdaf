#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include <waymark/core/base/error.hpp>
#include <waymark/tools/drive/description/drive_file.hpp>
#include <waymark/tools/inspection/inspection.hpp>
#include <waymark/tools/program/commands/commands.hpp>
#include <waymark/tools/program/jobs/inspection/drive_statistics.hpp>
#include <waymark/tools/program/jobs/inspection/log_inspection.hpp>
#include <waymark/tools/program/jobs/program_registry.hpp>
#include <waymark/tools/program/terminal/output.hpp>

namespace waymark::program {
namespace {

/// Inspects a drive.yaml, which names its logs and how they are read.
ExitCode inspect_drive(const InspectCommand& command, const std::string& path, const Console& console) {
  if (command.format != "auto" || !command.dbc.empty())
    throw UsageError("--format and --dbc belong to logs, not to a drive.yaml");
  print_drive_statistics(path, command.common, console);
  return kSuccess;
}

ExitCode inspect(const InspectCommand& command) {
  const Console console(command.common);
  if (command.logs.size() == 1 && drive::is_drive_file(command.logs.front()))
    return inspect_drive(command, command.logs.front(), console);
  const std::vector<inspection::LogInspection> logs = inspect_files(command, console);
  if (command.common.json) {
    nlohmann::ordered_json json = nlohmann::ordered_json::array();
    for (const inspection::LogInspection& log : logs) json.push_back(inspection::inspection_json(log));
    console.result(json_document("inspect", {{"logs", json}}));
  } else {
    std::string text;
    for (const inspection::LogInspection& log : logs)
      text += (text.empty() ? "" : "\n") + inspection::inspection_text(log, console.look());
    console.result(text);
  }
  return kSuccess;
}

}  // namespace

void add_inspect(CLI::App& app, Action& action) {
  auto* command = app.add_subcommand(
      "inspect",
      "Show streams, rates, gaps and suspicious values of raw logs\n\n"
      "Formats are recognised by their content. 'waymark init' writes a drive.yaml for such logs. "
      "For a drive.yaml it prints statistics of the drive: counts, errors of the fixes against "
      "truth, drift of the odometry.");
  const auto options = std::make_shared<InspectCommand>();
  command->add_option("logs", options->logs, "Logs, and the DBC of CAN logs; or one drive.yaml")
      ->required()
      ->type_name("LOG|DRIVE.yaml");
  add_inspection_options(*command, *options);
  command->footer("Example:\n  waymark inspect candump.log.gz --dbc car.dbc");
  command->callback([options, &action] { action = [options] { return inspect(*options); }; });
}

}  // namespace waymark::program
