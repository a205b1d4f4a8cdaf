// Calibration states from the command line and the drive.yaml, on the bundled real drive.
#include <cmath>
#include <filesystem>
#include <sstream>

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "program/support/material.hpp"
#include "program/support/program.hpp"

namespace calibration_test {

namespace {

/// Prec of the fused trajectory against truth, m.
double prec_of(const std::vector<std::string>& extra) {
  const std::string folder = fresh_folder();
  std::vector<std::string> arguments = {"run", bundled_drive(), "-o", folder + "out", "-m", "g1", "--json"};
  arguments.insert(arguments.end(), extra.begin(), extra.end());
  const RunResult result = run(arguments);
  INFO(result.err);
  REQUIRE(result.code == 0);
  const auto json = nlohmann::json::parse(result.out);
  return json["evaluations"][0]["truth"]["fused"]["position"]["precision_m"];
}

}  // namespace

TEST_CASE("calibration: the gyro's bias alone lowers Prec of the bundled drive by a fifth at least") {
  // The bias that fits this drive to its truth is 0.047 deg/s.
  CHECK(prec_of({"--calibrate", "gyro_bias=constant"}) < 0.8 * prec_of({}));
}

TEST_CASE("calibration: under a robust loss all states together lower Prec of the bundled drive") {
  const std::vector<std::string> loss = {"--gnss-loss", "cauchy:1"};
  CHECK(prec_of({"--gnss-loss", "cauchy:1", "--calibrate", "on"}) < 0.8 * prec_of(loss));
}

TEST_CASE("calibration: run reports every state with unit and sigma, in its summary as on the terminal") {
  const std::string folder = fresh_folder();
  const RunResult result = run({"run", bundled_drive(), "-o", folder + "out", "-m", "g1", "--calibrate",
                                "gyro_bias=constant,time_offset=constant"});
  REQUIRE(result.code == 0);
  CHECK(contains(result.out, "estimated state"));
  const auto summary = nlohmann::json::parse(read_text(folder + "out/summary.json"));
  const auto& states = summary["g1"]["states"];
  REQUIRE(states.size() == 2);
  CHECK(states[0]["name"] == "gyro_bias");
  CHECK(states[0]["unit"] == "rad/s");
  CHECK(states[0]["values"] == 1);
  CHECK(states[0]["sigma"].get<double>() > 0);
  CHECK(states[0]["sigma"].get<double>() < 0.01);  // of its prior
  CHECK(states[1]["name"] == "time_offset");
  // The fused graph holds the states: reading and optimising it again changes nothing.
  const RunResult again =
      run({"optimize", folder + "out/g1.fused.graph", "-o", folder + "again.graph", "--json"});
  REQUIRE(again.code == 0);
  const auto state = nlohmann::json::parse(again.out)["states"][0];
  CHECK(state["last"].get<double>() == Approx(states[0]["last"].get<double>()).epsilon(1e-4));
}

TEST_CASE(
    "calibration: the drive.yaml switches states on, the command line over it, and wrong names are placed") {
  const std::string folder = fresh_folder();
  const std::string yaml = read_text(bundled_drive());
  const std::string data = std::filesystem::path(bundled_drive()).parent_path().string();
  const auto states = [&](const std::string& lines, const std::vector<std::string>& extra) {
    const std::string drive = write_text(folder + "drive.yaml", yaml + "\n" + lines);
    std::vector<std::string> arguments = {
        "convert", drive, "-m", "g1", "--data", data, "--to", "30", "-o", folder + "out.graph", "-q"};
    arguments.insert(arguments.end(), extra.begin(), extra.end());
    const RunResult result = run(arguments);
    return result.code == 0 ? read_text(folder + "out.graph") : result.err;
  };
  CHECK_FALSE(contains(states("", {}), "VERTEX_GYRO_BIAS"));
  CHECK(contains(states("calibration: on\n", {}), "VERTEX_TIME_OFFSET"));
  CHECK_FALSE(contains(states("calibration: on\n", {"--calibrate", "off"}), "VERTEX_TIME_OFFSET"));
  CHECK(contains(states("calibration: {gyro_bias: constant}\n", {}), "VERTEX_GYRO_BIAS"));
  CHECK(contains(states("calibration: {gyro_scale: constant}\n", {}),
                 "calibration: neither the odometry model 'constant_twist' nor the GNSS modeling "
                 "has an option 'gyro_scale'"));
  CHECK(contains(states("calibration: {gyro_bias: sometimes}\n", {}),
                 "option 'gyro_bias' must be 'off' or 'constant' or 'random_walk', got 'sometimes'"));
}

TEST_CASE("options: a wrong one is told with its place in the drive.yaml, or as the command line has it") {
  const std::string folder = fresh_folder();
  const auto refused = [&](const std::string& lines, const std::vector<std::string>& extra, int code,
                           const std::string& message) {
    const std::string drive =
        write_text(folder + "a.yaml", lines + "\nodometry: {file: o.csv}\ngnss: {file: g.csv}\n");
    write_text(folder + "o.csv", "time,speed,yaw_rate\n0,1,0\n1,1,0\n");
    write_text(folder + "g.csv", "time,latitude,longitude\n0,52,13\n1,52,13\n");
    std::vector<std::string> arguments = {"convert", drive, "-o", folder + "out.graph"};
    arguments.insert(arguments.end(), extra.begin(), extra.end());
    check_refused(run(arguments), code, message);
  };
  const std::string g2 = "modeling: {name: g2, options: {identity_information: 0}}";
  const std::string rule = "g2: option 'identity_information' must lie in [1, 1e12], got ";
  refused(g2, {}, 3, folder + "a.yaml:1:54: " + rule + "0");
  refused(g2, {"--modeling-option", "identity_information=nan"}, 2,
          "error: g2: option 'identity_information' must be a number, got 'nan'");
  refused("calibration: {time_offset_sigma: 200}", {"-m", "g1"}, 3,
          folder + "a.yaml:1:34: g1: option 'time_offset_sigma' must lie in [1e-6, 100], got 200");
  refused("calibration: {gyro_bias_sigma: 20}", {"-m", "g1"}, 3,
          folder + "a.yaml:1:32: constant_twist: option 'gyro_bias_sigma' must lie in [1e-9, 10], got 20");
}

TEST_CASE("outages: the fixes of every period's end are kept out, and the pattern is checked") {
  const std::string folder = fresh_folder();
  REQUIRE(run({"convert", bundled_drive(), "-o", folder + "out.graph", "--outage", "10/30"}).code == 0);
  std::istringstream lines(read_text(folder + "out.graph"));
  std::int64_t first = 0;
  int withheld = 0;
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string tag, vertex;
    std::int64_t stamp = 0;
    if (!(words >> tag >> vertex >> stamp) || tag != "GNSS") continue;
    if (first == 0) first = stamp;
    const bool in_outage = std::fmod(static_cast<double>(stamp - first) * 1e-9, 30) >= 20;
    CHECK(contains(line, " withheld ") == in_outage);
    withheld += in_outage;
  }
  CHECK(withheld >= 50);  // ten in each of five periods
  for (const char* wrong : {"60", "60/60", "0/10", "60/x", "/"}) {
    check_refused(run({"convert", bundled_drive(), "-o", folder + "no.graph", "--outage", wrong}), 2,
                  "--outage: expected LENGTH/EVERY in seconds with 0 < LENGTH < EVERY");
  }
}

