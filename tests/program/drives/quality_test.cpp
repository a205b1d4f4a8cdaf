// What a fix is worth, through the program: a rover's NMEA log with stretches of RTK, single and float.
#include <cmath>
#include <random>
#include <string>

#include <fmt/format.h>
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "program/support/program.hpp"

namespace quality_test {

namespace {

using Json = nlohmann::json;

constexpr double kSpeed = 8;
constexpr double kYawRate = 0.05;
constexpr double kMetresPerDegree = 111'194.9;

/// A place on the circle at second t, near 50 N 8 E: x east, y north, m.
std::pair<double, double> place_at(double t) {
  const double radius = kSpeed / kYawRate;
  return {radius * std::sin(kYawRate * t), radius * (1 - std::cos(kYawRate * t))};
}

std::string sentence(const std::string& body) {
  unsigned sum = 0;
  for (const char c : body) sum ^= static_cast<unsigned char>(c);
  return fmt::format("${}*{:02X}\n", body, sum);
}

struct Stretch {
  int quality;     ///< of GGA
  double sigma_m;  ///< true error
};
Stretch stretch_at(int second) {
  if (second < 100) return {4, 0.004};
  return second < 200 ? Stretch{1, 3} : Stretch{5, 0.3};
}

std::string nmea_log() {
  std::mt19937_64 random(4);
  std::normal_distribution<double> normal;
  const double per_degree_east = kMetresPerDegree * std::cos(50.05 * M_PI / 180);
  std::string log;
  for (int second = 0; second < 300; ++second) {
    const Stretch stretch = stretch_at(second);
    const auto [x, y] = place_at(second);
    const double north = 50.05 + (y + stretch.sigma_m * normal(random)) / kMetresPerDegree;
    const double east = 8.05 + (x + stretch.sigma_m * normal(random)) / per_degree_east;
    const std::string where = fmt::format("50{:010.7f},N,008{:010.7f},E", (north - 50) * 60, (east - 8) * 60);
    const std::string time = fmt::format("12{:02}{:02}.00", second / 60, second % 60);
    log += sentence(fmt::format("GNRMC,{},A,{},,,010420,,,A", time, where));
    log += sentence(fmt::format("GNGGA,{},{},{},12,0.8,100,M,45,M,,", time, where, stretch.quality));
  }
  return log;
}

/// Writes the logs, and a drive.yaml whose GNSS section has more lines. 2020-04-01T12:00:00Z is 1585742400.
std::string write_rover(const std::string& folder, const std::string& more) {
  std::string odometry = "time,speed,yaw_rate\n";
  std::string truth = "time,latitude,longitude\n";
  const double per_degree_east = kMetresPerDegree * std::cos(50.05 * M_PI / 180);
  for (int tick = 0; tick <= 3000; ++tick) {
    odometry += fmt::format("{:.1f},{:.3f},0.05\n", 1585742400 + 0.1 * tick, kSpeed + 0.02 * std::sin(tick));
    if (tick % 10 != 0) continue;
    const auto [x, y] = place_at(0.1 * tick);
    truth += fmt::format("{:.1f},{:.10f},{:.10f}\n", 1585742400 + 0.1 * tick, 50.05 + y / kMetresPerDegree,
                         8.05 + x / per_degree_east);
  }
  write_text(folder + "odometry.csv", odometry);
  write_text(folder + "truth.csv", truth);
  write_text(folder + "rover.nmea", nmea_log());
  write_text(folder + "drive.yaml",
             "name: rover\ntime: {scale: unix}\nodometry: {file: odometry.csv}\n"
             "gnss:\n  file: rover.nmea\n  format: nmea\n" +
                 more + "truth: {file: truth.csv}\n");
  return folder + "drive.yaml";
}

Json metrics_of(const std::string& folder) {
  return Json::parse(read_text(folder + "out/metrics.json")).at("evaluations").at(0);
}

}  // namespace

TEST_CASE("quality: RTK, single and float in one log: each stretch is as good as its fixes") {
  const std::string folder = fresh_folder();
  const RunResult result = run({"run", write_rover(folder, ""), "-o", folder + "out"});
  INFO(result.out << result.err);
  REQUIRE(result.code == 0);
  const Json metrics = metrics_of(folder);
  // With one sigma for all it is 1.334 m on a drive of this kind, and 0.98 m where the receiver was fixed.
  CHECK(metrics.at("truth").at("fused").at("position").at("rmse_m") < 0.25);
  const Json& by_quality = metrics.at("by_quality");
  REQUIRE(by_quality.size() == 3);
  for (const Json& row : by_quality) {
    CHECK(row.at("fixes") == 100);
    CHECK(row.at("fused").at("median_m") < row.at("gnss").at("median_m").get<double>() + 0.002);
  }
  CHECK(by_quality.at(2).at("quality") == "fixed");
  CHECK(by_quality.at(2).at("fused").at("rmse_m") < 0.03);
  CHECK(contains(result.err, "100 float 0.4 m, 100 fixed 0.02 m"));
  CHECK(contains(result.out, "quality of the fixes"));

  const std::string report = read_text(folder + "out/report.html");
  CHECK(contains(report, "raw GNSS, fixed"));
  CHECK(contains(report, "raw GNSS, float"));
  CHECK(contains(report, "By quality of the fixes"));
  CHECK(contains(report, "fused, fixed (100 fixes)"));

  const RunResult inspected = run({"inspect", folder + "rover.nmea"});
  CHECK(contains(inspected.out, "100 single, 100 float, 100 fixed"));
  CHECK(contains(inspected.out, "their quality stands in: single 3 m x HDOP, float 0.4 m, fixed 0.02 m"));
}

TEST_CASE("quality: the sigma stated for a quality is that of its fixes") {
  const std::string folder = fresh_folder();
  const std::string drive =
      write_rover(folder, "  accuracy: {by_quality: {fixed: 0.004, float: 0.3, single: 2.5}}\n");
  const RunResult result = run({"convert", drive, "-m", "g1", "-o", folder + "g1.graph"});
  INFO(result.err);
  REQUIRE(result.code == 0);
  CHECK(contains(result.err, "100 single 2.5 m, 100 float 0.3 m, 100 fixed 0.004 m"));
  CHECK(contains(read_text(folder + "g1.graph"), " fixed\n"));  // the graph keeps it

  write_text(folder + "drive.yaml",
             "name: a\nodometry: {file: odometry.csv}\ngnss:\n  file: rover.nmea\n"
             "  accuracy: {by_quality: {rtk: 0.02}}\n");
  const RunResult wrong = run({"convert", folder + "drive.yaml", "-o", folder + "x.graph"});
  CHECK(wrong.code != 0);
  CHECK(
      contains(wrong.err, "rtk: is no quality of a fix; known: unknown, single, differential, float, fixed"));
}

TEST_CASE("quality: two receivers in one log are refused, and 'where' takes one of them") {
  const std::string folder = fresh_folder();
  write_rover(folder, "");
  std::string both;
  std::string table = "time,latitude,longitude,accuracy,receiver\n";
  for (int second = 0; second < 300; ++second) {
    const auto [x, y] = place_at(second);
    for (const double aside : {0.0, 3.0}) {
      const double north = 50.05 + (y + aside) / kMetresPerDegree;
      const double east = 8.05 + x / (kMetresPerDegree * std::cos(50.05 * M_PI / 180));
      both += sentence(fmt::format("GNGGA,12{:02}{:02}.00,50{:010.7f},N,008{:010.7f},E,4,12,0.8,100,M,45,M,,",
                                   second / 60, second % 60, (north - 50) * 60, (east - 8) * 60));
      table += fmt::format("{},{:.9f},{:.9f},0.05,{}\n", 1585742400 + second, north, east,
                           aside > 0 ? "rear" : "front");
    }
  }
  write_text(folder + "both.nmea", both);
  write_text(folder + "both.csv", table);
  const auto run_with = [&](const std::string& gnss) {
    write_text(folder + "both.yaml",
               "name: both\ntime: {scale: unix}\nodometry: {file: odometry.csv}\ngnss: " + gnss +
                   "\ntruth: {file: truth.csv}\n");
    return run({"run", folder + "both.yaml", "-o", folder + "out"});
  };
  for (const char* gnss : {"{file: both.nmea, time: {date: 2020-04-01}}", "{file: both.csv}"}) {
    const RunResult result = run_with(gnss);
    INFO(result.err);
    CHECK(result.code == 3);
    CHECK(
        contains(result.err, "several receivers write into this log: 300 of 300 stamps have more than one"));
  }
  const RunResult front = run_with("{file: both.csv, where: receiver == front, accuracy: {meaning: 1sigma}}");
  INFO(front.err);
  REQUIRE(front.code == 0);
  CHECK(contains(front.err, "300 rows are left out by 'where'"));
  CHECK(metrics_of(folder).at("truth").at("gnss").at("position").at("rmse_m") < 0.01);
  CHECK(contains(run_with("{file: both.csv, where: reciever == front}").err,
                 "no column 'reciever' for where; did you mean 'receiver'?"));
}

}  // namespace quality_test
