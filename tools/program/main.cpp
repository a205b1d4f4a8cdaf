#include <malloc.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <filesystem>
#include <iostream>
#include <new>
#include <stdexcept>
#include <string>
#include <vector>

#include <waymark/core/base/error.hpp>
#include <waymark/tools/program/command_line.hpp>
#include <waymark/tools/program/jobs/program_registry.hpp>
#include <waymark/tools/program/manual/misplaced_file.hpp>
#include <waymark/tools/program/manual/usage_hints.hpp>

namespace waymark::program {
namespace {

ExitCode fail(ExitCode code, const std::string& message) {
  std::fputs(error_line(message).c_str(), stderr);
  return code;
}

/// The parser would only report that a subcommand is required. @throws UsageError
void check_command(const CLI::App& app, int argc, char** argv) {
  const std::string_view word = argc > 1 ? argv[1] : "-";
  if (word.starts_with('-')) return;
  (void)find_command(app, std::string(word));
}

ExitCode run_command(int argc, char** argv) {
  CLI::App app;
  Action action;
  build_command_line(app, action);
  app.failure_message([](const CLI::App*, const CLI::Error& error) {
    return error_line(error.what()) + "Run with --help for more information.\n";
  });
  if (argc == 1) {  // a newcomer: what there is
    std::fputs(app.help().c_str(), stdout);
    return kUsageError;
  }
  const std::vector<std::string> words(argv + 1, argv + argc);
  try {
    check_command(app, argc, argv);
    if (const std::string hint = misplaced_file(app, words); !hint.empty()) return fail(kUsageError, hint);
    app.parse(argc, argv);
    return action();
  } catch (const CLI::ParseError& error) {
    const std::string unknown = error.get_exit_code() == 0 ? "" : unknown_option(app, words);
    if (!unknown.empty()) return fail(kUsageError, unknown);
    if (app.exit(error) != 0) return kUsageError;
    std::cout.flush();
    return std::cout.good() ? kSuccess : fail(kOutputError, "standard output: cannot write");
  }
}

/// Nothing that is read may end in an internal error: what the system or the standard library says
/// about an input is bad input too.
ExitCode run(int argc, char** argv) {
  try {
    return run_command(argc, argv);
  } catch (const Interrupted& error) {
    return fail(kInterrupted, error.what());
  } catch (const UsageError& error) {
    return fail(kUsageError, error.what());
  } catch (const InputError& error) {
    // the wait for a pipe ended because of the signal
    return interrupted ? fail(kInterrupted, Interrupted().what()) : fail(kInputError, error.what());
  } catch (const OutputError& error) {
    return fail(kOutputError, error.what());
  } catch (const PluginError& error) {
    const std::string plugin = plugin_of(error.type());
    return fail(kPluginError, (plugin.empty() ? "" : "plugin '" + plugin + "': ") + error.what());
  } catch (const std::filesystem::filesystem_error& error) {
    return fail(kInputError, error.path1().string() + ": " + error.code().message());
  } catch (const std::bad_alloc&) {
    return fail(kInputError,
                std::string("the input ") + kLackOfMemory[0] + "; shorten it, or use another machine");
  } catch (const std::length_error&) {
    return fail(kInputError, "the input asks for more memory than a program can have; shorten it");
  } catch (const std::exception& error) {
    return fail(kInternalError, std::string("internal error, please report: ") + error.what());
  }
}

/// Without memory even an error may end here: a message is a string. What else ends here is a defect.
[[noreturn]] void on_terminate() {
  try {
    throw;
  } catch (const std::bad_alloc&) {
    // nothing may be put together here
    for (const char* part : {"waymark: error: ", kLackOfMemory[1], "\n"})
      (void)!::write(STDERR_FILENO, part, std::strlen(part));
    ::_exit(kInputError);
  } catch (...) {
    std::abort();
  }
}

/// Keeps the memory of arrays that are freed. A search builds a graph hundreds of times, and pages that the
/// system takes back and clears anew cost a tenth of its time.
void keep_freed_memory() {
  constexpr int kMebibyte = 1 << 20;
  (void)::mallopt(M_MMAP_THRESHOLD, 64 * kMebibyte);
  (void)::mallopt(M_TRIM_THRESHOLD, 256 * kMebibyte);
}

}  // namespace
}  // namespace waymark::program

int main(int argc, char** argv) {
  waymark::program::keep_freed_memory();
  std::set_terminate(waymark::program::on_terminate);
  waymark::program::install_signal_handlers();
  return waymark::program::run(argc, argv);
}