TEST_CASE("calibration: states that nothing determines: the result is written, and what lacks is said") {
  const std::string folder = fresh_folder();
  const std::string graph = write_text(
      folder + "a.graph",
      "GRAPH 1\nVERTEX_SE2 1 0 0 0\nVERTEX_SE2 2 1 0 0\nFIX 1\nVERTEX_SPEED_SCALE 3 0\nVERTEX_GYRO_BIAS 4 0\n"
      "EDGE_SE2_ODOMETRY_CALIBRATED 1 2 3 4 10 0.01 0.1 400 0 0 400 0 90000\n");
  const RunResult result =
      run({"optimize", graph, "-o", folder + "b.graph", "--start", "file", "-a", "levenberg_marquardt"});
  INFO(result.err);
  CHECK(contains(result.err, "warning: the estimated states have no sigmas"));
  CHECK(contains(read_text(folder + "b.graph"), "PROVENANCE warning the estimated states have no sigmas"));
}

TEST_CASE("calibration: a time offset without two stamped poses cannot be evaluated, and that is said") {
  const std::string folder = fresh_folder();
  const std::string graph =
      write_text(folder + "a.graph",
                 "GRAPH 1\nVERTEX_SE2 1 0 0 0\nSTAMP 1 1000000000\nVERTEX_TIME_OFFSET 2 0.1\n"
                 "GNSS 1 1000000000 0 0 1 0 1 - - - - - 1 0 0 accepted ok - -\n");
  const RunResult result = run({"evaluate", graph});
  CHECK(result.code == 3);
  CHECK(contains(result.err, "fewer than two poses have stamps of their own"));
}

}  // namespace calibration_test
