/// The common part of `inspect` and `init`: they inspect logs and propose a drive.yaml.
#pragma once

#include <string>
#include <vector>

#include <waymark/tools/inspection/inspection.hpp>
#include <waymark/tools/program/commands/commands.hpp>

namespace waymark::program {

struct InspectCommand {
  CommonOptions common;
  std::vector<std::string> logs;  ///< may include DBC files
  std::string format = "auto";
  std::vector<std::string> dbc;
  std::string output;  ///< of init: the drive.yaml
  bool force = false;  ///< of init
};

/// Adds --format, --dbc and the common options.
void add_inspection_options(CLI::App& command, InspectCommand& options);

/// @throws InputError, UsageError as inspect_logs
[[nodiscard]] std::vector<inspection::LogInspection> inspect_files(const InspectCommand& command,
                                                                   const Console& console);

/// Writes the drive.yaml. Decisions and open checks are printed on stderr. @return its text
/// @throws OutputError
std::string write_proposal(const InspectCommand& command, const std::vector<inspection::LogInspection>& logs,
                           const Console& console);

/// Checks that a drive.yaml may be written there. @throws OutputError for an existing file
/// without --force
void require_new_file(const InspectCommand& command);

}  // namespace waymark::program
