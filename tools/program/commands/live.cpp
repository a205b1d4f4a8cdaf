#include <algorithm>
#include <atomic>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <unistd.h>
#include <nlohmann/json.hpp>

#include <waymark/core/base/error.hpp>
#include <waymark/formats/text/text_file.hpp>
#include <waymark/tools/drive/description/log_config.hpp>
#include <waymark/tools/live/session/former_noise.hpp>
#include <waymark/tools/live/session/live_loop.hpp>
#include <waymark/tools/program/commands/commands.hpp>
#include <waymark/tools/program/jobs/drive_choice.hpp>
#include <waymark/tools/program/jobs/live/live_report.hpp>
#include <waymark/tools/program/jobs/program_registry.hpp>
#include <waymark/tools/program/terminal/dashboard.hpp>
#include <waymark/tools/program/terminal/output.hpp>
#include <waymark/tools/program/terminal/service_manager.hpp>

namespace waymark::program {
namespace {

struct LiveCommand {
  CommonOptions common;
  std::string input;
  std::string data_folder;
  std::string modeling;
  std::vector<std::string> outputs;
  std::string talker = "GN";
  std::string record;
  std::string play;
  std::string speed = "max";
  std::string state;
  std::string noise;
  std::string way_of_noise;
  std::string report;
  bool status = false;
  live::LiveSettings settings;
};

std::atomic<bool> reopen_requested{false};

/// Parses "nmea:tcp://:10110?rate=5".
void add_output(const std::string& text, const LiveCommand& command, bool may_wait, live::Session& session) {
  const std::size_t colon = text.find(':');
  const std::string format = text.substr(0, colon);
  if (colon == std::string::npos)
    throw UsageError("--output " + text + ": write FORMAT:PLACE, such as json:- or nmea:tcp://:10110");
  std::unique_ptr<live::ReportWriter> writer;
  if (format == "json") {
    writer = live::make_json_writer();
  } else if (format == "nmea") {
    writer = live::make_nmea_writer(command.talker);
  } else if (format == "csv") {
    writer = live::make_csv_writer();
  } else if (format == "mcap") {
    writer = live::make_mcap_writer();
  } else {
    throw UsageError("--output " + text + ": unknown format '" + format +
                     "'; known are json, nmea, csv, mcap");
  }
  const live::Address address = live::parse_address(text.substr(colon + 1));
  double rate_hz = format == "nmea" ? 10 : 0;
  for (const auto& [name, value] : address.options) {
    if (name != "rate") throw UsageError("--output " + text + ": an output has the option 'rate' only");
    char* end = nullptr;
    rate_hz = std::strtod(value.c_str(), &end);
    if (value.empty() || *end != '\0' || !(rate_hz >= 0) || rate_hz > 1e4)
      throw UsageError("--output " + text + ": rate is a number of poses per second; 0: all");
  }
  std::string header = writer->header();
  session.add_output(std::move(writer),
                     std::make_unique<live::ByteOutput>(address, std::move(header), may_wait), rate_hz);
}

/// A log that is not there, among logs that lie still, will not come. A device may be plugged in later.
void require_files(const live::Session& session) {
  std::error_code unknown;
  std::size_t lie_still = 0;
  std::string missing;
  for (const live::Session::Input& input : session.inputs()) {
    const bool may_come = drive::is_address(input.file) || input.file.rfind("/dev/", 0) == 0;
    if (std::filesystem::is_regular_file(input.file, unknown)) ++lie_still;
    if (!may_come && missing.empty() && !std::filesystem::exists(input.file, unknown)) missing = input.file;
  }
  if (!missing.empty() && lie_still + 1 >= session.inputs().size())
    throw InputError(missing + ": no such file, and the other logs of the drive are files");
}

/// Logs that are files lie still: they are replayed.
bool is_replay(const live::Session& session) {
  return std::all_of(session.inputs().begin(), session.inputs().end(), [](const live::Session::Input& input) {
    std::error_code unknown;
    return std::filesystem::is_regular_file(input.file, unknown) ||
           std::filesystem::is_directory(input.file, unknown);
  });
}

double speed_of(const std::string& text) {
  if (text == "max") return 0;
  char* end = nullptr;
  const double speed = std::strtod(text.c_str(), &end);
  if (text.empty() || *end != '\0' || !(speed > 0) || speed > 1e6)
    throw UsageError("--speed " + text + ": a number of times real time, or 'max'");
  return speed;
}

nlohmann::ordered_json json_of(const live::LatencyHistogram& histogram) {
  return {{"count", histogram.count()},
          {"p50_us", histogram.quantile_us(0.5)},
          {"p99_us", histogram.quantile_us(0.99)},
          {"p999_us", histogram.quantile_us(0.999)},
          {"max_us", histogram.largest_us()}};
}

nlohmann::ordered_json session_json(const live::Session& session) {
  const live::Counts& counts = session.estimator().counts();
  nlohmann::ordered_json json{{"state", to_string(session.estimator().state())},
                              {"taken", counts.taken},
                              {"refused", counts.refused},
                              {"corrupt", session.corrupt()},
                              {"late_fixes", counts.late_fixes},
                              {"solutions", counts.solutions},
                              {"lessons", counts.lessons},
                              {"failures", counts.failures},
                              {"resets", counts.resets},
                              {"lines_dropped", session.lines_dropped()}};
  json["latency"] = {{"predict", json_of(session.latencies().predict)},
                     {"solve", json_of(session.latencies().solve)},
                     {"learn", json_of(session.latencies().learn)}};
  return json;
}

std::string text_of(const live::LatencyHistogram& histogram) {
  return fmt::format("median {:.0f}, 99 % {:.0f}, 99.9 % {:.0f}, largest {:.0f} us",
                     histogram.quantile_us(0.5), histogram.quantile_us(0.99), histogram.quantile_us(0.999),
                     histogram.largest_us());
}

void print_summary(const live::Session& session, const Console& console) {
  const live::Counts& counts = session.estimator().counts();
  std::string taken;
  for (const auto& [source, count] : counts.taken)
    taken += fmt::format("{}{} {}", taken.empty() ? "" : ", ", count, source);
  console.tell("used        " + (taken.empty() ? "nothing" : taken));
  for (const auto& [reason, count] : counts.refused)
    console.tell(fmt::format("refused     {} {}", count, reason));
  if (session.corrupt() > 0) console.tell(fmt::format("corrupt     {} records", session.corrupt()));
  console.tell(fmt::format("solutions   {}, failures {}, resets {}, late fixes {}, end: {}", counts.solutions,
                           counts.failures, counts.resets, counts.late_fixes,
                           to_string(session.estimator().state())));
  if (session.latencies().predict.count() > 0)
    console.tell("predict     " + text_of(session.latencies().predict));
  if (session.latencies().solve.count() > 0)
    console.tell("solve       " + text_of(session.latencies().solve));
  if (session.latencies().learn.count() > 0)
    console.tell("learn       " + text_of(session.latencies().learn));
  if (session.lines_dropped() > 0)
    console.warning(
        fmt::format("{} lines were dropped for readers that were too slow", session.lines_dropped()));
}

ExitCode run(const LiveCommand& command) {
  const Console console(command.common);
  DriveChoice choice;
  choice.data_folder = command.data_folder;
  drive::DriveFile file = read_drive_file(command.input, choice);
  if (!command.modeling.empty()) file.settings.modeling = command.modeling;
  if (!command.way_of_noise.empty()) file.settings.estimates_noise = command.way_of_noise == "estimate";
  const TypeRegistry registry = make_registry(command.common, file.description.plugins);
  if (!command.noise.empty()) live::use_former_noise(command.noise, registry, file.settings);
  const double speed = speed_of(command.speed);
  live::Session session(file, command.settings, registry);
  session.stop_with(interrupted);
  if (command.play.empty()) require_files(session);
  const bool replays = !command.play.empty() || is_replay(session);
  if (replays && !command.record.empty())
    throw UsageError("--record: the logs of this drive are recorded already");
  std::vector<std::string> outputs = command.outputs;
  if (outputs.empty()) outputs.push_back("json:-");
  for (const std::string& output : outputs) add_output(output, command, replays, session);
  if (!command.report.empty()) formats::make_folder(command.report);  // before a long run, not after it
  if (!command.state.empty()) session.use_state_file(command.state);
  std::signal(SIGHUP, [](int) { reopen_requested = true; });
  ServiceManager manager;
  Dashboard dashboard(command.status);
  const live::LoopOptions options{command.record, &interrupted, &reopen_requested,
                                  [&](const std::string& news) { console.note(news); },
                                  [&] {
                                    manager.alive();
                                    dashboard.show(session);
                                  }};
  manager.ready();
  if (!command.play.empty()) {
    live::replay_recording(session, command.play, options);
  } else if (replays) {
    live::replay_logs(session, speed, options);
  } else {
    live::run_live(session, options);
  }
  manager.stopping();
  dashboard.end();
  if (!command.report.empty()) {
    const std::string name = std::filesystem::path(command.input).filename().string();
    const std::vector<std::string> written =
        drawing::write_page(live_page(session, name), command.report, "report");
    console.note("written " + written.front());
  }
  const bool stdout_taken = std::any_of(outputs.begin(), outputs.end(), [](const std::string& output) {
    return output.ends_with(":-") || output.find(":-?") != std::string::npos;
  });
  if (command.common.json && !stdout_taken) {
    console.result(json_document("live", session_json(session)));
  } else {
    print_summary(session, console);
  }
  return kSuccess;
}

}  // namespace

void add_live(CLI::App& app, Action& action) {
  auto* command = app.add_subcommand(
      "live",
      "Fuse while driving: poses with covariance at the rate of the odometry\n\n"
      "Fuses live sources in a sliding window. The DRIVE.yaml is that of 'run'; its logs are sources: "
      "'file: gpsd://localhost', 'serial:///dev/ttyACM0?baud=38400', 'tcp://HOST:PORT', 'udp://:PORT', "
      "'can://can0', '-' or a FIFO, with their 'format'. A drive whose logs are files is replayed.");
  const auto options = std::make_shared<LiveCommand>();
  command->add_option("drive", options->input, "drive.yaml")->required()->type_name("DRIVE.yaml");
  command->add_option("--data", options->data_folder, "Folder of the logs, instead of the drive.yaml's own")
      ->type_name("DIR");
  command
      ->add_option("-m,--modeling", options->modeling,
                   "Modeling of the fixes, instead of the drive.yaml's own")
      ->type_name("MODELING");
  {
    const OptionHeading heading(*command, "Output");
    command
        ->add_option(
            "-o,--output", options->outputs,
            "Where poses go, any number: json, nmea, csv or mcap, then ':' and '-', a file, tcp://:PORT (a server) or "
            "udp://HOST:PORT; '?rate=5' for 5 per second. Default: json:-")
        ->type_name("FORMAT:PLACE");
    command->add_option("--talker", options->talker, "Talker of the sentences of NMEA: two letters")
        ->type_name("XX")
        ->capture_default_str();
    command
        ->add_option("--report", options->report,
                     "Write report.html at the end: the way, the radius of 95 %, the histogram of latencies")
        ->type_name("DIR");
    command->add_flag("--status", options->status, "Show state, rates, ages and latency on the terminal");
  }
  {
    const OptionHeading heading(*command, "Window");
    command
        ->add_option("--window", options->settings.window_s, "How long poses stay in the window, in seconds")
        ->type_name("SECONDS")
        ->check(CLI::Range(1.0, 1e5))
        ->capture_default_str();
    command
        ->add_option("--reorder", options->settings.reorder_s,
                     "How long samples wait for earlier ones, in seconds: it adds to the latency")
        ->type_name("SECONDS")
        ->check(CLI::Range(0.0, 10.0))
        ->capture_default_str();
    command
        ->add_option("--noise", options->way_of_noise,
                     "Noise parameters: estimated from the drive so far, or as stated (default: the modeling "
                     "decides)")
        ->type_name("WAY")
        ->check(CLI::IsMember({"estimate", "stated"}));
    command
        ->add_option("--noise-from", options->noise,
                     "Take the noise that a former 'run' estimated: its folder or summary.json")
        ->type_name("PATH");
    command
        ->add_option("--state", options->state,
                     "Begin with the state in this file if it exists, and keep it up to date")
        ->type_name("FILE.json");
  }
  {
    const OptionHeading heading(*command, "Replay");
    command->add_option("--speed", options->speed, "Replay of logs: times real time, or max")
        ->type_name("N")
        ->capture_default_str();
    command
        ->add_option("--record", options->record,
                     "Record all bytes that arrive, with the time of their arrival")
        ->type_name("FILE");
    command->add_option("--play", options->play, "Repeat a recording: the same bytes give the same poses")
        ->type_name("FILE");
  }
  add_common_options(*command, options->common);
  command->footer(
      "Ctrl-C or SIGTERM ends the run in an orderly way (exit code 0), SIGHUP opens output files again.\n\n"
      "Example:\n  waymark live drive.yaml -o json:- -o nmea:tcp://:10110");
  command->callback([options, &action] { action = [options] { return run(*options); }; });
}

}  // namespace waymark::program
