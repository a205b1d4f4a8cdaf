// `waymark optimize` and `waymark check`: their inputs, outputs and exit codes.
#include <cmath>
#include <map>
#include <sstream>

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include <sys/stat.h>
#include <unistd.h>

#include "program/support/material.hpp"
#include "program/support/program.hpp"

#include "support/skip.hpp"

namespace optimize_test {

TEST_CASE("optimize: a graph is optimised, and the optimum is read again") {
  const std::string folder = fresh_folder();
  const std::string input = write_text(folder + "a.graph", square_graph());
  const RunResult first = run({"optimize", input, "-o", folder + "b.graph"});
  CHECK(first.code == 0);
  CHECK(contains(first.out, "converged: "));
  CHECK(first.err.empty());
  CHECK(names_in(folder) == std::vector<std::string>{"a.graph", "b.graph"});
  const RunResult again = run({"optimize", folder + "b.graph", "-o", folder + "c.graph", "--json"});
  const auto json = nlohmann::json::parse(again.out);
  CHECK(json.at("converged") == true);
  CHECK(json.at("iterations") <= 1);
  CHECK(contains(read_text(folder + "b.graph"), "\nPROVENANCE optimized waymark "));
  CHECK_FALSE(contains(read_text(folder + "b.graph"), "solver  "));  // guards against an empty name there
}

TEST_CASE("optimize: no convergence: exit 4, the result is written and said to be no minimum") {
  const std::string folder = fresh_folder();
  const std::string input = write_text(folder + "a.graph", square_graph());
  const RunResult result = run({"optimize", input, "-o", folder + "b.graph", "--max-iterations", "1"});
  CHECK(result.code == 4);
  CHECK(contains(result.err, "warning: no minimum was reached: not converged after 1 iterations"));
  CHECK(contains(result.out, "written     " + folder + "b.graph"));
  CHECK(contains(read_text(folder + "b.graph"), "max_iterations"));
  CHECK(run({"check", folder + "b.graph"}).code == 0);
  CHECK(run({"optimize", input, "-o", folder + "q.graph", "--max-iterations", "1", "--quiet"}).code == 4);
}

TEST_CASE("optimize: bad graphs: exit 3, place and reason, and nothing is written") {
  struct Case {
    const char* text;
    const char* message;
  };
  const Case cases[] = {
      {"", "bad.graph: no vertices in it"},
      {"GRAPH 1\nVERTEX_SE2 0 0 0\n",
       "bad.graph:2:17: VERTEX_SE2: expected a number for 'heading', got the end of"},
      {"GRAPH 1\nVERTEX_SE2 0 0 nan 0\n",
       "bad.graph:2:16: VERTEX_SE2: expected a finite number for 'y', got 'nan'"},
      {"GRAPH 1\nVERTEX_SE2 0 0 0 0 0\n",
       "bad.graph:2:20: VERTEX_SE2: expected the end of the line, got '0'"},
      {"GRAPH 1\nVERTEX_SE2 0 0 0 0\nVERTEX_SE2 0 1 0 0\n",
       "bad.graph:3:12: VERTEX_SE2: vertex 0 is defined a second"},
      {"GRAPH 1\nVERTEX_SE2 0 0 0 0\nEDGE_SE2 0 1 1 0 0 1 0 0 1 0 1\n",
       "bad.graph:3:12: EDGE_SE2: vertex 1 is not"},
      {"GRAPH 1\nVERTEX_SE2 0 0 0 0\nVERTEX_SE2 1 0 0 0\nEDGE_SE2 0 1 1 0 0 1 0 0 1 0\n", "'information[5]'"},
      {"GRAPH 3\n", "bad.graph:1:7: GRAPH: version 3 is not known to this program, which reads version 1"},
      {"\x7f"
       "ELF\x1b[2J\n",
       "bad.graph:1:1: unknown tag '\\x7fELF\\x1b[2J'"},
      {"GRAPH 1\nVERTEX_SE2 0 0 0 0\nVERTEX_XY 1 1 1\nEDGE_BEARING_SE2_XY 0 1 0.7 1\nFIX 0\n",
       "anchored in only 1 of 2 rigid motions"},
  };
  const std::string folder = fresh_folder();
  for (const Case& c : cases) {
    write_text(folder + "bad.graph", c.text);
    check_refused(run({"optimize", "bad.graph", "-o", "out.graph"}, {.folder = folder}), 3, c.message);
    CHECK(names_in(folder) == std::vector<std::string>{"bad.graph"});
    CHECK(run({"check", "bad.graph"}, {.folder = folder}).code == 3);
  }
}

TEST_CASE("optimize: a part with one fix keeps a heading, and the other parts are as they are without it") {
  const std::string folder = fresh_folder();
  const std::string one_fix =
      "VERTEX_SE2 100 9 9 0.25\nVERTEX_SE2 101 0 0 0\nEDGE_SE2 100 101 1 0 0 100 0 0 100 0 100\n"
      "EDGE_PRIOR_SE2_XY 101 5 6 4 0 4\n";
  write_text(folder + "a.graph", square_graph() + one_fix);
  const RunResult result = run({"optimize", "a.graph", "-o", "b.graph"}, {.folder = folder});
  CHECK(result.code == 0);
  CHECK(contains(result.err, "heading of vertex 100 is held at its present value"));
  std::istringstream lines(read_text(folder + "b.graph"));
  std::map<std::string, std::vector<double>> poses;
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string tag;
    std::string id;
    words >> tag >> id;
    if (tag != "VERTEX_SE2") continue;
    for (double x = 0; words >> x;) poses[id].push_back(x);
  }
  CHECK(poses.at("100").at(2) == Approx(0.25));
  CHECK(poses.at("101").at(0) == Approx(5));
  CHECK(poses.at("101").at(1) == Approx(6));
  CHECK(poses.at("100").at(0) == Approx(5 - std::cos(0.25)));
  CHECK(poses.at("100").at(1) == Approx(6 - std::sin(0.25)));
}

