// The program on a terminal: progress, colours, widths. In a pipe there is nothing of these.
#include <algorithm>

#include <catch2/catch.hpp>

#include <waymark/tools/program/terminal/progress.hpp>

#include "program/support/material.hpp"
#include "program/support/terminal.hpp"

namespace terminal_test {

using waymark::program::duration_text;
using waymark::program::iteration_progress;
using waymark::program::ProgressMeter;
using waymark::program::reading_line;
using waymark::program::remaining_text;

namespace {

constexpr const char* kEscape = "\033";

std::vector<std::string> run_drive(const std::string& folder) {
  return {"run", bundled_drive(), "--out", folder + "results", "-m", "g1"};
}

bool any_contains(const std::vector<std::string>& lines, const std::string& part) {
  return std::any_of(lines.begin(), lines.end(),
                     [&](const std::string& line) { return contains(line, part); });
}

std::size_t widest(const std::vector<std::string>& lines) {
  std::size_t width = 0;
  for (const std::string& line : lines) width = std::max(width, line.size());
  return width;
}

}  // namespace

TEST_CASE("terminal: rate and remaining time are of the mean rate so far") {
  double now_s = 100;
  waymark::program::ProgressMeter meter([&] { return now_s; });
  meter.update(0, 900e6);
  CHECK_FALSE(meter.rate());
  now_s = 102;
  meter.update(300e6, 900e6);
  CHECK(*meter.rate() == Approx(150e6));
  CHECK(*meter.remaining_s() == Approx(4));  // 600 MB at 150 MB/s
  CHECK(waymark::program::reading_line("candump.log.gz", 300'000'000, 900'000'000, meter) ==
        "reading candump.log.gz  300 of 900 MB  33 %  150 MB/s  4 s left");

  SECTION("other work begins anew") {
    meter.restart();
    now_s = 104;
    meter.update(1, 4);
    CHECK(*meter.remaining_s() == Approx(6));
    CHECK(remaining_text(meter) == "  6 s left");
  }
  SECTION("of what has no known end the rate alone is told") {
    now_s = 103;
    meter.restart();
    now_s = 105;
    meter.update(9);
    CHECK_FALSE(meter.remaining_s());
    CHECK(remaining_text(meter).empty());
    CHECK(waymark::program::iteration_progress(9, 538.3, meter) ==
          "iteration 9  chi2 538.3  4.5 iterations/s");
    CHECK(waymark::program::reading_line("pipe", 2'500'000, 0, meter) == "reading pipe  2 MB  0 MB/s");
  }
}

TEST_CASE("terminal: nothing is foretold from the first moments") {
  double now_s = 0;
  waymark::program::ProgressMeter meter([&] { return now_s; });
  now_s = 0.1;
  meter.update(1, 1000);
  CHECK_FALSE(meter.rate());
  CHECK_FALSE(meter.remaining_s());
  now_s = waymark::program::ProgressMeter::kEarliest_s;
  meter.update(0, 1000);  // nothing done: no rate, and no division by zero
  CHECK_FALSE(meter.remaining_s());
}

TEST_CASE("terminal: a line is due at once and then ten times a second") {
  double now_s = 0;
  waymark::program::ProgressMeter meter([&] { return now_s; });
  int lines = 0;
  for (int millisecond = 0; millisecond < 1000; ++millisecond) {
    now_s = 1e-3 * millisecond;
    meter.update(millisecond);
    if (meter.due()) ++lines;
  }
  CHECK(lines == 10);
}

TEST_CASE("terminal: durations are read at a glance and never too short") {
  CHECK(waymark::program::duration_text(0.2) == "1 s");
  CHECK(waymark::program::duration_text(59) == "59 s");
  CHECK(waymark::program::duration_text(129.1) == "2:10");
  CHECK(waymark::program::duration_text(3600) == "1:00:00");
  CHECK(waymark::program::duration_text(3729.5) == "1:02:10");
}

TEST_CASE("terminal: progress stands in one line of the terminal and leaves nothing behind") {
  for (const unsigned columns : {30U, 80U, 120U}) {
    const std::string folder = fresh_folder();
    const RunResult result = run_on({.columns = columns, .out_in_pipe = true}, run_drive(folder));
    INFO(columns << "\n" << result.err);
    CHECK(result.code == 0);
    const auto shown = shown_in(result.err);
    CHECK(any_contains(shown, "reading odometry"));
    CHECK(any_contains(shown, "iteration 1"));
    const auto screen = screen_of(result.err);
    for (const char* progress : {"reading", "iteration", "start and noise", "covariances"})
      CHECK_FALSE(any_contains(screen, progress));
    for (const std::string& line : shown) {
      const bool sentence = contains(line, "note:") || contains(line, "warning:");
      if (!sentence) CHECK(line.size() < columns);
    }
  }
}

TEST_CASE("terminal: an error stands alone, where progress was") {
  const std::string folder = fresh_folder();
  write_drive(folder);
  write_text(folder + "gnss.csv", "time,latitude\n1,2\n");
  const RunResult result = run_on({}, {"run", folder + "drive.yaml", "--out", folder + "results"});
  CHECK(result.code == 3);
  CHECK(any_contains(shown_in(result.err), "reading odometry.csv"));
  const auto screen = screen_of(result.err);
  INFO(result.err);
  REQUIRE_FALSE(screen.empty());
  CHECK(screen.front().rfind("waymark: error: ", 0) == 0);
  CHECK(contains(result.err, "\033[1;31merror:\033[0m"));
}

TEST_CASE("colours: on a terminal, headings bold, what is better green and what is worse red") {
  const std::string folder = fresh_folder();
  const RunResult result = run_on({.columns = 120}, run_drive(folder));
  CHECK(contains(result.err, "\033[1magainst truth\033[0m"));
  CHECK(contains(result.err, "\033[32m60.81\033[0m"));  // Max: 19.410 m raw, 7.607 m fused
  CHECK(contains(result.err, "\033[31m-5.67\033[0m"));  // median: 3.025 m raw, 3.197 m fused
  CHECK(contains(result.err, "\033[2mnote:\033[0m "));
}

TEST_CASE("terminal: colours are off with NO_COLOR, and a dumb terminal gets no escape at all") {
  const std::string folder = fresh_folder();
  // https://no-color.org: "when present and not an empty string (regardless of its value)"
  for (const char* value : {"1", "0", "no"}) {
    const RunResult plain =
        run_on({.environment = {{"TERM", "xterm"}, {"NO_COLOR", value}}}, run_drive(folder));
    CHECK_FALSE(contains(plain.err, "\033[1m"));
    CHECK_FALSE(contains(plain.err, "\033[2m"));
    CHECK_FALSE(contains(plain.err, "\033[3"));
    CHECK(any_contains(shown_in(plain.err), "reading"));  // progress is no colour
  }
  const RunResult empty = run_on({.environment = {{"TERM", "xterm"}, {"NO_COLOR", ""}}}, run_drive(folder));
  CHECK(contains(empty.err, "\033[1m"));
  const RunResult dumb = run_on({.environment = {{"TERM", "dumb"}}}, run_drive(folder));
  CHECK(dumb.code == 0);
  CHECK_FALSE(contains(dumb.err, kEscape));
  CHECK_FALSE(contains(dumb.err, "\r"));
}

TEST_CASE("terminal: stdout and stderr are judged separately") {
  const std::string folder = fresh_folder();
  const RunResult result = run_on({.columns = 60, .out_in_pipe = true}, run_drive(folder));
  CHECK(contains(result.err, "\033[2mnote:\033[0m"));
  CHECK_FALSE(contains(result.out, kEscape));
  // A pipe has no width: the table is one.
  CHECK(contains(result.out,
                 "against truth         n  Max [m]  Acc [m]  Prec [m]  RMSE [m]  median [m]  CEP50 [m]"));
}

TEST_CASE("terminal: quiet is quiet on a terminal too") {
  const std::string folder = fresh_folder();
  std::vector<std::string> arguments = run_drive(folder);
  arguments.emplace_back("--quiet");
  const RunResult result = run_on({}, arguments);
  CHECK(result.code == 0);
  CHECK(result.err.empty());
}

TEST_CASE("terminal: tables fit the terminal, each part with its first column") {
  const std::string folder = fresh_folder();
  REQUIRE(run(run_drive(folder)).code == 0);
  for (const unsigned columns : {80U, 120U}) {
    const RunResult result = run_on(
        {.columns = columns}, {"evaluate", folder + "results/g1.fused.graph", "--truth", bundled_drive()});
    INFO(result.err);
    CHECK(widest(screen_of(result.err)) <= columns);
  }
}

TEST_CASE("terminal: steps of the optimizer stand in columns under one heading for each optimisation") {
  const std::string folder = fresh_folder();
  const std::string graph = write_text(folder + "a.graph", square_graph());
  const RunResult result = run({"optimize", graph, "-o", folder + "b.graph", "--start", "file", "-v"});
  CHECK(result.code == 0);
  const auto lines = shown_in(result.err);
  const auto heading = std::find_if(lines.begin(), lines.end(),
                                    [](const std::string& line) { return contains(line, "time [s]"); });
  REQUIRE(heading != lines.end());
  CHECK(std::count_if(lines.begin(), lines.end(),
                      [](const std::string& l) { return contains(l, "time [s]"); }) == 1);
  for (auto line = heading + 1; line != lines.end() && !contains(*line, ":"); ++line)
    CHECK(line->size() == heading->size());
  CHECK(heading->size() <= 80);
}

}  // namespace terminal_test
