#include <cmath>

#include <waymark/tools/program/commands/commands.hpp>
#include <waymark/tools/program/commands/drive_options.hpp>
#include <waymark/tools/program/manual/usage_hints.hpp>

namespace waymark::program {
namespace {

/// A check of a number whose failure reads "--withhold: must be 0 (none) or at least 2, got 1".
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

}  // namespace

void add_common_options(CLI::App& command, CommonOptions& options) {
  const OptionHeading heading(command, "Common options");
  command.add_flag("-q,--quiet", options.quiet, "Print errors only (and what --json asks for)");
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

void add_drive_options(CLI::App& command, DriveOverrides& overrides) {
  const OptionHeading heading(command, "The drive");
  command.add_option("--data", overrides.data_folder, "Folder of the logs, instead of the drive.yaml's own")
      ->type_name("DIR");
  command
      .add_option("-m,--modeling", overrides.modelings,
                  "GNSS modelings, or 'all' (default: the drive.yaml's)")
      ->delimiter(',')
      ->expected(1)
      ->allow_extra_args(false)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
      ->type_name("MODELING|all[,...]");
  command
      .add_option("--modeling-option", overrides.modeling_options,
                  "Option of the modeling, see 'waymark info'")
      ->type_name("NAME=VALUE")
      ->expected(1)
      ->allow_extra_args(false)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  command.add_option("--from", overrides.from_s, "Begin so many seconds after the first odometry sample")
      ->type_name("SECONDS")
      ->check(rule("must be a number of seconds, at least 0", at_least_zero));
  command.add_option("--to", overrides.to_s, "End so many seconds after the first odometry sample")
      ->type_name("SECONDS")
      ->check(rule("must be a number of seconds, at least 0", at_least_zero));
  command
      .add_option("--withhold", overrides.withhold_every,
                  "Keep the fixes of every N-th epoch out of the graph, to evaluate against")
      ->type_name("N")
      ->check(rule("must be 0 (none) or at least 2", [](double n) { return n == 0 || n >= 2; }));
  command
      .add_option(
          "--outage", overrides.outage,
          "Keep the last LENGTH of every EVERY seconds of fixes out of the graph, to evaluate against")
      ->type_name("LENGTH/EVERY");
  command.add_option("--initial-guess", overrides.start, "How the poses are guessed from the logs")
      ->check(one_of("initial guess", {"anchored", "dead_reckoning"}));
  command.add_option("--gnss-loss", overrides.loss, "Robust loss of the fixes, or 'none'")
      ->type_name("LOSS:SCALE|none");
  command
      .add_option("--calibrate", overrides.calibrate,
                  "States to estimate with the poses: 'on' (gyro_bias, speed_scale, time_offset), 'off', or "
                  "options of the odometry model or the modeling, such as gyro_bias=constant")
      ->type_name("on|off|NAME=VALUE[,...]")
      ->delimiter(',')
      ->expected(1)
      ->allow_extra_args(false)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  command
      .add_option("--noise", overrides.noise,
                  "Noise parameters: estimated from the drive, or as stated (default: the modeling decides)")
      ->check(one_of("way", {"estimate", "stated"}));
  command.add_flag("--no-gate", overrides.no_gate, "Accept every fix");
  command.add_flag("--sync", overrides.sync,
                   "Estimate how late speed and yaw rate are stamped against the GNSS, and apply it");
}

void add_optimization_options(CLI::App& command, OptimizationChoice& choice) {
  const OptionHeading heading(command, "Optimisation");
  command
      .add_option("-a,--algorithm", choice.algorithm,
                  "gauss_newton, levenberg_marquardt, dogleg or a plugin's")
      ->type_name("ALGORITHM")
      ->capture_default_str();
  command
      .add_option("-s,--solver", choice.solver,
                  "Linear solver, see 'waymark info'; auto: the fastest by measurement")
      ->type_name("SOLVER|auto")
      ->capture_default_str();
  command.add_option("--algorithm-option", choice.options, "Option of the algorithm, see 'waymark info'")
      ->type_name("NAME=VALUE")
      ->expected(1)
      ->allow_extra_args(false)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  command
      .add_option("--covariance", choice.covariance, "Covariances to write: of no, the fixes' or all poses")
      ->check(one_of("choice", {"none", "fixes", "all"}))
      ->capture_default_str();
  add_stopping_options(command, choice);
}

void add_stopping_options(CLI::App& command, OptimizationChoice& choice) {
  const OptionHeading heading(command, "Optimisation");
  command
      .add_option("--threads", choice.threads, "Threads to work with; the result is the same for any number")
      ->check(CLI::Range(1, 256))
      ->capture_default_str();
  command.add_option("--max-iterations", choice.max_iterations, "Give up after so many steps")
      ->check(rule("must be at least 0", at_least_zero))
      ->capture_default_str();
  command
      .add_option("--tolerance", choice.tolerance, "Newton decrement relative to 1 + chi2 that ends the run")
      ->check(rule("must be above 0", [](double x) { return x > 0 && std::isfinite(x); }))
      ->capture_default_str();
}

}  // namespace waymark::program