TEST_CASE("optimize: files that cannot be read say why") {
  const std::string folder = fresh_folder();
  const RunResult missing = run({"optimize", "none.graph", "-o", "out.graph"}, {.folder = folder});
  CHECK(missing.code == 3);
  CHECK(missing.err == "waymark: error: none.graph: cannot read: No such file or directory\n");
  const RunResult is_folder = run({"check", folder});
  CHECK(is_folder.code == 3);
  CHECK(contains(is_folder.err, "cannot read: Is a directory"));
}

TEST_CASE("optimize: a file without permission to read says so") {
  if (::geteuid() == 0) {
    waymark_test::skip("root may read everything");
    return;
  }
  const std::string input = write_text(fresh_folder() + "a.graph", square_graph());
  ::chmod(input.c_str(), 0);
  const RunResult result = run({"check", input});
  CHECK(result.code == 3);
  CHECK(contains(result.err, "cannot read: Permission denied"));
}

TEST_CASE("optimize: lenient reading skips, counts and shows") {
  const std::string folder = fresh_folder();
  const std::string input = write_text(folder + "a.graph", square_graph() + "NOISE 1\nVERTEX_SE2 0 0 0 0\n");
  CHECK(run({"optimize", input, "-o", folder + "b.graph"}).code == 3);
  const RunResult result = run({"optimize", input, "-o", folder + "b.graph", "--lenient"});
  CHECK(result.code == 0);
  CHECK(contains(result.err, "warning: 2 lines were skipped; the first ones:\n"));
  CHECK(contains(result.err, "a.graph:11:1: unknown tag 'NOISE'"));
}

TEST_CASE("optimize: g2o is written as asked, and refused before the work where it cannot hold the graph") {
  const std::string folder = fresh_folder();
  const std::string input = write_text(folder + "a.graph", square_graph());
  const RunResult result = run({"optimize", input, "-o", folder + "b.g2o", "--format", "g2o"});
  CHECK(result.code == 0);
  CHECK(read_text(folder + "b.g2o").rfind("VERTEX_SE2 0 0 0 0\n", 0) == 0);
  CHECK(run({"optimize", folder + "b.g2o", "-o", folder + "c.graph"}).code == 0);

  write_text(folder + "robust.graph", square_graph() + "LOSS huber 1\n");
  const RunResult refused =
      run({"optimize", folder + "robust.graph", "-o", folder + "r.g2o", "--format", "g2o", "-v"});
  CHECK(refused.code == 3);
  CHECK(contains(refused.err, "(number 4): the g2o format has no robust losses; write --format graph"));
  CHECK_FALSE(exists(folder + "r.g2o"));
}

TEST_CASE("optimize: a file of edges only is started along its chain, and that is said") {
  const std::string folder = fresh_folder();
  const std::string edges = "EDGE_SE2 0 1 1 0 0 1 0 0 1 0 1\nEDGE_SE2 1 2 1 0 0 1 0 0 1 0 1\n";
  const std::string input = write_text(folder + "a.g2o", edges);
  const RunResult result = run({"optimize", input, "-o", folder + "b.graph"});
  CHECK(result.code == 0);
  CHECK(contains(result.err, "note: the file has only edges; the initial guess is the odometry chain\n"));
  CHECK(contains(read_text(folder + "b.graph"), "VERTEX_SE2 2 2 0 0\n"));
  const std::string apart = write_text(folder + "apart.g2o", edges + "EDGE_SE2 7 8 1 0 0 1 0 0 1 0 1\n");
  CHECK(contains(run({"optimize", apart, "-o", folder + "c.graph"}).err,
                 "note: 2 vertices are not joined to the first"));
}

