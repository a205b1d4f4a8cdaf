// Input that was made to harm: it is refused as bad input, with little memory and in little time, and
// nothing of it steers the terminal.
#include <sys/stat.h>
#include <algorithm>

#include <catch2/catch.hpp>

#include <waymark/core/base/detail/address_sanitizer.hpp>

#include "program/support/program.hpp"
#include "support/paths.hpp"
#include "support/skip.hpp"

namespace untrusted_input_test {

namespace {

std::string repeated(const std::string& text, std::size_t count) {
  std::string all;
  for (std::size_t i = 0; i < count; ++i) all += text;
  return all;
}

/// Runs the program with a limit on its address space.
RunResult run_within(int megabytes, const std::string& arguments, const std::string& folder) {
  const std::string program =
      "ulimit -v " + std::to_string(megabytes * 1024) + "; exec timeout 60 \"$0\" " + arguments;
  return run({"-c", program, waymark_test::program_path()}, {.folder = folder, .program = "/bin/sh"});
}

}  // namespace

TEST_CASE("untrusted: JSON that is nested without end is refused with its place") {
  const std::string folder = fresh_folder();
  write_text(folder + "metrics.json", "{\"schema\":" + repeated("[", 150'000) + repeated("]", 150'000) + "}");
  check_refused(run({"compare", folder, "-o", folder + "out"}), 3,
                "metrics.json:1:110: lists and objects are nested more than 100 deep");
}

TEST_CASE("untrusted: a number beyond all doubles in JSON is bad input") {
  const std::string folder = fresh_folder();
  write_text(folder + "metrics.json", "{\"schema\": \"waymark-metrics\", \"version\": 1e999}");
  check_refused(run({"compare", folder, "-o", folder + "out"}), 3,
                "metrics.json: is no JSON: number overflow parsing '1e999'");
}

TEST_CASE("untrusted: a name longer than any file's is bad input, wherever it stands") {
  const std::string folder = fresh_folder();
  const std::string name(300, 'x');
  write_text(folder + "drive.yaml", "odometry: {file: " + name + ".csv}\ngnss: {file: " + name + ".csv}\n");
  for (const std::vector<std::string>& command : {std::vector<std::string>{"run", "drive.yaml", "-o", "out"},
                                                  {"inspect", "drive.yaml"},
                                                  {"inspect", name},
                                                  {"check", name},
                                                  {"doctor", "drive.yaml"},
                                                  {"check", "--plugin", name, "drive.yaml"}}) {
    const RunResult result = run(command, {.folder = folder});
    INFO(command.front() << result.err);
    CHECK((result.code == 3 || result.code == 2));
    CHECK_FALSE(contains(result.err, "internal error"));
  }
}

TEST_CASE("untrusted: endless devices are refused by what they begin with") {
  if (waymark::detail::kAddressSanitized)
    return waymark_test::skip("AddressSanitizer needs the address space that is limited here");
  for (const char* command :
       {"check", "inspect", "doctor", "sync", "evaluate", "run -o out", "convert -o out.graph"}) {
    for (const char* device : {"/dev/zero", "/dev/urandom"}) {
      const RunResult result = run_within(900, std::string(command) + " " + device, fresh_folder());
      INFO(command << " " << device << "\n" << result.err);
      CHECK(result.code == 3);
    }
  }
}

TEST_CASE("untrusted: SIGTERM ends the wait for the writer of a pipe") {
  const std::string folder = fresh_folder();
  const std::string pipe = folder + "pipe";
  REQUIRE(::mkfifo(pipe.c_str(), 0600) == 0);
  for (const char* command : {"check", "inspect"}) {
    const RunResult result = run(
        {"--preserve-status", "-k", "20", "-s", "TERM", "0.5", waymark_test::program_path(), command, pipe},
        {.program = "/usr/bin/timeout"});
    INFO(command << result.err);
    CHECK(result.code == 130);
    CHECK(contains(result.err, "interrupted before there was a result"));
  }
}

TEST_CASE("untrusted: nothing from outside steers the terminal") {
  const std::string folder = fresh_folder();
  const std::string evil =
      "\x1b]0;title\x07\x1b[2J\xc2\x9b"
      "31m\x7f";
  write_text(folder + "a.yaml", "name: \"" + std::string("\\e[2J\\a\\x9b") +
                                    "\"\nodometry: {file: \"\\e]0;x\\a.csv\"}\n"
                                    "gnss: {file: b.csv}\n\"\\e[2J\": 1\n");
  write_text(folder + evil + ".graph", "VERTEX_SE2 0 0 0 0\nEDGE\x1b[2J 0 0\n");
  write_text(folder + "metrics.json", "{\"schema\": \"\\u001b[2J\\u009b\"}");
  write_text(folder + "types.graph", "GRAPH 1\nTYPE \x1b[2J vertices=VERTEX_SE2\nVERTEX_SE2 0 0 0 0\n");
  for (const std::vector<std::string>& command :
       {std::vector<std::string>{"doctor", "a.yaml", evil + ".graph", "types.graph"},
        {"check", evil + ".graph"},
        {"check", "types.graph"},
        {"compare", ".", "-o", "out"},
        {"run", "a.yaml", "-o", "out"},
        {"run", evil, "-o", "out"},
        {"check", "types.graph", "--plugin", "./" + evil + ".graph"},
        {"doctor", "--json", evil + ".graph"}}) {
    const RunResult result = run(command, {.folder = folder});
    const std::string shown = result.out + result.err;
    INFO(command.front());
    CHECK(result.code >= 2);
    CHECK(std::none_of(shown.begin(), shown.end(), [](char c) {
      const auto byte = static_cast<unsigned char>(c);
      return (byte < 0x20 && c != '\n' && c != '\t') || byte == 0x7f;
    }));
    CHECK_FALSE(contains(shown, "\xc2\x9b"));
  }
}

}  // namespace untrusted_input_test
