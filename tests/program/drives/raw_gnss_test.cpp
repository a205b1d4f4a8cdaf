// Drives whose only GNSS is the raw measurements of a receiver, and what `inspect` tells of such logs.
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "program/support/program.hpp"
#include "support/skip.hpp"

namespace raw_gnss_test {

namespace {

using Json = nlohmann::json;

/// The first ten seconds of the receiver in Berlin, 5 epochs a second, with its ephemerides and odometry, in a folder.
std::optional<std::string> berlin() {
  const std::string data = "drives/berlin_potsdamer_platz_raw/";
  const auto observations = waymark_test::shared_data(data + "rover.obs");
  if (!observations) return std::nullopt;
  const std::string folder = fresh_folder();
  const std::string text = read_text(*observations);
  const std::size_t end = text.find("\n 16  6  6 11 10 52");
  REQUIRE(end != std::string::npos);
  write_text(folder + "rover.obs", text.substr(0, end + 1));
  write_text(folder + "brdc.16n", read_text(*waymark_test::shared_data(data + "brdc1580.16n")));
  write_text(folder + "brdc.16g", read_text(*waymark_test::shared_data(data + "brdc1580.16g")));
  std::string odometry = "time,speed,yaw_rate\n";
  for (int k = 0; k < 120; ++k)  // of the GPS week 1900
    odometry += std::to_string(1149246641 + k / 10) + "." + std::to_string(k % 10) + ",1,0\n";
  write_text(folder + "odometry.csv", odometry);
  return folder;
}

std::size_t occurrences(const std::string& text, const std::string& word) {
  std::size_t count = 0;
  for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) ++count;
  return count;
}

}  // namespace

TEST_CASE("raw gnss: the short form with a navigation file gives the edges of the sensor gnss_raw") {
  const auto folder = berlin();
  if (!folder) return;
  const auto convert = [&](const std::string& name, const std::string& gnss) {
    write_text(*folder + name + ".yaml", "odometry: {file: odometry.csv}\n" + gnss);
    const RunResult result = run({"convert", *folder + name + ".yaml", "-o", *folder + name + ".graph"});
    INFO(result.err);
    REQUIRE(result.code == 0);
    return read_text(*folder + name + ".graph");
  };
  const std::string brief = convert("brief", "gnss: {file: rover.obs, navigation: [brdc.16n, brdc.16g]}\n");
  const std::string sensor =
      convert("sensor", "sensors: {name: gnss_raw, file: rover.obs, navigation: [brdc.16n, brdc.16g]}\n");
  const std::string pseudorange = "\nEDGE_GNSS_PSEUDORANGE ";
  CHECK(occurrences(brief, pseudorange) > 400);
  CHECK(occurrences(brief, pseudorange) == occurrences(sensor, pseudorange));
  // GPS alone has fewer.
  const std::string gps = convert("gps", "gnss: {file: rover.obs, navigation: brdc.16n}\n");
  CHECK(occurrences(gps, pseudorange) > 200);
  CHECK(occurrences(gps, pseudorange) < occurrences(brief, pseudorange));
}

TEST_CASE(
    "raw gnss: a navigation file that is missing, wrong or of another day ends with its name and the remedy") {
  const auto folder = berlin();
  if (!folder) return;
  const auto error = [&](const std::string& gnss) {
    write_text(*folder + "drive.yaml", "odometry: {file: odometry.csv}\ngnss: " + gnss + "\n");
    const RunResult result = run({"convert", *folder + "drive.yaml", "-o", *folder + "out.graph"});
    CHECK(result.code == 3);
    return result.err;
  };
  CHECK(contains(error("{file: rover.obs}"), "name the broadcast ephemerides beside it, 'navigation: FILE'"));
  CHECK(contains(error("{file: rover.obs, navigation: absent.nav}"), "absent.nav: cannot read"));
  CHECK(contains(error("{file: rover.obs, navigation: rover.obs}"),
                 "rover.obs:1: this is an observation file"));
  CHECK(contains(error("{file: brdc.16n, navigation: brdc.16n}"),
                 "brdc.16n: the log's format is not recognised: it is a RINEX file without observations"));
  std::string text = read_text(*folder + "brdc.16n");
  for (std::size_t at = text.find(" 16  6  6 "); at != std::string::npos; at = text.find(" 16  6  6 ", at))
    text.replace(at, 10, " 16  6  2 ");
  write_text(*folder + "other.16n", text);
  const std::string message = error("{file: rover.obs, navigation: other.16n}");
  CHECK(contains(message, "rover.obs: no satellite has a usable ephemeris from 2016-06-06T11:10:41"));
  CHECK(contains(message, "other.16n has them from"));
}