TEST_CASE("optimize: a TORO file is read if asked for, and never guessed") {
  const std::string folder = fresh_folder();
  const std::string input =
      write_text(folder + "a.graph", "VERTEX2 0 0 0 0\nVERTEX2 1 9 9 0\nEDGE2 0 1 1 0 0 4 1 2 3 0 0\n");
  const RunResult guessed = run({"optimize", input, "-o", folder + "b.graph"});
  CHECK(guessed.code == 3);
  CHECK(contains(guessed.err, "name the format: --input-format toro"));
  CHECK(run({"optimize", input, "-o", folder + "b.graph", "--input-format", "toro"}).code == 0);
  CHECK(contains(read_text(folder + "b.graph"), "EDGE_SE2 0 1 1 0 0 4 1 0 2 0 3\n"));
}

TEST_CASE("optimize: the start is chosen, and what was chosen is said") {
  // The square's corners lie on one heap in the file: any start that reads the edges is exact.
  const std::string folder = fresh_folder();
  const std::string edges =
      "EDGE_SE2 0 1 1 0 1.5707963267948966 1 0 0 1 0 1\nEDGE_SE2 1 2 1 0 1.5707963267948966 1 0 0 1 0 1\n"
      "EDGE_SE2 2 3 1 0 1.5707963267948966 1 0 0 1 0 1\nEDGE_SE2 3 0 1 0 1.5707963267948966 1 0 0 1 0 1\n";
  std::string text;
  for (const char* id : {"0", "1", "2", "3"}) text += "VERTEX_SE2 " + std::string(id) + " 0 0 0\n";
  const std::string input = write_text(folder + "a.g2o", text + edges);
  for (const std::string start : {"linear", "spanning_tree", "odometry"}) {
    const RunResult result = run({"optimize", input, "-o", folder + "b.graph", "--start", start, "--json"});
    INFO(start << result.err);
    CHECK(result.code == 0);
    const auto json = nlohmann::json::parse(result.out);
    CHECK(json.at("start") == start);
    CHECK(json.at("initial_chi2") < 1e-20);
  }
  const RunResult by_default = run({"optimize", input, "-o", folder + "b.graph", "--json"});
  const auto json = nlohmann::json::parse(by_default.out);
  CHECK(json.at("starts").at(0).at("start") == json.at("start"));
  CHECK(json.at("final_chi2") < 1e-12);
  const RunResult as_is = run({"optimize", input, "-o", folder + "b.graph", "--start", "file", "--json"});
  CHECK(nlohmann::json::parse(as_is.out).at("initial_chi2") > 1);
  const RunResult unknown = run({"optimize", input, "-o", folder + "c.graph", "--start", "best"});
  CHECK(unknown.code == 2);
  CHECK(
      unknown.err ==
      "waymark: error: unknown initial guess 'best'; there are: auto, file, linear, spanning_tree, odometry\n");
  const std::string alone = write_text(folder + "alone.g2o", "VERTEX_SE2 0 0 0 0\n");
  const RunResult none = run({"optimize", alone, "-o", folder + "c.graph", "--start", "odometry"});
  CHECK(none.code == 3);
  CHECK(contains(none.err,
                 "initial guess odometry cannot be made: no edge gives the motion from one pose to another"));
  CHECK_FALSE(exists(folder + "c.graph"));
}

TEST_CASE("optimize: check names what is wrong with a graph, up to ten lines of it") {
  const std::string folder = fresh_folder();
  const RunResult good = run({"check", write_text(folder + "a.graph", square_graph())});
  CHECK(good.code == 0);
  CHECK(contains(good.out, "4 vertices, 4 edges"));
  CHECK(contains(good.out, "no problems found\n"));
  std::string text = square_graph();
  for (int i = 0; i < 13; ++i) text += "NOISE\n";
  const RunResult bad = run({"check", write_text(folder + "b.graph", text)});
  CHECK(bad.code == 3);
  CHECK(contains(bad.out, "problem: " + folder + "b.graph:11:1: unknown tag 'NOISE'"));
  CHECK(contains(bad.out, "problem: 3 more wrong lines\n"));
}

TEST_CASE("optimize: bytes that are no UTF-8 do not break json") {
  // Guards against the JSON library's exception, which was an internal error.
  const std::string folder = fresh_folder();
  write_text(folder + "\xff.graph", square_graph());
  const RunResult result = run({"check", "\xff.graph", "--json"}, {.folder = folder});
  CHECK(result.code == 0);
  CHECK(nlohmann::json::accept(result.out));
}

}  // namespace optimize_test
