#include <filesystem>
#include <memory>

#include <waymark/core/base/error.hpp>
#include <waymark/formats/text/text_file.hpp>
#include <waymark/tools/program/command_line.hpp>
#include <waymark/tools/program/manual/man_page.hpp>
#include <waymark/tools/program/terminal/output.hpp>

namespace waymark::program {
namespace {

struct HelpOptions {
  std::string command;
  bool man = false;
  std::string folder;
};

/// Writes every page into its own file: waymark.1, waymark-run.1 ...
void write_pages(const CLI::App& app, const std::string& folder) {
  formats::make_folder(folder);
  const auto write = [&](const CLI::App& command) {
    formats::write_file_atomically(folder + "/" + page_name(command) + ".1",
                                   man_page(command, source_date()));
  };
  write(app);
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) write(*command);
}

ExitCode help(const CLI::App& app, const HelpOptions& options) {
  const CLI::App& command = options.command.empty() ? app : find_command(app, options.command);
  if (!options.folder.empty()) {
    write_pages(app, options.folder);
    return kSuccess;
  }
  // command.help() is not used, because for the program it would give the help of the chosen
  // subcommand, this one.
  formats::write_file_atomically(
      "-", options.man ? man_page(command, source_date())
                       : command.get_formatter()->make_help(&command, "", CLI::AppFormatMode::Normal));
  return kSuccess;
}

}  // namespace

void add_help(CLI::App& app, Action& action) {
  auto* command = app.add_subcommand(
      "help",
      "Print the help of the program or of a subcommand, or write man pages\n\n"
      "Without options it prints the same text as --help. The man pages and the completion of the "
      "shell have the same words. SOURCE_DATE_EPOCH, if it is set, gives the date of the pages.");
  const auto options = std::make_shared<HelpOptions>();
  auto* name =
      command->add_option("command", options->command, "Subcommand to explain")->type_name("SUBCOMMAND");
  auto* man = command->add_flag("--man", options->man, "Print the man page (roff)");
  command->add_option("-o,--out", options->folder, "Write all man pages into this folder")
      ->type_name("DIR")
      ->needs(man)
      ->excludes(name);
  command->footer("Example:\n  waymark help run\n  waymark help --man run | man -l -");
  command->callback([options, &app, &action] { action = [options, &app] { return help(app, *options); }; });
}

}  // namespace waymark::program
