// `waymark optimize --covariance` and the tables of `--covariance-file`.
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include <sstream>

#include "program/support/help.hpp"
#include "program/support/material.hpp"
#include "program/support/program.hpp"

namespace covariance_test {

namespace {

/// A pose with a prior, one seen from it, a point: chi2 is 0 in the file.
constexpr const char* kMixedGraph =
    "GRAPH 1\nVERTEX_SE2 7 0 0 0\nVERTEX_SE2 -2 0 0 0\nVERTEX_XY 9 0 0\nSTAMP -2 1149206567040000001\n"
    "EDGE_PRIOR_SE2 7 0 0 0 4 0 0 16 0 64\nEDGE_SE2 7 -2 0 0 0 2 0 0 4 0 64\nEDGE_SE2_XY 7 9 0 0 8 0 8\n";

/// Fields of a line, an empty one at its end too.
std::vector<std::string> fields_of(const std::string& line) {
  std::vector<std::string> fields;
  std::istringstream in(line + ",");
  for (std::string field; std::getline(in, field, ',');) fields.push_back(field);
  return fields;
}

/// The same line but for the rounding of its numbers.
void check_row(const std::string& line, const std::string& expected) {
  const std::vector<std::string> fields = fields_of(line);
  const std::vector<std::string> wanted = fields_of(expected);
  REQUIRE(fields.size() == wanted.size());
  for (std::size_t i = 0; i < fields.size(); ++i) {
    INFO(line << " field " << i);
    if (i < 3 || wanted[i].empty() || wanted[i] == "0") {
      CHECK(fields[i] == wanted[i]);
    } else {
      CHECK(std::stod(fields[i]) == Approx(std::stod(wanted[i])).epsilon(1e-14));
    }
  }
}

std::string folder_with(const std::string& graph) {
  std::string folder = fresh_folder();
  write_text(folder + "a.graph", graph);
  return folder;
}

}  // namespace

TEST_CASE("covariance: covariances as CSV: columns named by the vertices' numbers") {
  const std::string folder = folder_with(kMixedGraph);
  const RunResult result =
      run({"optimize", "a.graph", "-o", "b.graph", "--covariance", "all", "--covariance-file", "b.csv"},
          {.folder = folder});
  INFO(result.err);
  CHECK(result.code == 0);
  CHECK(contains(result.out, "written     b.graph b.csv\n"));
  CHECK(names_in(folder) == std::vector<std::string>{"a.graph", "b.csv", "b.graph"});
  // All stand on one place, so that variances add: 1/4 + 1/2, 1/16 + 1/4, 1/64 + 1/64; 1/4 + 1/8, 1/16 + 1/8.
  const std::vector<std::string> rows = lines_of(read_text(folder + "b.csv"));
  REQUIRE(rows.size() == 4);
  CHECK(rows[0] == "id,tag,stamp_ns,x_x,x_y,x_heading,y_y,y_heading,heading_heading");
  check_row(rows[1], "7,VERTEX_SE2,,0.25,0,0,0.0625,0,0.015625");
  check_row(rows[2], "-2,VERTEX_SE2,1149206567040000001,0.75,0,0,0.3125,0,0.03125");
  check_row(rows[3], "9,VERTEX_XY,,0.375,0,,0.1875,,");
}

TEST_CASE("covariance: covariances as JSON: the numbers, and what they are of") {
  const std::string folder = folder_with(std::string(kMixedGraph) +
                                         "VERTEX_SE2 20 0 0 0\nVERTEX_SE2 21 1 0 0\n"
                                         "EDGE_SE2 20 21 1 0 0 1 0 0 1 0 1\nLOSS huber 1.5\n");
  const RunResult result =
      run({"optimize", "a.graph", "-o", "b.graph", "--covariance", "all", "--covariance-file", "b.json"},
          {.folder = folder});
  INFO(result.err);
  CHECK(result.code == 0);
  const auto json = nlohmann::json::parse(read_text(folder + "b.json"));
  CHECK(json.at("version").get<std::string>().rfind("waymark ", 0) == 0);
  CHECK(json.at("converged") == true);
  CHECK(json.at("chi2") == 0);
  CHECK(json.at("time_scale") == "gps");
  CHECK(json.at("chart").at("upper_triangle").at("VERTEX_XY") == nlohmann::json({"x_x", "x_y", "y_y"}));
  CHECK(json.at("held").at("vertices") == nlohmann::json({20}));
  CHECK(json.at("held").at("notes").size() == 1);
  const auto& loss = json.at("robust").at("losses").at(0);
  CHECK(loss.at("loss") == "huber");
  CHECK(loss.at("scale") == 1.5);
  CHECK(loss.at("edges") == 1);
  const auto& covariances = json.at("covariances");
  REQUIRE(covariances.size() == 4);  // the held vertex has none
  CHECK(covariances[1].at("id") == -2);
  CHECK(covariances[1].at("tag") == "VERTEX_SE2");
  CHECK(covariances[1].at("stamp_ns") == 1149206567040000001);
  CHECK(covariances[1].at("upper_triangle").size() == 6);
  CHECK(covariances[1].at("upper_triangle").at(3).get<double>() == Approx(0.3125).epsilon(1e-14));
  CHECK_FALSE(covariances[0].contains("stamp_ns"));
  CHECK(covariances[3].at("id") == 21);
}

TEST_CASE("covariance: tables hold the numbers of the graph, digit by digit") {
  const std::string folder = folder_with(square_graph());
  for (const char* name : {"b.csv", "b.json"}) {
    CHECK(run({"optimize", "a.graph", "-o", "b.graph", "--covariance", "all", "--covariance-file", name},
              {.folder = folder})
              .code == 0);
  }
  const std::vector<std::string> rows = lines_of(read_text(folder + "b.csv"));
  const auto json = nlohmann::json::parse(read_text(folder + "b.json"));
  std::size_t row = 1;
  for (const std::string& line : lines_of(read_text(folder + "b.graph"))) {
    std::istringstream words(line);
    std::string word;
    words >> word;
    if (word != "COVARIANCE") continue;
    words >> word;
    std::string expected = word + ",VERTEX_SE2,";
    for (const auto& number : json.at("covariances").at(row - 1).at("upper_triangle")) {
      words >> word;
      expected += "," + word;
      CHECK(std::stod(word) == number.get<double>());
    }
    CHECK(rows.at(row++) == expected);
  }
  CHECK(row == rows.size());
  CHECK(row == 4);  // one of the four corners is held
}

TEST_CASE("covariance: no minimum, no covariances: the tables are empty and that is said") {
  const std::string folder = folder_with(square_graph());
  for (const std::string name : {"b.csv", "b.json"}) {
    const RunResult result = run({"optimize", "a.graph", "-o", "b.graph", "--start", "file",
                                  "--max-iterations", "1", "--covariance", "all", "--covariance-file", name},
                                 {.folder = folder});
    CHECK(result.code == 4);
    CHECK(contains(result.err, "note: " + name + " has no covariances\n"));
  }
  CHECK(read_text(folder + "b.csv") == "id,tag,stamp_ns\n");
  const auto json = nlohmann::json::parse(read_text(folder + "b.json"));
  CHECK(json.at("converged") == false);
  CHECK(json.at("covariances").empty());
}

TEST_CASE("covariance: where they cannot be computed the minimum is written, and the weak vertex is told") {
  const std::string folder =
      folder_with("GRAPH 1\nVERTEX_SE2 0 0 0 0\nVERTEX_SE2 1 0 0 0\nEDGE_SE2 0 1 1 2 0 1 0 0 1 0 0\n");
  const RunResult result = run(
      {"optimize", "a.graph", "-o", "b.graph", "--covariance", "all", "--covariance-file", "b.csv"},
      {.folder = folder});
  CHECK(result.code == 0);
  CHECK(contains(result.err, "warning: the result has no covariances: "));
  CHECK(contains(result.err, "VERTEX_SE2 1"));
  const std::string written = read_text(folder + "b.graph");
  CHECK(contains(written, "VERTEX_SE2 1 1 2 0\n"));
  CHECK(contains(written, "the result has no covariances"));  // in its provenance
  CHECK(read_text(folder + "b.csv") == "id,tag,stamp_ns\n");
}

TEST_CASE("covariance: a table that cannot be written is refused before the work") {
  const std::string folder = folder_with(square_graph());
  const auto refuse = [&](const std::string& which, const std::string& name) {
    return run({"optimize", "a.graph", "-o", "b.graph", "--covariance", which, "--covariance-file", name},
               {.folder = folder});
  };
  CHECK(refuse("all", "b.txt").code == 2);
  CHECK(refuse("all", "b.txt").err ==
        "waymark: error: --covariance-file: the name must end in .csv or .json, got 'b.txt'\n");
  CHECK(refuse("none", "b.csv").err ==
        "waymark: error: --covariance-file: choose the covariances: --covariance fixes or "
        "--covariance all\n");
  CHECK(refuse("all", "none/b.csv").code == 5);
  CHECK(names_in(folder) == std::vector<std::string>{"a.graph"});
}

}  // namespace covariance_test
