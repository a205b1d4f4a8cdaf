#include <cstdio>
#include <exception>

#include <waymark/core/error.hpp>
#include <waymark/tools/program/commands.hpp>

namespace waymark {
namespace {

constexpr const char* kFooter =
    "Exit codes: 0 success, 1 internal error, 2 wrong usage, 3 bad input, 4 no convergence (the result is\n"
    "written and marked), 5 output not written, 130 interrupted (the best state so far is written).\n"
    "Example:\n  waymark run drive.yaml --out results --modeling all";

ExitCode fail(ExitCode code, const char* message) {
  std::fprintf(stderr, "waymark: error: %s\n", message);
  return code;
}

ExitCode run(int argc, char** argv) {
  CLI::App app("Waymark: fuses a vehicle's odometry with GNSS in a pose graph, and optimises graphs.");
  Action action;
  app.require_subcommand(1);
  app.set_version_flag("--version", "waymark " WAYMARK_VERSION " (backends: see 'waymark info')");
  app.footer(kFooter);
  app.failure_message([](const CLI::App*, const CLI::Error& error) {
    return std::string("waymark: error: ") + error.what() + "\nRun with --help for more information.\n";
  });
  add_convert(app, action);
  add_optimize(app, action);
  add_evaluate(app, action);
  add_run(app, action);
  add_info(app, action);
  add_check(app, action);
  try {
    app.parse(argc, argv);
    return action();
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? kSuccess : kUsageError;
  } catch (const UsageError& error) {
    return fail(kUsageError, error.what());
  } catch (const InputError& error) {
    return fail(kInputError, error.what());
  } catch (const OutputError& error) {
    return fail(kOutputError, error.what());
  } catch (const std::exception& error) {
    return fail(kInternalError, (std::string("internal error, please report: ") + error.what()).c_str());
  }
}

}  // namespace
}  // namespace waymark

int main(int argc, char** argv) {
  waymark::install_signal_handlers();
  return waymark::run(argc, argv);
}
