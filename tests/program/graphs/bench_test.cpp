// `waymark bench`: the table, CSV and JSON of the same measurement, and its refusals.
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include <sstream>

#include "program/support/help.hpp"
#include "program/support/material.hpp"
#include "program/support/page_checks.hpp"
#include "program/support/program.hpp"
#include "support/paths.hpp"
#include "support/skip.hpp"

namespace bench_test {

using Json = nlohmann::json;

namespace {

/// Whether this program was built with Ceres; prints a note if it was not.
bool has_ceres() {
  const bool has = contains(run({"doctor"}).out, "Ceres");
  if (!has) waymark_test::skip("this program was built without Ceres (WAYMARK_WITH_CERES)");
  return has;
}

void check_cell(const Json& cell, int repetitions) {
  INFO(cell.dump());
  CHECK(cell.at("converged") == true);
  CHECK(cell.at("run_seconds").size() == static_cast<std::size_t>(repetitions));
  const double median = cell.at("median_seconds");
  CHECK(cell.at("min_seconds") <= median);
  CHECK(median <= cell.at("max_seconds"));
  double phases = 0;
  for (const char* phase : {"structure_seconds", "linearize_seconds", "solve_seconds", "rest_seconds"}) {
    CHECK(cell.at(phase) >= 0);
    phases += cell.at(phase).get<double>();
  }
  CHECK(phases <= median * (1 + 1e-9));
  if (!cell.at("memory_peak_mb").is_null()) {
    CHECK(cell.at("memory_peak_mb") >= cell.at("memory_before_mb"));
  }
}

}  // namespace

TEST_CASE("bench: measures algorithm x solver x start, in the order asked for") {
  const std::string folder = fresh_folder();
  const std::string input = write_text(folder + "a.graph", square_graph());
  const RunResult result = run({"bench", input, "-a", "dogleg,gauss_newton", "-s", "eigen", "--start",
                                "file,odometry", "--repeat", "3", "--json", "-o", folder + "out"});
  INFO(result.err);
  CHECK(result.code == 0);
  CHECK(result.err.empty());
  CHECK(names_in(folder + "out") ==
        std::vector<std::string>{"bench.csv", "bench.html", "bench.json", "figures"});
  CHECK(read_text(folder + "out/bench.json") == result.out);

  const Json json = Json::parse(result.out);
  CHECK(json.at("header").at("repetitions") == "3");
  const Json& file = json.at("files").at(0);
  CHECK(file.at("file") == "a.graph");
  CHECK(file.at("vertices") == 4);
  CHECK(file.at("edges") == 4);
  CHECK(file.at("optimum_source") == "lowest of this run");
  REQUIRE(file.at("cells").size() == 4);
  const char* expected[][2] = {
      {"file", "dogleg"}, {"file", "gauss_newton"}, {"odometry", "dogleg"}, {"odometry", "gauss_newton"}};
  for (std::size_t i = 0; i < 4; ++i) {
    const Json& cell = file.at("cells").at(i);
    CHECK(cell.at("start") == expected[i][0]);
    CHECK(cell.at("algorithm") == expected[i][1]);
    CHECK(cell.at("solver") == "eigen");
    CHECK(cell.at("optimality") == "reached");
    check_cell(cell, 3);
  }
}

TEST_CASE("bench: starts a file without vertices along its odometry, once") {
  const std::string folder = fresh_folder();
  write_text(folder + "edges.g2o", "EDGE_SE2 0 1 1 0 0 1 0 0 1 0 1\nEDGE_SE2 1 2 1 0 0 1 0 0 1 0 1\n");
  const RunResult result =
      run({"bench", folder + "edges.g2o", "--start", "file,odometry", "--repeat", "1", "--json"});
  CHECK(contains(result.err, "edges.g2o has edges only: its initial guess 'file' is the odometry chain"));
  const Json cells = Json::parse(result.out).at("files").at(0).at("cells");
  REQUIRE(cells.size() == 1);
  CHECK(cells.at(0).at("start") == "odometry");
}

TEST_CASE("bench: bench and optimize say the same of a graph") {
  const std::string folder = fresh_folder();
  const std::string input = write_text(folder + "a.graph", square_graph());
  const Json one = Json::parse(run({"optimize", input, "-o", folder + "b.graph", "--json"}).out);
  const Json json = Json::parse(run({"bench", input, "--repeat", "1", "--json"}).out);
  const Json& cell = json.at("files").at(0).at("cells").at(0);
  CHECK(cell.at("iterations") == one.at("iterations"));
  CHECK(cell.at("chi2") == one.at("final_chi2"));
  CHECK(cell.at("initial_chi2") == one.at("initial_chi2"));
  CHECK(cell.at("algorithm") == "default");
  CHECK(cell.at("solver_description") == one.at("solver"));
}

TEST_CASE("bench: writes a CSV line per cell and a table per file") {
  const std::string folder = fresh_folder();
  write_text(folder + "a.graph", square_graph());
  write_text(folder + "b.graph", slow_graph(50));
  const RunResult result =
      run({"bench", "a.graph", "b.graph", "--repeat", "2", "-o", "out"}, {.folder = folder});
  CHECK(result.code == 0);
  CHECK(contains(result.out, "a.graph: 4 vertices, 4 edges; optimum "));
  CHECK(contains(result.out, "(lowest chi2 of this run, none is listed)\nstart  algorithm "));
  CHECK(contains(result.out, "\n\nb.graph: 50 vertices, "));
  const std::vector<std::string> lines = lines_of(read_text(folder + "out/bench.csv"));
  REQUIRE(lines.size() == 3);
  CHECK(lines[0].rfind("file,vertices,edges,start,algorithm,solver,peer,repetitions,iterations,", 0) == 0);
  const auto commas = [](const std::string& line) { return std::count(line.begin(), line.end(), ','); };
  CHECK(commas(lines[1]) == commas(lines[0]));
  CHECK(lines[1].rfind("a.graph,4,4,file,default,", 0) == 0);
  CHECK(lines[2].rfind("b.graph,50,", 0) == 0);
}

TEST_CASE("bench: writes a page with the numbers of its JSON, and what did not converge") {
  const std::string folder = fresh_folder();
  write_text(folder + "a.graph", square_graph());
  write_text(folder + "b.graph", slow_graph(50));
  const RunResult result = run({"bench", "a.graph", "b.graph", "-a", "dogleg,levenberg_marquardt", "--repeat",
                                "3", "--max-iterations", "1", "--json", "-o", "out"},
                               {.folder = folder});
  REQUIRE(result.code == 0);
  const std::string html = read_text(folder + "out/bench.html");
  CHECK(page_flaws(html) == std::vector<std::string>{});
  const Json json = Json::parse(result.out);
  CHECK(contains(html, json.at("header").at("processor").get<std::string>()));

  std::istringstream csv(read_text(folder + "out/figures/bench-time.csv"));
  std::string line;
  std::getline(csv, line);
  CHECK(line == "series,time [ms],file,low,high");
  std::getline(csv, line);
  const Json& cell = json.at("files").at(0).at("cells").at(0);
  REQUIRE(line.rfind("dogleg,", 0) == 0);
  CHECK(std::stod(line.substr(7)) == Approx(1e3 * cell.at("median_seconds").get<double>()));
  CHECK(contains(line, ",a.graph,"));

  const std::string caption = "Not converged, or above the optimum";
  int missed = 0;
  for (const Json& file : json.at("files"))
    for (const Json& of_file : file.at("cells")) missed += of_file.at("converged") == false ? 1 : 0;
  CHECK(missed > 0);
  const std::vector<std::string> row = table_row(html, caption, "a.graph");
  REQUIRE(row.size() == 5);
  CHECK(row[2] == "! not converged");
  CHECK(contains(html, "not converged (!)"));  // the crosses' entry in a legend
}

TEST_CASE("bench: a page of many contestants has a figure for each file") {
  const std::string folder = fresh_folder();
  write_text(folder + "a.graph", square_graph());
  REQUIRE(run({"bench", "a.graph", "-a", "all", "-s", "all", "--repeat", "1", "-o", "out", "-q"},
              {.folder = folder})
              .code == 0);
  const std::string html = read_text(folder + "out/bench.html");
  CHECK(page_flaws(html) == std::vector<std::string>{});
  CHECK(contains(html, "id=\"time-1\""));
  CHECK(contains(read_text(folder + "out/figures/bench-time-1.csv"), ",dogleg block_cholesky,"));
}

TEST_CASE("bench: judges by listed optima: reached, above, lower") {
  const std::string folder = fresh_folder();
  write_text(folder + "a.graph", square_graph());
  const Json found = Json::parse(run({"bench", folder + "a.graph", "--repeat", "1", "--json"}).out);
  const double chi2 = found.at("files").at(0).at("optimum");
  struct Case {
    double factor;
    const char* json;
    const char* table;
  };
  for (const Case& c :
       {Case{1, "reached", "reached"}, Case{0.5, "above", "above by 1"}, Case{2, "lower", "lower by 0.5"}}) {
    std::ostringstream list;
    list.precision(17);
    list << "# best known\nfile,chi2\nother.g2o,3\na.graph," << c.factor * chi2 << "\n";
    const std::string optima = write_text(folder + "optima.csv", list.str());
    const std::vector<std::string> arguments = {"bench", folder + "a.graph", "--repeat",
                                                "1",     "--optima",         optima};
    const RunResult table = run(arguments);
    CHECK(table.code == 0);
    CHECK(contains(table.out, "(listed)"));
    CHECK(contains(table.out, c.table));
    std::vector<std::string> with_json = arguments;
    with_json.emplace_back("--json");
    const Json json = Json::parse(run(with_json).out);
    CHECK(json.at("files").at(0).at("optimum_source") == "listed");
    CHECK(json.at("files").at(0).at("cells").at(0).at("optimality") == c.json);
  }
}

TEST_CASE("bench: marks a cell that does not converge and still ends with 0") {
  const std::string input = write_text(fresh_folder() + "a.graph", square_graph());
  const RunResult result = run({"bench", input, "--repeat", "1", "--max-iterations", "1"});
  CHECK(result.code == 0);
  CHECK(contains(result.out, " 1! "));
  CHECK(contains(result.out, "\n! start file, default with "));
  CHECK(contains(result.out, ": not converged after 1 iterations"));
}

TEST_CASE("bench: measures peers in turn and gives paired ratios") {
  if (!has_ceres()) return;
  const std::string folder = fresh_folder();
  const std::string input = write_text(folder + "a.graph", square_graph());
  const Json json = Json::parse(run({"bench", input, "-a", "all", "-s", "eigen", "--peer",
                                     "ceres,ceres_dogleg", "--repeat", "2", "--json"})
                                    .out);
  const Json& cells = json.at("files").at(0).at("cells");
  REQUIRE(cells.size() >= 5);
  const Json& peer = cells.at(cells.size() - 2);
  CHECK(peer.at("algorithm") == "ceres");
  CHECK(peer.at("peer") == true);
  CHECK(peer.at("peer_ratios").empty());
  CHECK(cells.back().at("algorithm") == "ceres_dogleg");
  for (const Json& cell : cells) {
    check_cell(cell, 2);
    CHECK(cell.at("chi2").get<double>() == Approx(cells.at(0).at("chi2").get<double>()).epsilon(1e-6));
    if (cell.at("peer") == true) continue;
    // The median of two is their mean.
    const double first =
        peer.at("run_seconds").at(0).get<double>() / cell.at("run_seconds").at(0).get<double>();
    const double second =
        peer.at("run_seconds").at(1).get<double>() / cell.at("run_seconds").at(1).get<double>();
    CHECK(cell.at("peer_ratios").at("ceres").get<double>() == Approx((first + second) / 2));
  }
}

TEST_CASE("bench: refuses wrong words and files before it measures") {
  const std::string folder = fresh_folder();
  write_text(folder + "a.graph", square_graph());
  write_text(folder + "bad.graph", "GRAPH 1\nVERTEX_SE2 0 0 0\n");
  write_text(folder + "no_heading.csv", "a.graph,1\n");
  write_text(folder + "word.csv", "file,chi2\na.graph,low\n");
  write_text(folder + "twice.csv", "file,chi2\na.graph,1\na.graph,2\n");
  write_text(folder + "three.csv", "file,chi2\na.graph,1,2\n");
  write_text(folder + "empty.csv", "");
  struct Case {
    std::vector<std::string> arguments;
    int code;
    const char* message;
  };
  const std::vector<Case> cases = {
      {{}, 2, "graphs is required"},
      {{"a.graph", "--solver", "mumps"}, 2, "unknown linear solver 'mumps'; there are: "},
      {{"a.graph", "-a", "dogleg,newton"}, 2, "unknown algorithm 'newton'; there are: "},
      {{"a.graph", "--start", "middle"},
       2,
       "unknown initial guess 'middle'; there are: file, linear, spanning_tree, odometry"},
      {{"a.graph", "--peer", "g2o"}, 2, "unknown peer 'g2o'; there are: ceres, ceres_dogleg"},
      {{"a.graph", "--repeat", "0"}, 2, "--repeat: must be at least 1, got 0"},
      {{"a.graph", "--tolerance", "0"}, 2, "--tolerance: must be above 0, got 0"},
      {{"a.graph", "none.graph"}, 3, "none.graph: cannot read: No such file or directory"},
      {{"a.graph", "bad.graph"}, 3, "bad.graph:2:17: VERTEX_SE2: expected a number for 'heading'"},
      {{"a.graph", "--optima", "none.csv"}, 3, "none.csv: cannot read: No such file or directory"},
      {{"a.graph", "--optima", "no_heading.csv"},
       3,
       "no_heading.csv:1:1: expected the heading 'file,chi2', got 'a.graph,1'"},
      {{"a.graph", "--optima", "word.csv"},
       3,
       "word.csv:2:9: expected a chi2 (a number, at least 0), got 'low'"},
      {{"a.graph", "--optima", "twice.csv"}, 3, "twice.csv:3:1: 'a.graph' is listed a second time"},
      {{"a.graph", "--optima", "three.csv"}, 3, "three.csv:2:1: expected two fields, file and chi2"},
      {{"a.graph", "--optima", "empty.csv"}, 3, "empty.csv: no optima in it"},
      {{"a.graph", "-o", "a.graph"}, 5, "a.graph: cannot make the folder"},
  };
  for (Case c : cases) {
    c.arguments.insert(c.arguments.begin(), "bench");
    check_refused(run(c.arguments, {.folder = folder}), c.code, c.message);
  }
}

TEST_CASE("bench: a peer that is not built in is named with the remedy") {
  if (contains(run({"doctor"}).out, "Ceres")) {
    waymark_test::skip("this program was built with Ceres");
    return;
  }
  const std::string input = write_text(fresh_folder() + "a.graph", square_graph());
  const RunResult result = run({"bench", input, "--peer", "ceres"});
  CHECK(result.code == 2);
  CHECK(contains(result.err,
                 "install the Debian package libceres-dev and build again with -DWAYMARK_WITH_CERES=ON"));
}

TEST_CASE("bench: Ctrl-C ends it") {
  const std::string folder = fresh_folder();
  write_text(folder + "slow.graph", slow_graph(19'000));
  const RunResult result =
      run({"bench", "slow.graph", "-a", "levenberg_marquardt", "--repeat", "100000", "-v"},
          {.interrupt_at = "measuring", .folder = folder});
  CHECK(result.code == 130);
  CHECK(contains(result.err, "interrupted before there was a result"));
}

TEST_CASE("bench: the shipped list of optima is read") {
  const std::string folder = fresh_folder();
  const std::string input = write_text(folder + "ring.g2o",
                                       "VERTEX_SE2 0 0 0 0\nVERTEX_SE2 1 1 0 0\n"
                                       "EDGE_SE2 0 1 1.5 0 0 1 0 0 1 0 1\n");
  const RunResult result = run({"bench", input, "--repeat", "1", "--optima",
                                waymark_test::source_dir() + "/examples/benchmarks/standard_graphs.csv"});
  CHECK(result.code == 0);
  CHECK(contains(result.out, "optimum 11.163101 (listed)"));
}

}  // namespace bench_test
