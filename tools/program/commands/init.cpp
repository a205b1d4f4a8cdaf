#include <memory>
#include <sstream>

#include <waymark/core/base/error.hpp>
#include <waymark/formats/text/text_file.hpp>
#include <waymark/tools/inspection/proposal/drive_proposal.hpp>
#include <waymark/tools/program/commands/commands.hpp>
#include <waymark/tools/program/jobs/inspection/log_inspection.hpp>
#include <waymark/tools/program/terminal/output.hpp>

namespace waymark::program {
namespace {

/// Returns the lines of a drive.yaml that are marked as assumed.
nlohmann::ordered_json checks_in(const std::string& yaml) {
  constexpr std::string_view kMark = "# CHECK";
  nlohmann::ordered_json checks = nlohmann::ordered_json::array();
  std::istringstream lines(yaml);
  std::string line;
  for (int number = 1; std::getline(lines, line); ++number) {
    const auto mark = line.find(kMark);
    const auto begin = line.find_first_not_of(' ');
    // A comment line that only mentions the mark does not count.
    if (mark == std::string::npos || (line[begin] == '#' && mark != begin)) continue;
    checks.push_back({{"line", number}, {"text", line.substr(begin)}});
  }
  return checks;
}

ExitCode initialise(const InspectCommand& command) {
  const Console console(command.common);
  if (command.output.empty())
    throw UsageError("-o is required: the drive.yaml to write ('-': standard output)");
  require_new_file(command);
  std::string text;
  if (command.logs.empty()) {
    text = inspection::drive_template();
    formats::write_file_atomically(command.output, text);
    console.tell(command.output +
                 ": this is a template, because no log was named; fill in its 'file' entries");
  } else {
    text = write_proposal(command, inspect_files(command, console), console);
  }
  if (command.common.json) {
    console.result(json_document("init", {{"file", command.output},
                                          {"template", command.logs.empty()},
                                          {"checks", checks_in(text)}}),
                   is_stdout(command.output));
  }
  return kSuccess;
}

}  // namespace

void add_init(CLI::App& app, Action& action) {
  auto* command = app.add_subcommand(
      "init",
      "Write a drive.yaml for the logs of a drive\n\n"
      "Prints the role of each log and the reason. Assumptions are marked '# CHECK' in the file. "
      "Without logs it writes a template with comments. An existing file is replaced "
      "only with --force.");
  const auto options = std::make_shared<InspectCommand>();
  command
      ->add_option("logs", options->logs,
                   "Logs, and the DBC of CAN logs; without logs "
                   "a template is written")
      ->type_name("LOG");
  command->add_option("-o,--out", options->output, "The drive.yaml to write ('-': standard output)")
      ->type_name("DRIVE.yaml");
  command->add_flag("--force", options->force, "Replace an existing drive.yaml");
  add_inspection_options(*command, *options);
  command->footer(
      "Example:\n  waymark init odometry.csv gnss.nmea -o drive.yaml && waymark run drive.yaml -o out");
  command->callback([options, &action] { action = [options] { return initialise(*options); }; });
}

}  // namespace waymark::program
