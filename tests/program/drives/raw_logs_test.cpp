// Raw logs through the program: the same drive from its logger's files and from tables extracted of them.
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include <sstream>

#include "program/support/program.hpp"
#include "support/paths.hpp"
#include "support/skip.hpp"

namespace raw_logs_test {

namespace {

using Json = nlohmann::json;

std::optional<std::string> aarhus() {
  return waymark_test::shared_data("drives/aarhus_horsens");
}

std::string example(const std::string& name) {
  return read_text(waymark_test::source_dir() + "/examples/drives/" + name);
}

/// Everything but the origin.
std::string without_provenance(const std::string& graph) {
  std::istringstream in(graph);
  std::string rest;
  for (std::string line; std::getline(in, line);) {
    if (!line.starts_with("PROVENANCE")) rest += line + "\n";
  }
  return rest;
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  REQUIRE(at != std::string::npos);
  return text.replace(at, from.size(), to);
}

const std::string kExtracted =
    "gnss:\n"
    "  file: gnss.csv\n"
    "  columns: {time: t_unix_s, latitude: lat_deg, longitude: lon_deg, accuracy: pos_acc_m, valid: valid}\n"
    "  time: {scale: unix, offset: -4.40}\n"
    "  accuracy: {meaning: drms}\n"
    "  delay: 0.3\n"
    "  withhold_every: 10\n";

}  // namespace

TEST_CASE("raw logs: Aarhus from CAN frames is Aarhus from the table extracted of them, to the last digit") {
  const auto logs = aarhus();
  if (!logs) return;
  const std::string folder = fresh_folder();
  const std::string raw = example("aarhus_horsens_raw.yaml");
  write_text(folder + "raw.yaml", raw);
  write_text(folder + "auto.yaml", replaced(raw, "format: candump", "format: auto"));
  write_text(folder + "extracted.yaml", raw.substr(0, raw.find("gnss:\n")) + kExtracted);
  for (const char* name : {"raw", "auto", "extracted"}) {
    const RunResult result = run(
        {"convert", folder + name + ".yaml", "--data", *logs, "-m", "g1", "-o", folder + name + ".graph"});
    INFO(result.err);
    REQUIRE(result.code == 0);
  }
  const std::string graph = without_provenance(read_text(folder + "raw.graph"));
  CHECK(graph.size() > 1'000'000);
  CHECK(graph == without_provenance(read_text(folder + "auto.graph")));
  CHECK(graph == without_provenance(read_text(folder + "extracted.graph")));
}

TEST_CASE("raw logs: Aarhus is as good from its raw logs as from odometry combined by others") {
  const auto logs = aarhus();
  if (!logs) return;
  const std::string folder = fresh_folder();
  write_text(folder + "raw.yaml", example("aarhus_horsens_raw.yaml"));
  write_text(folder + "combined.yaml", example("aarhus_horsens.yaml"));
  for (const char* name : {"raw", "combined"})
    REQUIRE(run({"run", folder + name + ".yaml", "--data", *logs, "-q", "-o", folder + name}).code == 0);
  const auto rmse = [&](const std::string& name) {
    const Json metrics = Json::parse(read_text(folder + name + "/metrics.json"));
    return metrics["evaluations"][0]["withheld_fixes"]["position"]["rmse_m"].get<double>();
  };
  CHECK(rmse("raw") < 1.02 * rmse("combined"));
}

TEST_CASE(
    "raw logs: sync tells the logger's clock from the frames and the lag of the fixes from the motion") {
  const auto logs = aarhus();
  if (!logs) return;
  const std::string folder = fresh_folder();
  std::string unaligned = example("aarhus_horsens_raw.yaml");
  for (int i = 0; i < 3; ++i) unaligned = replaced(unaligned, ", offset: -4.40}", "}");
  unaligned = replaced(unaligned, "delay: 0.3", "delay: 0");
  write_text(folder + "unaligned.yaml", unaligned);
  const RunResult result = run({"sync", folder + "unaligned.yaml", "--data", *logs, "--json"});
  INFO(result.err);
  REQUIRE(result.code == 0);
  const Json json = Json::parse(result.out);
  CHECK(json["clocks"][0]["ahead_s"].get<double>() == Approx(4.40).margin(0.01));
  CHECK(json["clocks"][0]["messages"] == 2272);
  CHECK(json["speed"]["late_s"].get<double>() == Approx(-0.36).margin(0.05));
  CHECK(json["speed"]["sigma_s"].get<double>() < 0.05);
  CHECK(json["speed"]["correlation"].get<double>() > 0.998);

  const RunResult table = run({"sync", folder + "unaligned.yaml", "--data", *logs});
  CHECK(contains(table.out, "its stamps are 4.398 s ahead of the GNSS time in its 2272 messages"));
  CHECK(contains(table.out, "speed_delay: -0.3"));

  // Applied: all clocks are GNSS time then.
  const RunResult applied =
      run({"convert", folder + "unaligned.yaml", "--data", *logs, "--sync", "-o", folder + "a.graph"});
  REQUIRE(applied.code == 0);
  CHECK(contains(applied.err, "the stamps were 4.398 s ahead of the GNSS time in the log; corrected"));
  CHECK(contains(applied.err, "the odometry's speed was late by 4.0"));
}

TEST_CASE("raw logs: a folder and a compressed file are logs, a log of another kind is named") {
  const std::string folder = fresh_folder();
  const std::string yaml =
      "odometry: {file: odometry.csv}\ngnss: {file: LOG, format: auto, accuracy: {default_sigma: 3}}\n";
  write_text(folder + "odometry.csv", "time,speed,yaw_rate\n0,1,0\n1,1,0\n");
  const auto error_of = [&](const std::string& file, const std::string& content) {
    if (!content.empty()) write_text(folder + file, content);
    write_text(folder + "drive.yaml", replaced(yaml, "LOG", file));
    const RunResult result = run({"convert", folder + "drive.yaml", "-o", folder + "out.graph"});
    CHECK(result.code == 3);
    return result.err;
  };
  CHECK(contains(error_of("a.mf4", "MDF     4.10"),
                 "a.mf4: the log's format is not recognised: it is an MF4 (ASAM MDF) file, which is "
                 "not supported; asammdf writes CSV from it"));
  CHECK(contains(
      error_of("a.nav", "     3.04           N: GNSS NAV DATA    M: MIXED            RINEX VERSION / TYPE\n"),
      "it is a RINEX file without observations, which is not supported; a navigation file belongs to an "
      "observation file: `navigation: FILE`"));
  CHECK(contains(
      error_of("a.txt", "Dear diary,\ntoday we drove to Horsens.\n"),
      "a.txt: the log's format is not recognised: state its 'format'; `waymark info` lists all formats"));
  CHECK(contains(error_of("absent.log", ""), "absent.log: cannot read: No such file or directory"));
  CHECK(
      contains(error_of("empty.log", "\n").substr(0, 4000), "empty.log: the log's format is not recognised"));
}

}  // namespace raw_logs_test
