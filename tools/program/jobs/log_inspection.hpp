/// What `inspect` and `init` share: logs are looked at, and a drive.yaml is proposed from what was found.
#pragma once

#include <string>
#include <vector>

#include <waymark/tools/inspection/inspection.hpp>
#include <waymark/tools/program/commands/commands.hpp>

namespace waymark::program {

struct InspectCommand {
  CommonOptions common;
  std::vector<std::string> logs;  ///< DBC files among them
  std::string format = "auto";
  std::string dbc;
  std::string output;  ///< of init: the drive.yaml
  bool force = false;  ///< of init
};

/// --format, --dbc and the common ones.
void add_inspection_options(CLI::App& command, InspectCommand& options);

/// @throws InputError, UsageError as inspect_logs
[[nodiscard]] std::vector<inspection::LogInspection> inspect_files(const InspectCommand& command,
                                                                   const Console& console);

/// Writes the drive.yaml; what was decided and what is left to check goes to stderr. @return its text
/// @throws OutputError
std::string write_proposal(const InspectCommand& command, const std::vector<inspection::LogInspection>& logs,
                           const Console& console);

/// A place that a drive.yaml may be written to. @throws OutputError for an existing file without --force
void require_new_file(const InspectCommand& command);

}  // namespace waymark::program
