// `waymark optimize` with robust losses and the search for outliers.
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "program/support/material.hpp"
#include "program/support/program.hpp"

namespace robust_test {

namespace {

/// A straight chain with exact shortcuts, and one false closure from end to end.
std::string chain_with_a_false_closure() {
  const auto edge = [](int from, int to, double x) {
    return "EDGE_SE2 " + std::to_string(from) + " " + std::to_string(to) + " " + std::to_string(x) +
           " 0 0 100 0 0 100 0 1000\n";
  };
  std::string text = "GRAPH 1\n";
  constexpr int kPoses = 30;
  for (int i = 0; i < kPoses; ++i)
    text += "VERTEX_SE2 " + std::to_string(i) + " " + std::to_string(i) + " 0 0\n";
  for (int i = 0; i + 1 < kPoses; ++i) text += edge(i, i + 1, 1);
  for (int i = 0; i + 5 < kPoses; i += 3) text += edge(i, i + 5, 5);
  return text + edge(2, 27, 0.5);
}

constexpr const char* kFalseLine = "EDGE_SE2 2 27 0.5 0 0 100 0 0 100 0 1000\n";

}  // namespace

TEST_CASE("robust: gnc finds a false closure, writes it and leaves it out of the result") {
  const std::string folder = fresh_folder();
  const std::string input = write_text(folder + "a.graph", chain_with_a_false_closure());
  const RunResult result = run(
      {"optimize", input, "-o", folder + "b.graph", "--robust", "gnc", "--outliers", folder + "false.txt"});
  INFO(result.err);
  CHECK(result.code == 0);
  CHECK(contains(result.out, "outliers    1 of 10 edges that are not trusted (gnc: "));
  CHECK(read_text(folder + "false.txt") == kFalseLine);
  const std::string written = read_text(folder + "b.graph");
  CHECK_FALSE(contains(written, "EDGE_SE2 2 27 "));
  CHECK(contains(written, "\nPROVENANCE outliers 1 edges left out by gnc\n"));
  // The remaining edges are exact, so they fit without any error.
  const RunResult again = run({"optimize", folder + "b.graph", "-o", folder + "c.graph", "--json"});
  CHECK(nlohmann::json::parse(again.out).at("initial_chi2") < 1e-12);
}

TEST_CASE("robust: gnc says the same in JSON, and to the standard output where asked") {
  const std::string folder = fresh_folder();
  const std::string input = write_text(folder + "a.graph", chain_with_a_false_closure());
  const RunResult result = run({"optimize", input, "-o", folder + "b.graph", "--robust", "gnc", "--json"});
  const auto json = nlohmann::json::parse(result.out).at("graduation");
  CHECK(json.at("outliers") == 1);
  CHECK(json.at("candidates") == 10);
  CHECK(json.at("outlier_edges")[0].at("type") == "EDGE_SE2");
  CHECK(json.at("outlier_edges")[0].at("vertices") == nlohmann::json({2, 27}));
  const RunResult lines =
      run({"optimize", input, "-o", folder + "b.graph", "--robust", "gnc", "--outliers", "-"});
  CHECK(lines.out == kFalseLine);
}

TEST_CASE("robust: who is trusted is the user's choice") {
  const std::string folder = fresh_folder();
  const std::string input = write_text(folder + "a.graph", chain_with_a_false_closure());
  const RunResult none =
      run({"optimize", input, "-o", folder + "b.graph", "--robust", "gnc", "--trusted", "none"});
  CHECK(contains(none.out, " of 39 edges that are not trusted"));
  const RunResult all =
      run({"optimize", input, "-o", folder + "b.graph", "--robust", "gnc", "--trusted", "EDGE_SE2"});
  CHECK(contains(all.out, "outliers    0 of 0 edges"));
}

TEST_CASE("robust: where no chain follows the ids, nothing is trusted, and the remedy is told") {
  const std::string folder = fresh_folder();
  std::string text = "GRAPH 1\n";
  constexpr int kPoses = 60;
  const auto id = [](int i) { return std::to_string(i * 17 % kPoses); };  // neighbours are 17 apart
  for (int i = 0; i < kPoses; ++i) text += "VERTEX_SE2 " + id(i) + " " + std::to_string(i) + " 0 0\n";
  for (int i = 0; i + 1 < kPoses; ++i)
    text += "EDGE_SE2 " + id(i) + " " + id(i + 1) + " 1 0 0 100 0 0 100 0 1000\n";
  const std::string input = write_text(folder + "a.graph", text);
  const RunResult result = run({"optimize", input, "-o", folder + "b.graph", "--robust", "gnc"});
  CHECK(contains(result.out, " of 59 edges that are not trusted"));
  CHECK(contains(result.err, "no edge is trusted as odometry"));
  CHECK(contains(result.err, "--trusted TAG"));
  const RunResult none =
      run({"optimize", input, "-o", folder + "b.graph", "--robust", "gnc", "--trusted", "none"});
  CHECK_FALSE(contains(none.err, "no edge is trusted"));
}

TEST_CASE("robust: losses are given to the edges that are not trusted, and written") {
  const std::string folder = fresh_folder();
  const std::string input = write_text(folder + "a.graph", chain_with_a_false_closure());
  const RunResult result =
      run({"optimize", input, "-o", folder + "b.graph", "--loss", "EDGE_SE2=cauchy:1.5"});
  CHECK(result.code == 0);
  const std::string written = read_text(folder + "b.graph");
  CHECK(contains(written, "EDGE_SE2 2 27 0.5 0 0 100 0 0 100 0 1000\nLOSS cauchy 1.5\n"));
  CHECK_FALSE(contains(written, "EDGE_SE2 2 3 1 0 0 100 0 0 100 0 1000\nLOSS"));
}

TEST_CASE("robust: wrong losses, tags and combinations are refused before anything is read") {
  struct Case {
    std::vector<std::string> options;
    const char* message;
  };
  const Case cases[] = {
      {{"--loss", "hubert:1"}, "--loss: unknown loss 'hubert'; did you mean 'huber'?"},
      {{"--loss", "huber"}, "--loss: expected [TAG=]NAME:SCALE with a scale above 0, got 'huber'"},
      {{"--loss", "huber:-1"}, "with a scale above 0, got 'huber:-1'"},
      {{"--loss", "huber:1x"}, "with a scale above 0, got 'huber:1x'"},
      {{"--loss", "EDGE_SE3=huber:1"}, "--loss: unknown edge type 'EDGE_SE3'; did you mean 'EDGE_SE2'?"},
      {{"--robust", "gnc", "--loss", "EDGE_SE2=huber:1"}, "--robust gnc takes one loss for all edges"},
      {{"--trusted", "EDGE_SE3"}, "--trusted: unknown edge type 'EDGE_SE3'"},
      {{"--outliers", "x"}, "--outliers needs --robust gnc, which looks for them"},
  };
  for (const Case& c : cases) {
    std::vector<std::string> arguments = {"optimize", "none.graph", "-o", "out.graph"};
    arguments.insert(arguments.end(), c.options.begin(), c.options.end());
    const RunResult result = run(arguments);
    INFO(c.message << "\n" << result.err);
    CHECK(result.code == 2);
    CHECK(contains(result.err, c.message));
  }
}

}  // namespace robust_test
