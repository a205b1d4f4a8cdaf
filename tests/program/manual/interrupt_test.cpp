// Ctrl-C: the state reached is kept and marked as unfinished; the exit code is the shell's 130.
#include <chrono>
#include <csignal>
#include <thread>
#include <utility>

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "program/support/material.hpp"
#include "program/support/program.hpp"
#include "support/paths.hpp"

namespace interrupt_test {

namespace {

/// A minimisation of thousands of steps: damping holds every one back, and no tolerance ends it.
std::vector<std::string> slowly(std::vector<std::string> arguments) {
  for (const char* option :
       {"-v", "-a", "levenberg_marquardt", "--algorithm-option", "scaling=identity", "--algorithm-option",
        "initial_damping=1e6", "--tolerance", "1e-300", "--max-iterations", "1000000"}) {
    arguments.emplace_back(option);
  }
  return arguments;
}

const std::string kKept = "; the best state so far is kept\n";

/// Runs `optimize` on a pipe and sends it signals before the last line comes.
RunResult interrupted_while_reading(const std::string& folder, int signal, int times) {
  const std::string pipe = folder + "a.graph";
  REQUIRE(::mkfifo(pipe.c_str(), 0600) == 0);
  std::thread writer([&] {
    const int descriptor = ::open(pipe.c_str(), O_WRONLY);  // waits until the program reads
    const std::string text = square_graph();
    CHECK(::write(descriptor, text.data(), text.size()) == static_cast<ssize_t>(text.size()));
    // The shell that runs the program wrote its process id.
    const auto process = static_cast<pid_t>(std::stol(read_text(folder + "pid")));
    for (int i = 0; i < times; ++i) {
      ::kill(process, signal);
      std::this_thread::sleep_for(std::chrono::microseconds(200));  // or two pending ones are one
    }
    ::close(descriptor);
  });
  const RunResult result =
      run({"-c", "echo $$ > pid; exec \"$0\" optimize a.graph -o b.graph", waymark_test::program_path()},
          {.folder = folder, .program = "/bin/sh"});
  writer.join();
  return result;
}

}  // namespace

TEST_CASE("interrupt: an interrupted optimisation keeps the best state and says so") {
  const std::string folder = fresh_folder();
  write_text(folder + "a.graph", slow_graph(4000));
  const RunResult result =
      run(slowly({"optimize", "a.graph", "-o", "b.graph"}), {.interrupt_at = "\n   3  ", .folder = folder});
  INFO(result.err.substr(0, 400));
  CHECK(result.code == 130);
  CHECK(contains(result.err, "warning: no minimum was reached: interrupted after "));
  CHECK(contains(result.err, kKept));
  CHECK(contains(result.out, "written     b.graph"));
  CHECK(names_in(folder) == std::vector<std::string>{"a.graph", "b.graph"});
  CHECK(contains(read_text(folder + "b.graph").substr(0, 300), "interrupted"));
  const auto chi2 = [&](const char* name) {
    const RunResult checked = run({"check", name, "--json"}, {.folder = folder});
    CHECK(checked.code == 0);
    return nlohmann::json::parse(checked.out).at("edges").at(0).at("chi2").get<double>();
  };
  CHECK(chi2("b.graph") < chi2("a.graph"));
}

TEST_CASE("interrupt: an interrupted run keeps what it has and starts no further modeling") {
  const std::string folder = fresh_folder();
  const RunResult result = run(slowly({"run", bundled_drive(), "--out", folder + "results", "-m", "g1,g2"}),
                               {.interrupt_at = "\n   3  "});
  CHECK(result.code == 130);
  CHECK(contains(result.err, kKept));
  CHECK(contains(result.out, "NOT CONVERGED"));
  CHECK(exists(folder + "results/g1.fused.graph"));
  CHECK_FALSE(exists(folder + "results/g2.graph"));
  const auto summary = nlohmann::json::parse(read_text(folder + "results/summary.json"));
  CHECK(summary.at("g1").at("termination") == "interrupted");
  CHECK(nlohmann::json::accept(read_text(folder + "results/metrics.json")));
  for (const std::string& name : names_in(folder + "results")) CHECK_FALSE(contains(name, "partial"));
}

TEST_CASE("interrupt: interrupted while reading: nothing is written, and that is said") {
  // `timeout` of coreutils sends SIGTERM to its child and to the child's group: that is one request.
  for (const auto& [signal, times] : {std::pair{SIGINT, 1}, {SIGTERM, 1}, {SIGTERM, 5}}) {
    const std::string folder = fresh_folder();
    const RunResult result = interrupted_while_reading(folder, signal, times);
    INFO("signal " << signal << ", " << times << " times");
    CHECK(result.code == 130);
    CHECK(result.err == "waymark: error: interrupted before there was a result\n");
    CHECK(names_in(folder) == std::vector<std::string>{"a.graph", "pid"});
  }
}

}  // namespace interrupt_test
