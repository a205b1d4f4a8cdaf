#include <algorithm>
#include <cstdio>
#include <exception>
#include <iostream>

#include <waymark/core/error.hpp>
#include <waymark/core/suggest.hpp>
#include <waymark/tools/benchmark/contestants.hpp>
#include <waymark/tools/program/commands.hpp>
#include <waymark/tools/program/program_registry.hpp>

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

/// Version, and the backends built in with the licences they bring.
std::string version_text() {
  std::string text = "waymark " WAYMARK_VERSION " (BSD-3-Clause)";
  const TypeRegistry registry = make_registry({});
  for (const auto& [solver, origin] : registry.linear_solvers())
    text += "\n  " + solver.name + ": " + solver.license;
  for (const std::string& peer : built_in_peers()) text += "\n  peer " + peer + ", for comparison";
  return text;
}

/// The parser would only say that a subcommand is required. @throws UsageError
void check_command(const CLI::App& app, int argc, char** argv) {
  const std::string_view word = argc > 1 ? argv[1] : "-";
  if (word.starts_with('-')) return;
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands(nullptr)) names.push_back(command->get_name());
  if (std::find(names.begin(), names.end(), word) != names.end()) return;
  const std::vector<std::string_view> views(names.begin(), names.end());
  const std::string nearest = did_you_mean(word, views);
  throw UsageError("unknown subcommand '" + std::string(word) + "'" +
                   (nearest.empty() ? "; there are: " + joined(views) : nearest));
}

ExitCode run(int argc, char** argv) {
  CLI::App app("Waymark: fuses a vehicle's odometry with GNSS in a pose graph, and optimises graphs.");
  Action action;
  app.require_subcommand(1);
  app.set_version_flag("--version", version_text);
  app.footer(kFooter);
  app.failure_message([](const CLI::App*, const CLI::Error& error) {
    return std::string("waymark: error: ") + error.what() + "\nRun with --help for more information.\n";
  });
  add_inspect(app, action);
  add_init(app, action);
  add_sync(app, action);
  add_convert(app, action);
  add_optimize(app, action);
  add_evaluate(app, action);
  add_run(app, action);
  add_bench(app, action);
  add_info(app, action);
  add_check(app, action);
  add_simulate(app, action);
  add_reproduce(app, action);
  try {
    check_command(app, argc, argv);
    app.parse(argc, argv);
    return action();
  } catch (const CLI::ParseError& error) {
    if (app.exit(error) != 0) return kUsageError;
    std::cout.flush();
    return std::cout.good() ? kSuccess : fail(kOutputError, "standard output: cannot write");
  } catch (const Interrupted& error) {
    return fail(kInterrupted, error.what());
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
