#include <memory>

#include <waymark/core/error.hpp>
#include <waymark/formats/text_file.hpp>
#include <waymark/tools/inspection/drive_proposal.hpp>
#include <waymark/tools/program/commands.hpp>
#include <waymark/tools/program/log_inspection.hpp>

namespace waymark {
namespace {

ExitCode initialise(const InspectCommand& command) {
  const Console console(command.common);
  if (command.output.empty())
    throw UsageError("-o is required: the drive.yaml to write ('-': standard output)");
  require_new_file(command);
  if (command.logs.empty()) {
    write_file_atomically(command.output, drive_template());
    console.tell(command.output +
                 ": a template was written, as no log was named; fill in its 'file' entries");
    return kSuccess;
  }
  write_proposal(command, inspect_files(command, console), console);
  return kSuccess;
}

}  // namespace

void add_init(CLI::App& app, Action& action) {
  auto* command = app.add_subcommand(
      "init",
      "A drive.yaml for the logs of a drive\n\n"
      "Says which log got which role and why. What was assumed is marked '# CHECK' in the file. Without logs "
      "it writes a template with comments. An existing file is replaced only with --force.");
  const auto options = std::make_shared<InspectCommand>();
  command->add_option("logs", options->logs, "Logs, and the DBC of CAN logs; none: a template")
      ->type_name("LOG");
  add_inspection_options(*command, *options);
  command->footer(
      "Example:\n  waymark init odometry.csv gnss.nmea -o drive.yaml && waymark run drive.yaml -o out");
  command->callback([options, &action] { action = [options] { return initialise(*options); }; });
}

}  // namespace waymark
