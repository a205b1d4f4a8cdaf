#include <memory>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <waymark/core/base/error.hpp>
#include <waymark/tools/drive/clocks/clock_check.hpp>
#include <waymark/tools/drive/clocks/clock_sync.hpp>
#include <waymark/tools/drive/clocks/offset_names.hpp>
#include <waymark/tools/drive/clocks/synchronise.hpp>
#include <waymark/tools/drive/description/drive_file.hpp>
#include <waymark/tools/drive/logs/clock_offsets.hpp>
#include <waymark/tools/program/commands/commands.hpp>
#include <waymark/tools/program/jobs/program_registry.hpp>
#include <waymark/tools/program/terminal/output.hpp>
#include <waymark/tools/text/table.hpp>

namespace waymark::program {
namespace {

struct SyncCommand {
  CommonOptions common;
  drive::SyncOptions options;
  std::string input;
  std::string data_folder;
};

nlohmann::ordered_json json_of(const std::optional<drive::ClockOffset>& offset) {
  if (!offset) return nullptr;
  return {{"against", offset->against},
          {"late_s", offset->late_s},
          {"sigma_s", offset->sigma_s},
          {"correlation", offset->correlation},
          {"samples", offset->samples}};
}

/// What is found for one odometry.
struct Synchronised {
  std::string name;
  drive::SyncReport report;
};

/// @param all at least one
nlohmann::ordered_json json_of(const std::vector<Synchronised>& all,
                               const std::vector<drive::ClockReport>& clocks) {
  const drive::SyncReport& first = all.front().report;
  nlohmann::ordered_json json{{"speed", json_of(first.speed)}, {"yaw_rate", json_of(first.yaw_rate)}};
  json["odometries"] = nlohmann::ordered_json::array();
  for (const auto& [name, report] : all)
    json["odometries"].push_back(
        {{"name", name}, {"speed", json_of(report.speed)}, {"yaw_rate", json_of(report.yaw_rate)}});
  json["clocks"] = nlohmann::ordered_json::array();
  for (const drive::ClockReport& clock : clocks)
    json["clocks"].push_back({{"file", clock.file},
                              {"ahead_s", clock.ahead_s},
                              {"spread_s", clock.spread_s},
                              {"messages", clock.messages}});
  return json;
}

text::Row row_of(const std::string& quantity, const drive::ClockOffset& offset) {
  return {quantity,
          fmt::format("{:.3f}", offset.late_s),
          fmt::format("{:.3f}", offset.sigma_s),
          fmt::format("{:.4f}", offset.correlation),
          fmt::format("{}", offset.samples),
          offset.against};
}

/// @param name of one of several; empty: there is one
std::string table_of(const std::string& name, const drive::SyncReport& report,
                     const drive::OdometryConfig& odometry, const text::TextLook& look) {
  text::Table table{.columns = {(name.empty() ? "odometry" : name) + "'s", "late by [s]", "sigma [s]",
                                "correlation", "samples", "against"}};
  if (report.speed) table.rows.push_back(row_of("speed", *report.speed));
  if (report.yaw_rate) table.rows.push_back(row_of("yaw rate", *report.yaw_rate));
  std::string text = table.rows.empty() ? "" : text::table_text(table, look);
  if (!report.speed) text += "speed: no offset found (too little driving, or no correlation beyond chance)\n";
  if (!report.yaw_rate)
    text += "yaw rate: no offset found (too few turns, or no correlation beyond chance)\n";
  if (!report.speed && !report.yaw_rate) return text;
  text += "Positive: the stamps are later than GNSS time. Negative: earlier.\n\n";
  const bool speed_is_late = report.speed && report.speed->is_significant();
  const bool yaw_rate_is_late = report.yaw_rate && report.yaw_rate->is_significant();
  if (!speed_is_late && !yaw_rate_is_late)
    return text + "Nothing to apply: no offset is larger than what smoothing and three sigmas explain.\n";
  const drive::ClockOffset& one = speed_is_late ? *report.speed : *report.yaw_rate;
  if (const std::string known = drive::name_of_offset(one.late_s, 0.5); !known.empty())
    text += "That is " + known + ".\n";
  text += "To apply it: --sync of run and convert, or in the drive.yaml under '" +
          (name.empty() ? "odometry" : name) + "':\n";
  drive::OdometryConfig moved = odometry;
  std::vector<std::string> notes;
  drive::apply_offsets("", report, moved, notes);
  if (moved.speed_delay_s != odometry.speed_delay_s)
    text += fmt::format("  speed_delay: {:.3f}\n", moved.speed_delay_s);
  if (moved.yaw_rate_delay_s != odometry.yaw_rate_delay_s)
    text += fmt::format("  yaw_rate_delay: {:.3f}\n", moved.yaw_rate_delay_s);
  return text;
}

ExitCode synchronise(const SyncCommand& command) {
  const Console console(command.common);
  drive::DriveDescription description =
      drive::load_drive_file(command.input, command.data_folder).description;
  if (description.gnss.empty())
    throw InputError(description.path + ": clocks are compared with GNSS, and the drive has no 'gnss'");
  const TypeRegistry registry = make_registry(command.common, description.plugins);
  description.sensors.clear();  // sensors are not needed
  const drive::DriveLogs logs = drive::read_drive_logs(description, registry, watch_reading(console));
  console.progress("comparing clocks");
  const drive::LoggedMotion motion = drive::logged_motion(logs, description);
  std::vector<Synchronised> all;
  for (const drive::PreparedOdometry& source : motion.odometries)
    all.push_back(
        {source.name, drive::estimate_clock_offsets(source.samples, motion.fixes, command.options)});
  std::vector<drive::ClockReport> clocks;
  for (const drive::DriveLogs::Log& log : logs.gnss)
    if (const auto clock = drive::clock_of(log)) clocks.push_back(*clock);
  console.end_progress();
  for (const std::string& note : logs.notes) console.detail("note: " + note);
  if (command.common.json) {
    console.result(json_document("sync", json_of(all, clocks)));
    return kSuccess;
  }
  std::string text;
  for (const auto& [name, report] : all) {
    if (!text.empty()) text += "\n";
    text += table_of(all.size() > 1 ? name : std::string(), report, drive::config_of(name, description),
                     console.look());
  }
  for (const drive::ClockReport& clock : clocks)
    text += fmt::format(
        "\n{}: its stamps are {:.3f} s ahead of the GNSS time in its {} messages (median; usual "
        "deviation {:.3f} s),\n"
        "with the stated 'time: {{offset: ...}}' added. --sync removes this difference.\n",
        clock.file, clock.ahead_s, clock.messages, clock.spread_s);
  console.result(text);
  return kSuccess;
}

}  // namespace

void add_sync(CLI::App& app, Action& action) {
  auto* command = app.add_subcommand(
      "sync",
      "Estimate the delay of a drive's odometry against its GNSS\n\n"
      "Compares the odometry's speed and yaw rate with those of the fixes, and the stamps of a log "
      "with the GNSS time it holds. Nothing is changed; --sync of 'waymark run' and 'waymark "
      "convert' applies it.");
  const auto options = std::make_shared<SyncCommand>();
  command->add_option("drive", options->input, "drive.yaml")->required()->type_name("DRIVE.yaml");
  command->add_option("--data", options->data_folder, "Folder of the logs, instead of the drive.yaml's own")
      ->type_name("DIR");
  command
      ->add_option("--largest", options->options.largest_s,
                   "Largest offset to look for, in seconds; 0: wherever the logs would overlap")
      ->type_name("SECONDS")
      ->check(CLI::Range(0.0, 1e10))
      ->capture_default_str();
  add_common_options(*command, options->common);
  command->footer("Example:\n  waymark sync drive.yaml");
  command->callback([options, &action] { action = [options] { return synchronise(*options); }; });
}

}  // namespace waymark::program
