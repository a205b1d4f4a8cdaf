// Errors on the command line, and the options that every subcommand has.
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "program/support/help.hpp"
#include "program/support/material.hpp"
#include "program/support/program.hpp"

#include "support/skip.hpp"

namespace usage_test {

TEST_CASE("usage: help of every subcommand has an example, and the program's the exit codes") {
  for (const std::string& command : subcommands()) {
    const RunResult result = run({command, "--help"});
    INFO(command);
    CHECK(result.code == 0);
    const std::size_t example = result.out.find("\nExample:\n  ");
    REQUIRE(example != std::string::npos);
    CHECK(contains(result.out.substr(example), "waymark " + command));
    CHECK(result.err.empty());
  }
  const RunResult result = run({"--help"});
  CHECK(result.code == 0);
  CHECK(contains(result.out,
                 "Exit codes: 0 success, 1 internal error, 2 wrong usage, 3 bad input, 4 no convergence"));
}

TEST_CASE("usage: the version is one line that names the program first") {
  const RunResult result = run({"--version"});
  CHECK(result.code == 0);
  CHECK(result.out.starts_with("waymark "));
  CHECK(result.out.find('\n') == result.out.size() - 1);
}

TEST_CASE("usage: wrong words on the command line are usage errors that name them") {
  const std::string folder = fresh_folder();
  const std::string graph = write_text(folder + "a.graph", square_graph());
  const std::string out = folder + "out.graph";
  const std::string drive = bundled_drive();
  struct Case {
    std::vector<std::string> arguments;
    std::string message;
  };
  const std::vector<Case> cases = {
      {{"optimise"}, "unknown subcommand 'optimise'; did you mean 'optimize'?"},
      {{"xyz"},
       "unknown subcommand 'xyz'; there are: inspect, init, sync, convert, optimize, evaluate, run, view, live, fleet, compare, "
       "bench, info, check"},
      {{"optimize", graph}, "--output is required"},
      {{"optimize", "-o", out}, "graph is required"},
      {{"optimize", graph, "-o", out, "--speed", "3"}, "unknown option '--speed'"},
      {{"optimize", graph, "-o", out, "--solver", "mumps"}, "unknown linear solver 'mumps'; there are: "},
      {{"optimize", graph, "-o", out, "-a", "newton"},
       "unknown algorithm 'newton'; there are: gauss_newton, levenberg_marquardt, dogleg"},
      {{"optimize", graph, "-o", out, "--algorithm-option", "radius"}, "expected NAME=VALUE, got 'radius'"},
      {{"optimize", graph, "-o", out, "--algorithm-option", "trust=1"}, "dogleg: unknown option 'trust'"},
      {{"optimize", graph, "-o", out, "--max-iterations", "-1"},
       "--max-iterations: must be at least 0, got -1"},
      {{"optimize", graph, "-o", out, "--max-iterations", "many"},
       "--max-iterations: must be at least 0, got many"},
      {{"optimize", graph, "-o", out, "--tolerance", "0"}, "--tolerance: must be above 0, got 0"},
      {{"optimize", graph, "-o", out, "--tolerance", "nan"}, "--tolerance: must be above 0, got nan"},
      {{"optimize", graph, "-o", out, "--format", "kml"},
       "--format: unknown format 'kml'; there are: graph, g2o, toro, covariance"},
      {{"optimize", graph, "-o", out, "--covariance", "some"},
       "--covariance: unknown choice 'some'; there are: none, fixes, all"},
      {{"run", drive, "--out", out, "-m", "g9"},
       "unknown GNSS modeling 'g9'; there are: correlated, g1, g2, g3"},
      {{"run", drive, "--out", out, "-m", "g1", "--modeling-option", "error=perfect"},
       "g1: option 'error' must be 'decoupled' or 'literal', got 'perfect'"},
      {{"run", drive, "--out", out, "--withhold", "1"}, "--withhold: must be 0 (none) or at least 2, got 1"},
      {{"run", drive, "--out", out, "--from", "nan"},
       "--from: must be a number of seconds, at least 0, got nan"},
      {{"run", drive, "--out", out, "--to", "-3"}, "--to: must be a number of seconds, at least 0, got -3"},
      {{"run", drive, "--out", out, "--from", "9", "--to", "5"}, "--from 9 must be less than --to 5"},
      {{"convert", drive, "-o", out, "-m", "all"}, "convert writes one graph: name one modeling"},
  };
  for (const Case& c : cases) {
    check_refused(run(c.arguments), 2, c.message);
    CHECK_FALSE(exists(out));
  }
}

TEST_CASE("usage: the program alone lists its subcommands") {
  const RunResult result = run({});
  CHECK(result.code == 2);
  CHECK(contains(result.out, "Subcommands:\n  inspect "));
  CHECK(result.err.empty());
}

TEST_CASE("usage: a file of the wrong kind is answered in two lines by the command to type") {
  const std::string folder = fresh_folder();
  const std::string drive = write_drive(folder);
  const std::string graph = write_text(folder + "a.graph", square_graph());
  const std::string nmea = write_text(
      folder + "rover.nmea", "$GPGGA,000001,4810.8509,N,01133.9095,E,1,04,2.5,500.5,M,46.5,M,,*4B\n");
  const auto answer = [](const std::vector<std::string>& arguments) {
    const RunResult result = run(arguments);
    CHECK(result.code == 2);
    return result.err;
  };
  CHECK(answer({"run", nmea}) ==
        "waymark: error: " + nmea +
            " is a log (nmea), and 'run' wants a drive.yaml, which names the logs of a "
            "drive; type\n  waymark init " +
            nmea + " -o drive.yaml\n");
  CHECK(contains(answer({"sync", folder + "odometry.csv"}), "is a log (csv), and 'sync' wants a drive.yaml"));
  CHECK(contains(answer({"optimize", nmea, "-o", folder + "x"}),
                 "is a log (nmea), and 'optimize' wants a graph"));
  CHECK(contains(answer({"optimize", "-o", folder + "x", drive}),
                 "describes a drive, and 'optimize' wants a graph; type\n  waymark convert " + drive));
  CHECK(contains(answer({"check", drive}), "describes a drive, and 'check' wants a graph"));
  CHECK(contains(answer({"run", graph}), "is a graph, and 'run' wants a drive.yaml"));
  const std::string blanks = write_text(
      folder + "blanks.g2o", "\n VERTEX_SE2 0 0 0 0\n VERTEX_SE2 1 1 0 0\n EDGE_SE2 0 1 1 0 0 1 0 0 1 0 1\n");
  CHECK(contains(answer({"run", blanks}), "is a graph, and 'run' wants a drive.yaml"));
  CHECK(contains(answer({"init", drive}),
                 "describes a drive, and 'init' wants logs; type\n  waymark inspect "));
  // A long line of rubbish named as a drive is not printed whole.
  const std::string rubbish = write_text(folder + "rubbish.yaml", std::string(100'000, 'x') + "\n");
  const RunResult refused = run({"run", rubbish, "-o", folder + "out"});
  CHECK(refused.code == 3);
  CHECK(refused.err.size() < 300 + rubbish.size());
}

TEST_CASE("usage: a small graph is no log, whatever stands before its tags and however these are spelt") {
  const std::string folder = fresh_folder();
  const std::string body = "0 0 0 0\nVERTEX_SE2 1 1 0 0\nEDGE_SE2 0 1 1 0 0 100 0 0 100 0 1000\n";
  for (const std::string begin : {" VERTEX_SE2 ", "\t\tVERTEX_SE2 ", "\xEF\xBB\xBFVERTEX_SE2 "}) {
    const std::string graph = write_text(folder + "a.g2o", begin + body);
    INFO(begin);
    CHECK(run({"check", graph}).code == 0);
    CHECK(run({"optimize", graph, "-o", folder + "o.graph"}).code == 0);
  }
  for (const std::string begin : {"vertex_se2 ", "Vertex_SE2 ", "VERTX_SE2 "}) {
    const std::string graph = write_text(folder + "a.g2o", begin + body);
    check_refused(
        run({"optimize", graph, "-o", folder + "o.graph"}), 3,
        graph + ":1:1: unknown tag '" + begin.substr(0, begin.size() - 1) + "'; did you mean 'VERTEX_SE2'?");
  }
}

TEST_CASE("usage: what is mistyped is answered by what was meant, before anything is read") {
  const std::string drive = bundled_drive();
  struct Case {
    std::vector<std::string> arguments;
    std::string message;
  };
  const std::vector<Case> cases = {
      {{"run", drive, "-o", "out", "--modelling", "g2"},
       "unknown option '--modelling'; did you mean '--modeling'?"},
      {{"run", "--modelling=g2"},
       "unknown option '--modelling'; did you mean '--modeling'?"},  // -o lacks, too
      {{"bench", "a.g2o", "--withhold", "3"},
       "unknown option '--withhold'; --withhold belongs to: convert, run"},
      {{"optimize", "a.graph", "-o", "b", "-m", "g1"}, "unknown option '-m'; -m belongs to: convert, run"},
      {{"info", "--frobnicate"}, "unknown option '--frobnicate'; 'waymark info --help' lists all options"},
      // A value may look like an option: it is not the error here.
      {{"optimize", "a.graph", "-o", "--odd", "--quite"},
       "unknown option '--quite'; did you mean '--quiet'?"},
      {{"optimize", "a.graph", "-o", "b", "-a", "dogle"},
       "unknown algorithm 'dogle'; did you mean 'dogleg'?"},
      {{"optimize", "a.graph", "-o", "b", "-s", "cholmd"},
       "unknown linear solver 'cholmd'; did you mean 'cholmod'?"},
      {{"optimize", "a.graph", "-o", "b", "--start", "spaning_tree"},
       "unknown initial guess 'spaning_tree'; did you mean 'spanning_tree'?"},
      {{"optimize", "a.graph", "-o", "b", "--algorithm-option", "initial_raduis=1"},
       "dogleg: unknown option 'initial_raduis'; did you mean 'initial_radius'?"},
      {{"optimize", "a.graph", "-o", "b", "--trusted", "EDGE_SE"},
       "--trusted: unknown edge type 'EDGE_SE'; did you mean 'EDGE_SE2'?"},
      {{"optimize", "a.graph", "-o", "b", "--covariance", "fixs"},
       "--covariance: unknown choice 'fixs'; did you mean 'fixes'?"},
      {{"run", drive, "-o", "out", "-m", "corelated"},
       "unknown GNSS modeling 'corelated'; did you mean 'correlated'?"},
      {{"run", drive, "-o", "out", "-m", "g2", "--modeling-option", "idenity_information=1"},
       "g2: unknown option 'idenity_information'; did you mean 'identity_information'?"},
      {{"run", drive, "-o", "out", "--noise", "estimte"},
       "--noise: unknown way 'estimte'; did you mean 'estimate'?"},
      {{"bench", "a.g2o", "--start", "odometri"},
       "unknown initial guess 'odometri'; did you mean 'odometry'?"},
      {{"bench", "a.g2o", "--peer", "cers"}, "unknown peer 'cers'; did you mean 'ceres'?"},
      {{"simulate", "--preset", "urbn", "-o", "out"}, "unknown preset 'urbn'; did you mean 'urban'?"},
      {{"inspect", "a.csv", "--format", "cvs"}, "unknown log format 'cvs'; did you mean 'csv'?"},
      {{"convert", "a.graph", "-o", "b", "--profile", "gtsm"},
       "--profile: unknown profile 'gtsm'; did you mean 'gtsam'?"}};
  const std::string folder = fresh_folder();
  for (const Case& c : cases) {
    const RunResult result = run(c.arguments, {.folder = folder});
    INFO(c.message << "\n" << result.err);
    CHECK(result.code == 2);
    CHECK(result.err.rfind("waymark: error: ", 0) == 0);
    CHECK(contains(result.err, c.message));
    CHECK(names_in(folder).empty());
  }
}

TEST_CASE("usage: a mistyped key is answered by the right one in every section of a drive.yaml") {
  const std::string folder = fresh_folder();
  const std::string good = read_text(write_drive(folder));
  const std::pair<const char*, const char*> cases[] = {
      {"odometri: {}\n", "unknown key 'odometri'; did you mean 'odometry'?"},
      {"time: {scael: gps}\n", "unknown key 'scael' in time; did you mean 'scale'?"},
      {"frame: {utm_zoen: 33N}\n", "unknown key 'utm_zoen' in frame; did you mean 'utm_zone'?"},
      {"gap: {polcy: bridge}\n", "unknown key 'polcy' in gap; did you mean 'policy'?"},
      {"gate: {max_angel_deg: 10}\n", "unknown key 'max_angel_deg' in gate; did you mean 'max_angle_deg'?"},
      {"modeling: {naem: g1}\n", "unknown key 'naem' in modeling; did you mean 'name'?"},
      {"calibration: {gyro_bais: constant}\n", "'gyro_bais'; did you mean 'gyro_bias'?"},
      {"sensors: [{naem: x}]\n", "unknown key 'naem' in sensors; did you mean 'name'?"}};
  for (const auto& [section, message] : cases) {
    const std::string yaml = write_text(folder + "wrong.yaml", good + section);
    const RunResult result = run({"run", yaml, "-o", folder + "out"});
    INFO(message << "\n" << result.err);
    CHECK(result.code == 3);
    CHECK(contains(result.err, message));
  }
}

TEST_CASE("usage: a plugin that cannot be loaded is a usage error that names the file") {
  const std::string folder = fresh_folder();
  const RunResult missing = run({"info", "--plugin", "missing.so"}, {.folder = folder});
  CHECK(missing.code == 2);
  CHECK(contains(missing.err, "missing.so: cannot read the plugin: No such file or directory"));

  write_text(folder + "text.so", "no library");
  const RunResult text = run({"info", "--plugin", folder + "text.so"});
  CHECK(text.code == 2);
  CHECK(contains(text.err, "text.so: is no shared object for this machine"));

  const RunResult other = run({"info", "--plugin", "libm.so.6"}, {.folder = "/lib/x86_64-linux-gnu"});
  if (!exists("/lib/x86_64-linux-gnu/libm.so.6")) {
    waymark_test::skip("no libm.so.6 to load");
    return;
  }
  CHECK(other.code == 2);
  CHECK(contains(other.err, "libm.so.6: is no waymark plugin (no symbol 'waymark_plugin')"));
}

TEST_CASE("usage: quiet prints nothing and json only json, for every subcommand") {
  const std::string folder = fresh_folder();
  const std::string drive = write_drive(folder);
  const std::vector<std::vector<std::string>> commands = {
      {"convert", drive, "-o", folder + "a.graph"},
      {"optimize", folder + "a.graph", "-o", folder + "b.graph"},
      {"evaluate", folder + "b.graph", "--truth", drive},
      {"run", drive, "--out", folder + "results"},
      {"compare", folder + "results", "-o", folder + "comparison"},
      {"info"},
      {"doctor", drive},
      {"check", folder + "b.graph"}};
  for (std::vector<std::string> arguments : commands) {
    INFO(arguments[0]);
    arguments.emplace_back("--quiet");
    const RunResult quiet = run(arguments);
    INFO(quiet.err);
    CHECK(quiet.code == 0);
    CHECK(quiet.out.empty());
    CHECK(quiet.err.empty());
    arguments.back() = "--json";
    const RunResult json = run(arguments);
    CHECK(json.code == 0);
    CHECK(nlohmann::json::accept(json.out));
    CHECK_FALSE(nlohmann::json::parse(json.out, nullptr, false).empty());
    arguments.emplace_back("--quiet");
    CHECK(nlohmann::json::accept(run(arguments).out));
  }
}

TEST_CASE("usage: progress and colours are for terminals only") {
  // Guards against log files full of escape codes and carriage returns.
  const std::string folder = fresh_folder();
  const RunResult result = run({"run", write_drive(folder), "--out", folder + "results", "-v"});
  CHECK(result.code == 0);
  CHECK(contains(result.err, "   1  "));
  for (const std::string& text : {result.out, result.err}) {
    CHECK_FALSE(contains(text, "\033"));
    CHECK_FALSE(contains(text, "\r"));
  }
}

TEST_CASE("usage: info lists what is registered, with options") {
  const auto json = nlohmann::json::parse(run({"info", "--json"}).out);
  for (const char* section : {"vertices", "edges", "modelings", "odometry_models", "algorithms", "solvers",
                              "losses", "log_formats", "graph_formats", "trajectory_formats"}) {
    INFO(section);
    CHECK_FALSE(json.at(section).empty());
  }
}

TEST_CASE("usage: a list of modelings does not swallow the drive that follows it") {
  const std::string folder = fresh_folder();
  for (const std::vector<std::string>& modelings :
       std::vector<std::vector<std::string>>{{"-m", "all"}, {"-m", "g1,g3"}, {"-m", "g1", "-m", "g2"}}) {
    std::vector<std::string> arguments = {"run"};
    arguments.insert(arguments.end(), modelings.begin(), modelings.end());
    arguments.insert(arguments.end(), {bundled_drive(), "-o", folder + "results"});
    const RunResult result = run(arguments);
    INFO(modelings.back() << ": " << result.err);
    CHECK(result.code == 0);
  }
}

TEST_CASE("usage: an option of one modeling goes to that one where all run, an unknown one is refused") {
  const std::string folder = fresh_folder();
  const RunResult known = run({"run", bundled_drive(), "--out", folder + "a", "--modeling", "all",
                               "--modeling-option", "identity_information=1e5"});
  CHECK(known.code == 0);
  const RunResult unknown = run({"run", bundled_drive(), "--out", folder + "b", "--modeling", "all",
                                 "--modeling-option", "identity=1e5"});
  CHECK(unknown.code == 2);
  CHECK(contains(unknown.err, "unknown option 'identity'"));
}

TEST_CASE("usage: check names a graph whose edges leave a vertex undetermined") {
  const std::string graph =
      write_text(fresh_folder() + "loose.graph",
                 "GRAPH 1\nVERTEX_SE2 0 0 0 0\nVERTEX_SE2 1 1 0 0\nVERTEX_XY 2 1 1\nFIX 0\n"
                 "EDGE_SE2 0 1 1 0 0 1 0 0 1 0 1\nEDGE_SE2_XY 0 2 1 1 1 0 0\n"
                 "EDGE_SE2_XY 1 2 0 1 1 0 0\n");
  const RunResult result = run({"check", graph});
  CHECK(result.code == 3);
  CHECK(contains(result.out, "so some vertex is not determined: the weakest unknown belongs to VERTEX_XY 2"));
  for (const char* algorithm : {"dogleg", "levenberg_marquardt"}) {
    const RunResult optimized = run({"optimize", graph, "-o", graph + ".out", "--algorithm", algorithm});
    INFO(optimized.err);
    CHECK(optimized.code == 0);
    CHECK(contains(optimized.err, "the minimum is not the only one"));
    CHECK(contains(optimized.err, "VERTEX_XY 2"));
  }
}

TEST_CASE("usage: optimize says that edges are wrong where the minimum is far above what they promise") {
  // 20 poses on a line, of which each edge says 1 m to 1 cm; `loop` is what the last one says of the first
  const auto optimized = [](const std::string& loop, const std::vector<std::string>& options) {
    std::string graph = "GRAPH 1\n";
    for (int i = 0; i < 20; ++i)
      graph += "VERTEX_SE2 " + std::to_string(i) + " " + std::to_string(i) + " 0 0\n";
    graph += "FIX 0\n";
    for (int i = 0; i < 19; ++i)
      graph += "EDGE_SE2 " + std::to_string(i) + " " + std::to_string(i + 1) + " 1 0 0 1e4 0 0 1e4 0 1e4\n";
    graph += "EDGE_SE2 0 19 " + loop + " 1e4 0 0 1e4 0 1e4\n";
    const std::string file = write_text(fresh_folder() + "loop.graph", graph);
    std::vector<std::string> arguments = {"optimize", file, "-o", file + ".out"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    return run(arguments);
  };
  const RunResult wrong = optimized("10 5 1", {});
  CHECK(wrong.code == 0);
  CHECK(contains(wrong.err, "some edges are wrong (try --loss cauchy:1, or --robust gnc)"));
  CHECK(contains(wrong.err, "or a lower minimum exists (try another --start or --algorithm)"));
  CHECK_FALSE(contains(optimized("19.02 0.01 0", {}).err, "warning"));
  CHECK_FALSE(contains(optimized("10 5 1", {"--loss", "cauchy:1"}).err, "some edges are wrong"));
}

}  // namespace usage_test
