// Graph files to other formats and programs, as a user does it: messages, refusals, files.

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "program/support/material.hpp"
#include "program/support/program.hpp"
#include "support/skip.hpp"

namespace convert_test {

namespace {

using Json = nlohmann::json;

/// An L of three poses as TORO writes it, its information not symmetric in x and y.
const char* const kToro =
    "VERTEX2 0 0 0 0\nVERTEX2 1 1.1 0 0\nVERTEX2 2 2 0.1 1.5\n"
    "EDGE2 0 1 1 0 0 4 0 16 64 0 0\nEDGE2 1 2 1 0 1.57 4 0 16 64 0 0\n";

/// chi2 of a file's own values.
double chi2_of(const std::string& file, const std::string& format) {
  const RunResult result = run({"convert", file, "-o", "/dev/null", "--input-format", format, "--json"});
  INFO(result.err);
  REQUIRE(result.code == 0);
  return Json::parse(result.out)["chi2"].get<double>();
}

}  // namespace

TEST_CASE("convert: TORO through every format and back has one chi2, taken for covariance another") {
  const std::string folder = fresh_folder();
  const std::string toro = write_text(folder + "toro.graph", kToro);
  const double chi2 = chi2_of(toro, "toro");
  CHECK(chi2 > 0.01);
  for (const char* format : {"graph", "g2o", "toro", "covariance"}) {
    const std::string out = folder + format + ".out";
    const RunResult result = run({"convert", toro, "--input-format", "toro", "-o", out, "--format", format});
    INFO(format << "\n" << result.err);
    CHECK(result.code == 0);
    CHECK(result.err.empty());
    CHECK(contains(result.out, "3 vertices, 2 edges, chi2 "));
    CHECK(chi2_of(out, format) == Approx(chi2).epsilon(1e-12));
  }
  CHECK(chi2_of(toro, "covariance") != Approx(chi2).epsilon(0.1));
}

TEST_CASE("convert: TORO is never guessed") {
  const std::string folder = fresh_folder();
  const RunResult result = run({"convert", write_text(folder + "toro.graph", kToro), "-o", folder + "out"});
  CHECK(result.code == 3);
  CHECK(contains(result.err, "toro.graph:1:1: tag 'VERTEX2' is of TORO or GTSAM, which differ"));
  CHECK_FALSE(exists(folder + "out"));
}

TEST_CASE("convert: a profile writes what its reader takes, and counts what it leaves out") {
  const std::string folder = fresh_folder();
  const std::string graph = write_text(
      folder + "a.graph",
      "GRAPH 1\nFRAME utm 32N origin 0 0\nVERTEX_SE2 -1 0 0 0\nVERTEX_SE2 3 1 0 0\nSTAMP 3 5\nFIX -1\n"
      "EDGE_SE2 -1 3 1 0 0 4 0 0 4 0 9\nCOVARIANCE 3 1 0 0 1 0 1\n");
  const RunResult gtsam = run({"convert", graph, "-o", folder + "gtsam.g2o", "--profile", "gtsam"});
  CHECK(gtsam.code == 0);
  CHECK(gtsam.err ==
        "note: vertex -1 is 0 there: GTSAM's load2D does not take such ids\n"
        "note: FIX -1 is left out: GTSAM's load2D has none; chi2 and shape of the minimum stay the "
        "same, its place may differ\n"
        "note: left out, as GTSAM's load2D has no place for it: frame, stamps "
        "(1), covariances (1)\n");
  CHECK(read_text(folder + "gtsam.g2o") ==
        "VERTEX_SE2 0 0 0 0\nVERTEX_SE2 3 1 0 0\nEDGE_SE2 0 3 1 0 0 4 0 0 4 0 9\n");
  const RunResult ceres = run({"convert", graph, "-o", folder + "ceres.g2o", "--profile", "ceres"});
  CHECK(ceres.code == 0);
  CHECK(ceres.err ==
        "note: left out, as Ceres' pose_graph_2d has no place for it: frame, stamps (1), covariances (1)\n");
  CHECK(read_text(folder + "ceres.g2o") ==
        "VERTEX_SE2 -1 0 0 0\nVERTEX_SE2 3 1 0 0\nEDGE_SE2 -1 3 1 0 0 4 0 0 4 0 9\n");
  const RunResult toro = run({"convert", graph, "-o", folder + "toro.graph", "--profile", "toro", "-q"});
  CHECK(toro.code == 0);
  CHECK(toro.err.empty());
  CHECK(read_text(folder + "toro.graph") ==
        "VERTEX2 -1 0 0 0\nVERTEX2 3 1 0 0\nEDGE2 -1 3 1 0 0 4 0 4 9 0 0\n");
  const RunResult covariance =
      run({"convert", graph, "-o", folder + "c.graph", "--profile", "gtsam", "--format", "covariance"});
  CHECK(covariance.code == 0);
  CHECK(contains(covariance.out, "format covariance for GTSAM's load2D"));
  CHECK(contains(read_text(folder + "c.graph"), "EDGE2 0 3 1 0 0 0.25 0 0.25 0.111111"));
}

TEST_CASE(
    "convert: what would move the minimum is refused with its place and a remedy, and nothing is left") {
  const std::string folder = fresh_folder();
  const std::string head = "GRAPH 1\nVERTEX_SE2 0 0 0 0\nVERTEX_SE2 1 1 0 0\n";
  struct Case {
    const char* lines;
    const char* profile;
    const char* message;
  };
  const Case cases[] = {
      {"EDGE_SE2_LOG 0 1 1 0 0 4 0 0 4 0 9\n", "g2o",
       "a.graph: EDGE_SE2_LOG 0 1 (number 1): g2o has no such edge; write --format graph, which holds "
       "everything"},
      {"EDGE_SE2 0 1 1 0 0 4 0 0 4 0 9\nEDGE_SE2 0 1 1 0 0 4 0 0 4 0 9\nLOSS huber 1\n", "gtsam",
       "EDGE_SE2 0 1 (number 2): GTSAM's load2D has no robust losses"},
      {"FIX 0 1\nEDGE_SE2 0 1 1 0 0 4 0 0 4 0 9\n", "gtsam",
       "FIX 1: GTSAM's load2D has no FIX, and vertex 0, fixed too, is joined to this one; free the vertex"},
      {"EDGE_SE2 0 1 1 0 0 4 1 0 4 0 9\n", "ceres", "write --format g2o for readers that weigh by L^T"},
      {"EDGE_PRIOR_SE2 0 1 0 0 4 1 0 4 0 9\n", "ceres", "EDGE_PRIOR_SE2 0 (number 1): Ceres' pose_graph_2d"},
      {"EDGE_SE2 0 1 1 0 0 4 0 0 4 0 9\nEDGE_SE2 0 1 1 0 0 4 0 0 4 0 9\n", "toro",
       "EDGE_SE2 0 1 (number 2): TORO drops the second edge between two vertices"}};
  for (const Case& c : cases) {
    const std::string graph = write_text(folder + "a.graph", head + c.lines);
    const RunResult result = run({"convert", graph, "-o", folder + "out", "--profile", c.profile});
    INFO(c.lines << result.err);
    CHECK(result.code == 3);
    CHECK(contains(result.err, c.message));
    CHECK_FALSE(exists(folder + "out"));
  }
}

TEST_CASE("convert: options that do not belong to the input are refused") {
  const std::string folder = fresh_folder();
  const std::string graph = write_text(folder + "a.graph", square_graph());
  const std::string drive = write_drive(folder);
  const std::pair<std::vector<std::string>, const char*> cases[] = {
      {{graph, "--modeling", "g2", "--no-gate"}, "--modeling, --no-gate: the input is a graph file"},
      {{drive, "--lenient", "--input-format", "toro"}, "--input-format, --lenient: the input is a drive"},
      {{graph, "--profile", "ceres", "--format", "toro"},
       "--profile ceres: Ceres' pose_graph_2d does not read the format toro; it reads: g2o"},
      {{graph, "--profile", "isam"}, "--profile: unknown profile 'isam'; there are: g2o, gtsam, ceres, toro"},
      {{graph, "--format", "g3o"}, "--format: unknown format 'g3o'; did you mean 'g2o'?"}};
  for (const auto& [words, message] : cases) {
    std::vector<std::string> arguments = {"convert", "-o", folder + "out"};
    arguments.insert(arguments.end(), words.begin(), words.end());
    const RunResult result = run(arguments);
    INFO(message << "\n" << result.err);
    CHECK(result.code == 2);
    CHECK(contains(result.err, message));
    CHECK_FALSE(exists(folder + "out"));
  }
}

TEST_CASE("convert: a drive of odometry cannot be said in g2o's words, and it is said") {
  const std::string folder = fresh_folder();
  const RunResult result =
      run({"convert", write_drive(folder), "-m", "g1", "-o", folder + "out.g2o", "--format", "g2o"});
  CHECK(result.code == 3);
  CHECK(contains(result.err, "EDGE_SE2_ODOMETRY"));
  CHECK_FALSE(exists(folder + "out.g2o"));
}

TEST_CASE("convert: our own format says where it comes from, lenient reading says what it skipped") {
  const std::string folder = fresh_folder();
  const std::string g2o =
      write_text(folder + "a.g2o", "EDGE_SE2 0 1 1 0 0 1 0 0 1 0 1\nEDGE_SE2 0 1 1 0 0 1 0 0 1 0\n");
  const RunResult result = run({"convert", g2o, "-o", folder + "a.graph", "--lenient"});
  CHECK(result.code == 0);
  CHECK(contains(result.err, "warning: 1 lines were skipped"));
  CHECK(contains(result.err, "note: the file has only edges"));
  CHECK(contains(read_text(folder + "a.graph"), "PROVENANCE warning 1 lines were skipped\n"));
  CHECK(contains(read_text(folder + "a.graph"), "PROVENANCE converted waymark "));
  CHECK(contains(read_text(folder + "a.graph"), " from a.g2o fnv1a64:"));
}

TEST_CASE("convert: optimize, check and bench read what they are told to, optimize writes every format") {
  const std::string folder = fresh_folder();
  const std::string toro = write_text(folder + "toro.graph", kToro);
  CHECK(contains(run({"check", toro, "--input-format", "toro"}).out, "no problems found"));
  CHECK(run({"check", toro}).code == 3);
  CHECK(run({"bench", toro, "--input-format", "toro", "--repeat", "1"}).code == 0);
  const RunResult written =
      run({"optimize", toro, "--input-format", "toro", "-o", folder + "out", "--format", "covariance"});
  CHECK(written.code == 0);
  CHECK(chi2_of(folder + "out", "covariance") < 1e-12);  // no loop: everything can be met
}

TEST_CASE("convert: fr079 read as TORO and optimised in three formats has one minimum") {
  const auto file = waymark_test::shared_data("graphs/fr079_toro.graph");
  if (!file) return;
  const std::string folder = fresh_folder();
  for (const char* format : {"g2o", "toro", "covariance"}) {
    const std::string out = folder + format;
    REQUIRE(run({"convert", *file, "--input-format", "toro", "-o", out, "--format", format}).code == 0);
    const RunResult result = run({"optimize", out, "--input-format", format, "-o", "/dev/null", "--json"});
    INFO(result.err);
    REQUIRE(result.code == 0);
    CHECK(Json::parse(result.out)["final_chi2"].get<double>() == Approx(37.599116).epsilon(1e-6));
  }
}

}  // namespace convert_test
