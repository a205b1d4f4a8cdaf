#include <cmath>
#include <utility>

#include <waymark/tools/program/commands/commands.hpp>
#include <waymark/tools/program/commands/drive_options.hpp>
#include <waymark/tools/program/jobs/graph/optimization.hpp>
#include <waymark/tools/program/manual/usage_hints.hpp>

namespace waymark::program {
namespace {

/// Checks a number. Its error reads "--withhold: must be 0 (none) or at least 2, got 1".
CLI::Validator rule(const std::string& words, bool (*holds)(double)) {
  return CLI::Validator(
      [words, holds](const std::string& text) {
        double value = 0;
        const bool number = CLI::detail::lexical_cast(text, value);
        return number && holds(value) ? std::string() : words + ", got " + text;
      },
      "");
}

bool at_least_zero(double value) {
  return value >= 0 && std::isfinite(value);
}

using drive::DriveFile;

/// Adds an option whose value changes the content of the drive.yaml.
template <typename Value>
CLI::Option* add_edit(CLI::App& command, DriveChoice& choice, const std::string& name,
                      const std::string& text, void (*apply)(DriveFile&, const Value&)) {
  const auto take = [&choice, apply](const Value& value) {
    choice.edits.emplace_back([apply, value](DriveFile& file) { apply(file, value); });
  };
  return command.add_option_function<Value>(name, take, text);
}

/// Makes an option repeatable, with one value each time.
CLI::Option* repeated(CLI::Option* option) {
  return option->expected(1)->allow_extra_args(false)->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
}

}  // namespace

void add_common_options(CLI::App& command, CommonOptions& options) {
  const OptionHeading heading(command, "Common options");
  command.add_flag("-q,--quiet", options.quiet, "Print only errors (and the result of --json)");
  command.add_flag("-v,--verbose", options.verbosity, "Print what is done (iterations, files)");
  command.add_flag("--json", options.json, "Print the result as JSON on standard output");
  add_plugin_option(command, options);
}

void add_plugin_option(CLI::App& command, CommonOptions& options) {
  command
      .add_option(
          "--plugin", options.plugins,
          "Load a plugin module: a file, or a name looked up in WAYMARK_PLUGIN_PATH (may be repeated)")
      ->type_name("FILE.so|PLUGIN")
      ->expected(1)
      ->allow_extra_args(false)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
}

void add_drive_options(CLI::App& command, DriveChoice& choice) {
  const OptionHeading heading(command, "The drive");
  command.add_option("--data", choice.data_folder, "Folder of the logs, instead of the drive.yaml's own")
      ->type_name("DIR");
  repeated(command.add_option("-m,--modeling", choice.modelings,
                              "GNSS modelings, or 'all' (default: the drive.yaml's)"))
      ->delimiter(',')
      ->type_name("MODELING|all[,...]");
  repeated(command.add_option("--modeling-option", choice.modeling_options,
                              "Option of the modeling, see 'waymark info'"))
      ->type_name("NAME=VALUE");
  add_edit<double>(command, choice, "--from", "Begin N seconds after the first odometry sample",
                   [](DriveFile& file, const double& s) { file.description.from_s = s; })
      ->type_name("SECONDS")
      ->check(rule("must be a number of seconds, at least 0", at_least_zero));
  add_edit<double>(command, choice, "--to", "End N seconds after the first odometry sample",
                   [](DriveFile& file, const double& s) { file.description.to_s = s; })
      ->type_name("SECONDS")
      ->check(rule("must be a number of seconds, at least 0", at_least_zero));
  add_edit<int>(command, choice, "--withhold",
                "Keep the fixes of every N-th epoch out of the graph, for evaluation",
                [](DriveFile& file, const int& every) { set_withheld(file, every); })
      ->type_name("N")
      ->check(rule("must be 0 (none) or at least 2", [](double n) { return n == 0 || n >= 2; }));
  add_edit<std::string>(
      command, choice, "--outage",
      "Keep the last LENGTH of every EVERY seconds of fixes out of the graph, for evaluation",
      [](DriveFile& file, const std::string& text) { file.description.outage = parse_outage(text); })
      ->type_name("LENGTH/EVERY");
  add_edit<std::string>(command, choice, "--initial-guess", "Initial guess of the poses from the logs",
                        set_initial_guess)
      ->check(one_of("initial guess", {"anchored", "dead_reckoning"}));
  add_edit<std::string>(command, choice, "--gnss-loss", "Robust loss of the fixes, or 'none'", set_loss)
      ->type_name("LOSS:SCALE|none");
  repeated(add_edit<std::vector<std::string>>(
               command, choice, "--calibrate",
               "States to estimate with the poses: 'on' (gyro_bias, speed_scale, time_offset), 'off', or "
               "options of the odometry model or the modeling, such as gyro_bias=constant",
               [](DriveFile& file, const std::vector<std::string>& words) {
                 set_calibration(words, file.settings);
               }))
      ->delimiter(',')
      ->type_name("on|off|NAME=VALUE[,...]");
  add_edit<std::string>(
      command, choice, "--noise",
      "Noise parameters: estimated from the drive, or as stated (default: the modeling decides)",
      [](DriveFile& file, const std::string& way) { file.settings.estimates_noise = way == "estimate"; })
      ->check(one_of("way", {"estimate", "stated"}));
  command.add_flag_callback(
      "--no-gate",
      [&choice] { choice.edits.emplace_back([](DriveFile& file) { file.settings.gate.enabled = false; }); },
      "Accept every fix");
  command.add_flag("--sync", choice.sync,
                   "Estimate the delay of speed and yaw rate against the GNSS, and correct it");
}

/// Adds an option of the command that states options of a registered type.
static void add_type_options(CLI::App& command, const std::string& name, const std::string& text,
                             Options& options) {
  command
      .add_option_function<std::vector<std::string>>(
          name, [&options](const std::vector<std::string>& pairs) { options = parse_options(pairs); }, text)
      ->type_name("NAME=VALUE")
      ->expected(1)
      ->allow_extra_args(false)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
}

void add_optimization_options(CLI::App& command, drive::Minimization& minimization) {
  const OptionHeading heading(command, "Optimisation");
  command
      .add_option("-a,--algorithm", minimization.algorithm,
                  "gauss_newton, levenberg_marquardt, dogleg or a plugin's")
      ->type_name("ALGORITHM")
      ->capture_default_str();
  command
      .add_option("-s,--solver", minimization.solver,
                  "Linear solver, see 'waymark info'; auto: the fastest by measurement")
      ->type_name("SOLVER|auto")
      ->capture_default_str();
  add_type_options(command, "--algorithm-option", "Option of the algorithm, see 'waymark info'",
                   minimization.options);
  add_type_options(command, "--solver-option", "Option of the linear solver, see 'waymark info'",
                   minimization.solver_options);
  command
      .add_option("--covariance", minimization.covariances,
                  "Covariances to write: none, of the poses at fixes, or of all poses")
      ->check(one_of("choice", {"none", "fixes", "all"}))
      ->capture_default_str();
  add_stopping_options(command, minimization);
}

void add_stopping_options(CLI::App& command, drive::Minimization& minimization) {
  const OptionHeading heading(command, "Optimisation");
  command
      .add_option("--threads", minimization.threads, "Number of threads; the result does not depend on it")
      ->check(CLI::Range(1, 256))
      ->capture_default_str();
  command.add_option("--max-iterations", minimization.max_iterations, "Stop after N steps")
      ->check(rule("must be at least 0", at_least_zero))
      ->capture_default_str();
  command
      .add_option("--tolerance", minimization.tolerance,
                  "The run ends if the Newton decrement is below this share of 1 + chi2")
      ->check(rule("must be above 0", [](double x) { return x > 0 && std::isfinite(x); }))
      ->capture_default_str();
}

void add_map_option(CLI::App& command, std::string& file) {
  command
      .add_option("--map", file,
                  "Draw roads and buildings of this extract beneath the trajectory of the report")
      ->type_name("FILE.geojson");
}

}  // namespace waymark::program
