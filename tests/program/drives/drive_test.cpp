// The main job as a user runs it: convert, run, evaluate, with good and bad logs.
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "program/support/material.hpp"
#include "program/support/program.hpp"
#include "support/paths.hpp"

namespace drive_test {

namespace {

using Json = nlohmann::json;

/// The drive cannot be used: exit 3 with this message from both commands, and nothing is left.
void check_refused(const std::string& folder, const std::string& message) {
  const RunResult converted = run({"convert", folder + "drive.yaml", "-o", folder + "out.graph"});
  INFO(message << "\n" << converted.err);
  CHECK(converted.code == 3);
  CHECK(contains(converted.err, "waymark: error: "));
  CHECK(contains(converted.err, message));
  CHECK_FALSE(exists(folder + "out.graph"));
  const RunResult ran = run({"run", folder + "drive.yaml", "--out", folder + "results"});
  CHECK(ran.code == 3);
  CHECK(contains(ran.err, message));
  CHECK_FALSE(exists(folder + "results"));
}

}  // namespace

TEST_CASE("drive: the bundled drive: three steps give what run gives") {
  const std::string folder = fresh_folder();
  const RunResult converted = run({"convert", bundled_drive(), "-m", "g1", "-o", folder + "drive.graph"});
  CHECK(converted.code == 0);
  CHECK(contains(converted.out, "fixes rejected"));
  CHECK(run({"optimize", folder + "drive.graph", "-o", folder + "fused.graph", "-q"}).code == 0);
  const RunResult evaluated =
      run({"evaluate", folder + "fused.graph", "--truth", bundled_drive(), "--json", "--out", folder + "e"});
  CHECK(evaluated.code == 0);
  const RunResult ran = run({"run", bundled_drive(), "--out", folder + "results", "-m", "g1,g1", "--json"});
  CHECK(ran.code == 0);
  CHECK(names_in(folder + "results") ==
        std::vector<std::string>{"figures", "g1.csv", "g1.epochs.csv", "g1.fused.graph", "g1.geojson",
                                 "g1.gpx", "g1.graph", "g1.kml", "g1.qml", "g1.tum", "metrics.json",
                                 "report.html", "summary.json"});
  CHECK(names_in(folder + "e") ==
        std::vector<std::string>{"figures", "fused.csv", "fused.epochs.csv", "fused.geojson", "fused.gpx",
                                 "fused.kml", "fused.qml", "fused.tum", "metrics.json", "report.html"});
  CHECK(read_text(folder + "drive.graph") == read_text(folder + "results/g1.graph"));
  // The graph file holds no covariances, so that the table of `evaluate` has no sigmas.
  CHECK(read_text(folder + "e/fused.tum") == read_text(folder + "results/g1.tum"));
}

TEST_CASE("drive: modelings, withheld fixes and a window of time are taken from the command line") {
  const std::string folder = fresh_folder();
  const RunResult result = run({"run", bundled_drive(), "--out", folder + "results", "-m", "all",
                                "--withhold", "5", "--from", "20", "--to", "80"});
  CHECK(result.code == 0);
  CHECK(contains(result.out, ": 60 s, "));
  CHECK(contains(result.out, "12 withheld"));
  for (const char* modeling : {"correlated", "g1", "g2", "g3"}) {
    CHECK(contains(result.out, std::string("\n") + modeling +
                                   std::string(12 - std::string(modeling).size(), ' ') + "converged"));
    CHECK(exists(folder + "results/" + modeling + ".fused.graph"));
  }
}

TEST_CASE("drive: a run that does not converge: exit 4, files and message") {
  const std::string folder = fresh_folder();
  const RunResult result =
      run({"run", write_drive(folder), "--out", folder + "results", "--max-iterations", "1",
           "--initial-guess", "dead_reckoning", "-a", "levenberg_marquardt", "-m", "g1"});
  INFO(result.out << result.err);
  CHECK(result.code == 4);
  CHECK(contains(result.out, "NOT CONVERGED in 1 iterations"));
  CHECK(contains(result.err, "warning: no minimum was reached: not converged after 1 iterations"));
  const std::string warning = "no minimum was reached: not converged after 1 iterations";
  CHECK(contains(read_text(folder + "results/g1.fused.graph"), "PROVENANCE warning " + warning));
  CHECK(contains(read_text(folder + "results/metrics.json"), warning));
  CHECK(contains(read_text(folder + "results/report.html"), warning));
}

TEST_CASE("drive: a drive.yaml from a pipe finds its logs by --data, and says where it looked otherwise") {
  const std::string folder = fresh_folder();
  write_drive(folder);
  const auto piped = [&](const std::string& options) {
    return run(
        {"-c", "\"$0\" run <(cat drive.yaml) -m g1 --out out " + options, waymark_test::program_path()},
        {.folder = folder, .program = "/bin/bash"});
  };
  const RunResult result = piped("--data .");
  INFO(result.err);
  CHECK(result.code == 0);
  CHECK(exists(folder + "out/g1.fused.graph"));
  const RunResult lost = piped("");  // names are relative to the folder of the pipe
  CHECK(lost.code == 3);
  CHECK(contains(lost.err, "/dev/fd/odometry.csv: cannot read"));
}

TEST_CASE("drive: logs that cannot be used are bad input with a reason") {
  const std::string folder = fresh_folder();
  write_drive(folder, {.empty_odometry = true});
  check_refused(folder, "odometry.csv: the log holds no records");
  write_drive(folder, {.with_fixes = false});
  check_refused(folder, "gnss.csv: the log holds no records");

  write_drive(folder);
  write_text(folder + "gnss.csv", "");
  check_refused(folder, "gnss.csv: the log is empty");

  write_drive(folder);
  write_text(folder + "odometry.csv", "time,speed,yaw_rate\n1000,ten,0\n1001,nan,0\n1002,3\n");
  check_refused(folder, "odometry.csv: none of 3 records could be used; first: ");
  check_refused(folder, "odometry.csv:2:6: speed: expected a number, got 'ten'");

  write_drive(folder);
  write_text(folder + "odometry.csv", "time,velocity,yaw_rate\n1000,10,0\n1001,10,0\n");
  check_refused(
      folder,
      "odometry.csv:1:1: no column for speed (neither 'speed' nor 'speed_mps'): name it under columns; "
      "columns present: time, velocity, yaw_rate");
}

TEST_CASE("drive: a missing log is named, and where the drive.yaml names it") {
  const std::string folder = fresh_folder();
  write_drive(folder, {.more_yaml = "folder: elsewhere\n"});
  check_refused(folder, "elsewhere/odometry.csv: cannot read: No such file or directory");
  write_text(folder + "drive.yaml", "odometry: {file: odometry.csv}\ngnss:\n  file: gone.csv\n");
  check_refused(folder, "drive.yaml:3:3: " + folder + "gone.csv: cannot read: No such file or directory");
}

TEST_CASE("drive: an error of the whole drive is told with the drive.yaml") {
  const std::string folder = fresh_folder();
  write_drive(folder);
  // one fix leaves the heading and with it a motion of the whole drive undetermined
  const std::string fixes = read_text(folder + "gnss.csv");
  const auto second_line_end = fixes.find('\n', fixes.find('\n') + 1) + 1;
  write_text(folder + "gnss.csv", fixes.substr(0, second_line_end));
  const RunResult result = run({"run", folder + "drive.yaml", "-m", "g1", "--out", folder + "out"});
  CHECK(result.code == 3);
  CHECK(contains(result.err, "waymark: error: " + folder + "drive.yaml: vertex "));
}

TEST_CASE("drive: a drive whose fixes are all rejected is bad input") {
  // Every second fix 200 m beside the way: the odometry contradicts each of them.
  const std::string folder = fresh_folder();
  write_drive(folder, {.fix_error_m = [](int t) { return t % 2 == 0 ? 200.0 : -200.0; },
                       .more_yaml = "modeling: g1\n"});
  check_refused(folder, "all 41 fixes were rejected by the gate; check the sign and unit of the yaw rate");
  CHECK(run({"convert", folder + "drive.yaml", "-o", folder + "out.graph", "--no-gate", "-q"}).code == 0);
  // The default error model has no gate.
  CHECK(run({"convert", folder + "drive.yaml", "-m", "correlated", "-o", folder + "out.graph", "-q"}).code ==
        0);
}

TEST_CASE("drive: truth that does not overlap the drive is bad input") {
  const std::string folder = fresh_folder();
  write_drive(folder, {.truth_shift_s = 86'400});
  check_refused(folder, "truth does not overlap the odometry");

  write_drive(folder);
  REQUIRE(run({"convert", folder + "drive.yaml", "-o", folder + "a.graph", "-q"}).code == 0);
  write_text(folder + "truth.tum", "5000 0 0 0 0 0 0 1\n5001 1 0 0 0 0 0 1\n");
  const RunResult result = run({"evaluate", folder + "a.graph", "--truth", folder + "truth.tum"});
  INFO(result.out << result.err);
  CHECK(result.code == 3);
  CHECK(contains(result.err,
                 "truth.tum: the truth does not overlap the trajectory: trajectory from "
                 "1000.000000000 s to 1040.000000000 s, truth from 5000.000000000 s to "
                 "5001.000000000 s on the scale 'gps'; its stamps are seconds on the scale"));
  write_drive(folder, {.truth_shift_s = 86'400});
  const RunResult apart = run({"evaluate", folder + "a.graph", "--truth", folder + "drive.yaml"});
  CHECK(apart.code == 3);
  CHECK(contains(apart.err, "drive.yaml:4:"));  // the entry of the truth
  CHECK(contains(apart.err, "truth from 87400.000000000 s to 87440.000000000 s"));
  CHECK(contains(apart.err, "check 'time: {scale, week, offset}' of the truth, and whether the graph"));
}

TEST_CASE("drive: truth of a part of the trajectory is a warning with its share, in the report too") {
  const std::string folder = fresh_folder();
  const std::string drive = write_drive(folder, {.truth_shift_s = 10});
  REQUIRE(run({"convert", drive, "-m", "g1", "-o", folder + "a.graph", "-q"}).code == 0);
  const RunResult result = run({"evaluate", folder + "a.graph", "--truth", drive, "--out", folder + "e"});
  INFO(result.err);
  CHECK(result.code == 0);
  // Fixes at 1000 .. 1040 s, truth from 1010 s: 31 of 41.
  const std::string warning =
      "the truth covers 75.6 % of the trajectory's fixes: trajectory from 1000.000000000 s to "
      "1040.000000000 s, truth from 1010.000000000 s to 1050.000000000 s";
  CHECK(contains(result.err, "warning: " + folder + "drive.yaml:4:"));
  CHECK(contains(result.err, warning));
  CHECK(contains(read_text(folder + "e/metrics.json"), warning));
  CHECK(contains(read_text(folder + "e/report.html"), "the truth covers 75.6 %"));
  // A second or so at the ends is nothing to be said.
  write_drive(folder);
  CHECK_FALSE(contains(run({"evaluate", folder + "a.graph", "--truth", drive}).err, "warning"));
}

TEST_CASE("drive: truth comes from a drive.yaml or a TUM file, with the same result") {
  const std::string folder = fresh_folder();
  const std::string drive = write_drive(folder);
  REQUIRE(run({"run", drive, "-m", "g1", "--out", folder + "r", "-q"}).code == 0);
  const std::string fused = folder + "r/g1.fused.graph";
  const auto by_yaml = run({"evaluate", fused, "--truth", drive, "--json"});
  CHECK(by_yaml.code == 0);
  // Its own trajectory as truth: no error at all.
  const auto by_tum = run({"evaluate", fused, "--truth", folder + "r/g1.tum", "--json"});
  INFO(by_tum.err);
  CHECK(by_tum.code == 0);
  const Json position = Json::parse(by_tum.out)["evaluations"][0]["truth"]["fused"]["position"];
  CHECK(position["n"] == 41);
  CHECK(position["max_m"].get<double>() < 1e-9);
  const auto no_truth = run({"evaluate", fused, "--truth", folder + "none.tum"});
  CHECK(no_truth.code == 3);
  CHECK(contains(no_truth.err, "none.tum: cannot read: No such file or directory"));
  write_text(folder + "no_truth.yaml", "odometry: {file: odometry.csv}\ngnss: {file: gnss.csv}\n");
  const auto without = run({"evaluate", fused, "--truth", folder + "no_truth.yaml"});
  CHECK(without.code == 3);
  CHECK(contains(without.err, "no_truth.yaml: has no 'truth' section"));
}

TEST_CASE("drive: evaluate names a graph without fixes, and keeps graphs of one name apart") {
  const std::string folder = fresh_folder();
  write_text(folder + "plain.graph", square_graph());
  const RunResult plain = run({"evaluate", folder + "plain.graph"});
  CHECK(plain.code == 3);
  CHECK(contains(plain.err, "plain.graph: has neither GNSS records nor poses with stamps to evaluate at"));

  const std::string drive = write_drive(folder);
  REQUIRE(run({"run", drive, "-m", "g1", "--out", folder + "x", "-q"}).code == 0);
  REQUIRE(run({"run", drive, "-m", "g1", "--out", folder + "y", "-q"}).code == 0);
  CHECK(run({"evaluate", folder + "x/g1.graph", folder + "y/g1.graph", "--out", folder + "e", "-q"}).code ==
        0);
  CHECK(exists(folder + "e/g1.csv"));
  CHECK(exists(folder + "e/g1_2.csv"));
}

TEST_CASE("drive: a wrong key of a drive.yaml is bad input that suggests the right one") {
  const std::string folder = fresh_folder();
  write_drive(folder, {.more_yaml = "gaet: {enabled: false}\n"});
  check_refused(folder, "unknown key 'gaet'; did you mean 'gate'?");
}

}  // namespace drive_test