TEST_CASE("raw gnss: inspect counts the satellites of an observation file and proposes the entry") {
  const auto folder = berlin();
  if (!folder) return;
  const RunResult text = run({"inspect", *folder + "rover.obs"});
  INFO(text.out << text.err);
  CHECK(text.code == 0);
  CHECK(contains(text.out, "rinex"));
  CHECK(contains(text.out, "G12"));
  CHECK(contains(text.out + text.err,
                 "raw measurements need the broadcast ephemerides of the day: gnss: {file: "));
  const Json json = Json::parse(run({"inspect", *folder + "rover.obs", "--json"}).out);
  const Json& raw = json["logs"][0]["raw"];
  CHECK(raw["epochs"] == 48);
  CHECK(raw["satellites"]["G12"]["pseudoranges"] == 48);
  CHECK(raw["satellites"]["G12"]["mean_cn0_dbhz"].get<double>() == Approx(49.8).margin(0.05));
}

TEST_CASE("raw gnss: a run tells the residuals, C/N0 and place of each satellite, and errors in space") {
  const auto folder = berlin();
  if (!folder) return;
  write_text(*folder + "truth.csv",
             read_text(*waymark_test::shared_data("drives/berlin_potsdamer_platz/truth_5hz.csv")));
  write_text(
      *folder + "drive.yaml",
      "odometry: {file: odometry.csv}\ngnss: {file: rover.obs, navigation: [brdc.16n, brdc.16g]}\n"
      "truth:\n  file: truth.csv\n  time: {week: 1900}\n  columns: {time: gps_sow_s, latitude: lat_deg, "
      "longitude: lon_deg, height: h_m, heading: heading_rad_ccw_from_east}\n");
  const RunResult result = run({"run", *folder + "drive.yaml", "-o", *folder + "out"});
  INFO(result.out << result.err);
  REQUIRE(result.code == 0);
  CHECK(contains(result.out, "satellites of "));
  CHECK(contains(result.out, "GLONASS"));
  CHECK(contains(result.out, "against truth, in space"));
  const Json metrics = Json::parse(read_text(*folder + "out/metrics.json"))["evaluations"][0];
  CHECK(metrics["truth"]["space"]["height"]["n"] > 30);
  CHECK(metrics["truth"]["space"]["rmse_m"] > metrics["truth"]["fused"]["position"]["rmse_m"]);
  REQUIRE(metrics["groups"].size() == 1);
  CHECK(metrics["groups"][0]["one"] == "satellite");
  std::size_t pseudoranges = 0;
  std::size_t best = 0;
  for (const Json& satellite : metrics["groups"][0]["groups"]) {
    pseudoranges += satellite["quantities"][0]["measurements"].get<std::size_t>();
    if (satellite["name"] != "G12") continue;
    best = satellite["quantities"][0]["measurements"];
    CHECK(satellite["mean_signal"].get<double>() == Approx(49.8).margin(0.1));
    CHECK(satellite["highest_elevation_rad"].get<double>() > 0.5);
  }
  CHECK(best == 48);
  for (const Json& residuals : metrics["residuals"])
    if (residuals["edge"] == "EDGE_GNSS_PSEUDORANGE") CHECK(residuals["measurements"] == pseudoranges);
  const std::string page = read_text(*folder + "out/report.html");
  for (const char* part : {"Measurements by satellite", "sky-pseudorange", "sky-range-rate",
                           "pseudorange-gps", "range-rate-glonass", "c-n0-gps", "error-height"})
    CHECK(contains(page, part));
  // A truth without heights says what to do.
  std::string text = read_text(*folder + "drive.yaml");
  text.erase(text.find("height: h_m, "), 13);
  write_text(*folder + "flat.yaml", text);
  CHECK(contains(run({"run", *folder + "flat.yaml", "-o", *folder + "flat"}).out,
                 "no errors in space: the truth has no heights"));
}

}  // namespace raw_gnss_test
