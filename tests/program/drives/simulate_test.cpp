// `waymark simulate`: raw logs that are read like real ones and are labelled as simulated.
#include <catch2/catch.hpp>
#include <cmath>

#include <nlohmann/json.hpp>

#include "program/support/material.hpp"
#include "program/support/program.hpp"

namespace simulate_test {

using Json = nlohmann::json;

TEST_CASE("simulate: lists its presets") {
  const RunResult result = run({"simulate", "--list"});
  CHECK(result.code == 0);
  for (const char* name : {"highway", "urban", "rural", "mixed", "paper-1", "paper-8", "three-absolute"})
    CHECK(contains(result.out, name));
  const Json json = Json::parse(run({"simulate", "--list", "--json"}).out).at("presets");
  CHECK(json.size() == 16);
  CHECK(json.at(5).at("name") == "paper-1");
}

TEST_CASE("simulate: writes a drive that runs, and its logs say that they are simulated") {
  const std::string folder = fresh_folder();
  const RunResult result =
      run({"simulate", "--preset", "urban", "--duration", "120", "-o", folder + "drive"});
  INFO(result.err);
  CHECK(result.code == 0);
  CHECK(contains(result.out, "Simulated: urban, seed 1"));
  CHECK(names_in(folder + "drive") ==
        std::vector<std::string>{"drive.yaml", "gnss.json", "odometry.csv", "truth.csv"});
  CHECK(read_text(folder + "drive/drive.yaml").starts_with("# Simulated"));
  CHECK(contains(read_text(folder + "drive/drive.yaml"), "\nname: \"Simulated: urban, seed 1\"\n"));
  CHECK(read_text(folder + "drive/odometry.csv").starts_with("# Simulated"));
  CHECK(read_text(folder + "drive/truth.csv").starts_with("# Simulated"));
  CHECK(read_text(folder + "drive/gnss.json")
            .starts_with(R"x({"class":"VERSION","release":"3.22 (simulated)")x"));

  const RunResult fused = run({"run", folder + "drive/drive.yaml", "-o", folder + "out", "--modeling", "g1"});
  INFO(fused.err);
  CHECK(fused.code == 0);
  CHECK(contains(fused.out, "Simulated: urban, seed 1"));
  const Json metrics = Json::parse(read_text(folder + "out/metrics.json"));
  CHECK(metrics.at("drive") == "Simulated: urban, seed 1");
  const Json& evaluation = metrics.at("evaluations").at(0);
  CHECK(evaluation.at("truth").at("match").at("unmatched") == 0);

  // simulate and evaluate print the same statistics of the drive.
  const Json told = Json::parse(run({"inspect", folder + "drive/drive.yaml", "--json"}).out);
  CHECK(told.at("name") == "Simulated: urban, seed 1");
  CHECK(told.at("odometry_points") == 120 * 25);
  CHECK(told.at("fixes").get<int>() + told.at("missing_epochs").get<int>() == 119);
  CHECK(told.at("rejected") == evaluation.at("fixes").at("rejected"));
  const Json& raw = evaluation.at("truth").at("gnss").at("position");
  CHECK(told.at("gnss_max_m").get<double>() == Approx(raw.at("max_m").get<double>()).epsilon(1e-9));
  CHECK(told.at("gnss_accuracy_m").get<double>() == Approx(raw.at("accuracy_m").get<double>()).epsilon(1e-9));
  CHECK(told.at("gnss_precision_m").get<double>() ==
        Approx(raw.at("precision_m").get<double>()).epsilon(1e-9));
}

TEST_CASE("simulate: writes a log for each of several sources and tells their availability") {
  const std::string folder = fresh_folder();
  const RunResult result = run({"simulate", "--preset", "three-absolute", "-o", folder + "d", "--json"});
  INFO(result.err);
  REQUIRE(result.code == 0);
  CHECK(names_in(folder + "d") == std::vector<std::string>{"drive.yaml", "front.json", "rear.json",
                                                           "roof.json", "truth.csv", "wheels.csv"});
  const std::string yaml = read_text(folder + "d/drive.yaml");
  CHECK(contains(yaml, "\nsources:\n  wheels:"));
  CHECK_FALSE(contains(yaml, "\ngnss:"));
  CHECK_FALSE(contains(yaml, "\nodometry:"));
  const Json sources = Json::parse(result.out).at("sources");
  REQUIRE(sources.size() == 4);
  CHECK(sources.at(0).at("rms_m").is_null());
  CHECK(sources.at(1).at("name") == "front");
  CHECK(sources.at(1).at("availability_percent").get<double>() == Approx(67).margin(0.1));
  CHECK(contains(run({"simulate", "--preset", "correlated-receivers", "-o", folder + "c"}).out,
                 "available [%]"));
  CHECK(contains(read_text(folder + "c/drive.yaml"), "    common: rear\n"));
}

TEST_CASE(
    "simulate: every log of several sources is read on its own, with the errors that it was told to have") {
  const std::string folder = fresh_folder();
  const RunResult told = run({"simulate", "--preset", "three-absolute", "-o", folder + "d", "--json"});
  REQUIRE(told.code == 0);
  const Json sources = Json::parse(told.out).at("sources");
  const std::vector<std::string> antennas = {"[2.6, 0]", "[-0.8, 0]", "[0.9, 0.4]"};
  for (std::size_t i = 0; i < antennas.size(); ++i) {
    const Json& source = sources.at(i + 1);
    const std::string name = source.at("name");
    const std::string yaml = write_text(
        folder + "d/" + name + "_alone.yaml",
        "time: {scale: gps}\nodometry: {file: wheels.csv}\ngnss: {file: " + name +
            ".json, format: gpsd_json, period: 0, antenna: " + antennas[i] + "}\ntruth: {file: truth.csv}\n");
    const RunResult result = run({"inspect", yaml, "--json"});
    INFO(name << result.err);
    REQUIRE(result.code == 0);
    const Json read = Json::parse(result.out);
    CHECK(read.at("fixes") == source.at("readings"));
    const double rms =
        std::hypot(read.at("gnss_accuracy_m").get<double>(), read.at("gnss_precision_m").get<double>());
    // Simulate compares with exact poses, inspect with a truth that has a noise of 1 cm.
    CHECK(rms == Approx(source.at("rms_m").get<double>()).epsilon(0.01));
  }
}

TEST_CASE("simulate: writes the same bytes for the same seed, others for another") {
  const std::string folder = fresh_folder();
  for (const auto& [name, seed] : {std::pair{"a", "5"}, {"b", "5"}, {"c", "6"}})
    CHECK(run({"simulate", "--preset", "mixed", "--duration", "60", "--seed", seed, "-o", folder + name})
              .code == 0);
  for (const char* file : {"drive.yaml", "gnss.json", "odometry.csv", "truth.csv"}) {
    INFO(file);
    CHECK(read_text(folder + "a/" + file) == read_text(folder + "b/" + file));
    CHECK(read_text(folder + "a/" + file) != read_text(folder + "c/" + file));
  }
}

TEST_CASE("simulate: prints the table as JSON, and inspect that of real drives") {
  const std::string folder = fresh_folder();
  const RunResult result =
      run({"simulate", "--preset", "rural", "--duration", "60", "-o", folder + "d", "--json"});
  CHECK(result.code == 0);
  const Json json = Json::parse(result.out);
  CHECK(json.at("odometry_points") == 1500);
  CHECK(json.at("drift_percent").is_null());  // no piece of a kilometre in a minute

  const RunResult real = run({"inspect", bundled_drive()});
  CHECK(real.code == 0);
  CHECK(contains(real.out, "Potsdamer Platz"));
  CHECK(contains(real.out, "171, 0 epochs missing"));
}

TEST_CASE("inspect: drives without truth have no errors to tell of") {
  const std::string folder = fresh_folder();
  const RunResult result = run({"inspect", write_drive(folder, {.with_truth = false})});
  CHECK(result.code == 0);
  CHECK(contains(result.out, "- / - / - m"));
}

TEST_CASE("simulate: does not overwrite logs of a real drive, whatever the names of the sources") {
  const std::string folder = fresh_folder();
  write_text(folder + "visual.csv", "time_s,speed_mps,yaw_rate_radps\n1,2,3\n");
  const RunResult refused = run({"simulate", "--preset", "two-odometries", "-o", folder});
  CHECK(refused.code == 2);
  CHECK(contains(refused.err, "visual.csv: exists and was not written by simulate"));
  CHECK(names_in(folder) == std::vector<std::string>{"visual.csv"});
}

TEST_CASE("simulate: refuses what it does not know, with the remedy") {
  const std::string folder = fresh_folder();
  const RunResult unknown = run({"simulate", "--preset", "highwy", "-o", folder + "x"});
  CHECK(unknown.code == 2);
  CHECK(contains(unknown.err, "unknown preset 'highwy'; did you mean 'highway'?"));
  CHECK_FALSE(exists(folder + "x"));
  CHECK(run({"simulate"}).code == 2);
  CHECK(run({"simulate", "--preset", "urban"}).code == 2);
  CHECK(run({"simulate", "--list", "--preset", "urban"}).code == 2);
  for (const char* duration : {"0", "-5", "nan", "inf", "1e9", "abc"}) {
    INFO(duration);
    CHECK(run({"simulate", "--preset", "urban", "--duration", duration, "-o", folder + "x"}).code == 2);
  }
  for (const char* seed : {"-1", "1.5", "99999999999999999999"}) {
    INFO(seed);
    CHECK(run({"simulate", "--preset", "urban", "--seed", seed, "-o", folder + "x"}).code == 2);
  }
  CHECK_FALSE(exists(folder + "x"));
}

TEST_CASE("simulate: cannot write where there is no folder to be made") {
  const std::string folder = fresh_folder();
  const std::string file = write_text(folder + "file", "taken");
  const RunResult result = run({"simulate", "--preset", "urban", "--duration", "20", "-o", file + "/below"});
  CHECK(result.code == 5);
  CHECK(contains(result.err, "cannot make the folder"));
  RunOptions limited;
  limited.file_size_limit = 1024;
  const RunResult full =
      run({"simulate", "--preset", "urban", "--duration", "20", "-o", folder + "d"}, limited);
  CHECK(full.code == 5);
  CHECK(names_in(folder + "d").empty());
}

}  // namespace simulate_test
