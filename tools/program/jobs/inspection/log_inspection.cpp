#include <waymark/tools/program/jobs/inspection/log_inspection.hpp>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <span>

#include <waymark/core/base/error.hpp>
#include <waymark/formats/logs/log_file.hpp>
#include <waymark/formats/text/text_file.hpp>
#include <waymark/tools/drive/description/drive_file.hpp>
#include <waymark/tools/inspection/proposal/drive_proposal.hpp>
#include <waymark/tools/program/jobs/program_registry.hpp>
#include <waymark/tools/program/terminal/output.hpp>

namespace waymark::program {
namespace {

Stamp now() {
  const auto since_1970 = std::chrono::system_clock::now().time_since_epoch();
  return Stamp{std::chrono::duration_cast<std::chrono::nanoseconds>(since_1970).count()};
}

std::vector<LogReaderType> readers_of(const TypeRegistry& registry) {
  std::vector<LogReaderType> readers;
  for (const Registered<LogReaderType>& entry : registry.log_readers()) readers.push_back(entry.type);
  return readers;
}

bool is_dbc(const std::string& path) {
  return path.ends_with(".dbc") || path.ends_with(".DBC");
}

/// Returns the files in the folders among some paths. A folder that is one log stays.
std::vector<std::string> files_in(const std::vector<std::string>& paths,
                                  std::span<const LogReaderType> readers) {
  const auto is_log = [&](const std::string& folder) {
    try {
      return formats::recognise_log(folder, readers).reader.name == "kitti_oxts";
    } catch (const InputError&) {
      return false;
    }
  };
  std::vector<std::string> files;
  for (const std::string& path : paths) {
    std::error_code unknown;  // opening the file will report the error
    if (!std::filesystem::is_directory(path, unknown) || is_log(path)) {
      files.push_back(path);
      continue;
    }
    std::vector<std::string> inside;
    std::error_code unreadable;
    for (const auto& entry : std::filesystem::directory_iterator(path, unreadable))
      if (entry.is_regular_file(unknown) && !entry.path().filename().string().starts_with('.'))
        inside.push_back(entry.path().string());
    if (unreadable) throw InputError(path + ": cannot read the folder: " + unreadable.message());
    std::sort(inside.begin(), inside.end());
    files.insert(files.end(), inside.begin(), inside.end());
  }
  return files;
}

/// Leaves out what is no log: `inspect *` meets pictures and drives too.
std::vector<std::string> logs_among(const std::vector<std::string>& files,
                                    std::span<const LogReaderType> readers, const Console& console) {
  if (files.size() < 2) return files;
  std::vector<std::string> logs;
  for (const std::string& file : files) {
    if (drive::is_drive_file(file)) {
      console.note(file + ": left out: it describes a drive; inspect it alone");
      continue;
    }
    try {
      (void)formats::recognise_log(file, readers);
      logs.push_back(file);
    } catch (const InputError& error) {
      console.warning(std::string(error.what()) + "; left out");
    }
  }
  if (logs.empty()) throw InputError("none of the files is a log that is known");
  return logs;
}

}  // namespace

void add_inspection_options(CLI::App& command, InspectCommand& options) {
  command.add_option("--format", options.format, "Format of the logs; default: recognised by their content")
      ->type_name("LOG_FORMAT");
  command.add_option("--dbc", options.dbc, "Description of the signals in CAN frames; may be repeated")
      ->type_name("FILE.dbc")
      ->allow_extra_args(false);
  options.common = {};
  add_common_options(command, options.common);
}

void require_new_file(const InspectCommand& command) {
  if (is_stdout(command.output)) return;
  require_output_place(command.output);
  std::error_code unknown;  // writing will report the error
  if (!command.force && std::filesystem::exists(command.output, unknown))
    throw OutputError(command.output + ": it exists already; --force replaces it");
}

std::vector<inspection::LogInspection> inspect_files(const InspectCommand& command, const Console& console) {
  const TypeRegistry registry = make_registry(command.common);
  inspection::InspectionOptions options;
  options.format = command.format;
  options.dbc = command.dbc;
  options.now = now();
  const std::vector<LogReaderType> readers = readers_of(registry);
  std::vector<std::string> logs;
  for (const std::string& path : files_in(command.logs, readers)) {
    (is_dbc(path) ? options.dbc : logs).push_back(path);
  }
  if (logs.empty())
    throw UsageError(options.dbc.front() + ": a DBC only describes CAN frames; name a log too");
  options.watch = watch_reading(console);
  if (options.format == "auto") logs = logs_among(logs, readers, console);
  std::vector<inspection::LogInspection> inspected = inspection::inspect_logs(logs, readers, options);
  console.end_progress();
  return inspected;
}

std::string write_proposal(const InspectCommand& command, const std::vector<inspection::LogInspection>& logs,
                           const Console& console) {
  const inspection::DriveProposal proposal = inspection::propose_drive(logs);
  for (const std::string& decision : proposal.decisions) console.tell(decision);
  std::string text = inspection::drive_yaml(proposal, logs, command.output);
  formats::write_file_atomically(command.output, text);
  if (!is_stdout(command.output)) console.tell(command.output + ": written; look for '# CHECK' in it");
  return text;
}

}  // namespace waymark::program
