// A drive with several sources on the command line: the table of sources, and errors with their place.
#include <catch2/catch.hpp>

#include <nlohmann/json.hpp>

#include "program/support/material.hpp"
#include "program/support/program.hpp"

namespace source_table_test {

using Json = nlohmann::json;

namespace {

/// A drive with three receivers, of one fix in a second each.
std::string several_sources(const std::string& folder) {
  const RunResult result =
      run({"simulate", "--preset", "three-absolute", "--duration", "120", "-o", folder + "d"});
  INFO(result.err);
  REQUIRE(result.code == 0);
  return folder + "d/drive.yaml";
}

/// The bundled recipe with these lines under `sources`.
RunResult run_with(const std::string& folder, const std::string& sources) {
  const std::string drive = write_drive(folder, {.more_yaml = "sources:\n" + sources});
  return run({"run", drive, "-o", folder + "out", "--noise", "stated"});
}

}  // namespace

TEST_CASE("sources: run prints and writes what each source contributes") {
  const std::string folder = fresh_folder();
  const std::string drive = several_sources(folder);
  const RunResult result = run({"run", drive, "-o", folder + "out", "--noise", "stated"});
  INFO(result.err);
  REQUIRE(result.code == 0);
  CHECK(contains(result.out, "RMSE without [m]"));
  const std::string page = read_text(folder + "out/report.html");
  for (const char* name : {"wheels", "front", "rear", "roof"}) {
    CHECK(contains(result.out, name));
    CHECK(contains(page, name));
  }
  const Json metrics = Json::parse(read_text(folder + "out/metrics.json"));
  const Json& sources = metrics.at("evaluations").at(0).at("sources");
  REQUIRE(sources.size() == 4);
  CHECK(sources.at(0).at("name") == "wheels");
  CHECK(sources.at(0).at("kind") == "odometry");
  CHECK(sources.at(0).at("share").is_null());  // there is no result without it
  CHECK(sources.at(0).at("without_rmse_m").is_null());
  std::size_t fixes = 0;
  for (std::size_t i = 1; i < sources.size(); ++i) {
    const Json& source = sources.at(i);
    INFO(source.dump());
    CHECK(source.at("kind") == "gnss");
    CHECK(source.at("share").get<double>() >= 0);
    CHECK(source.at("share").get<double>() <= 1);
    CHECK(source.at("availability").get<double>() > 0);
    CHECK(source.at("availability").get<double>() <= 1);
    CHECK(source.at("accepted").get<std::size_t>() <= source.at("readings").get<std::size_t>());
    CHECK(source.at("raw_rmse_m").get<double>() > 0);
    CHECK(source.at("without_sigma_m").get<double>() > 0);
    fixes += source.at("readings").get<std::size_t>();
  }
  const Json& counted = metrics.at("evaluations").at(0).at("fixes");
  CHECK(counted.at("accepted").get<std::size_t>() + counted.at("rejected").get<std::size_t>() == fixes);
  // 67 of 100 epochs.
  CHECK(sources.at(1).at("availability").get<double>() == Approx(0.67).margin(0.05));
}

TEST_CASE("sources: a drive with one odometry and one receiver has no table of sources") {
  const std::string folder = fresh_folder();
  const RunResult result = run({"run", write_drive(folder), "-o", folder + "out", "--noise", "stated"});
  REQUIRE(result.code == 0);
  CHECK_FALSE(contains(result.out, "RMSE without"));
  CHECK(Json::parse(read_text(folder + "out/metrics.json")).at("evaluations").at(0).at("sources").empty());
}

TEST_CASE("sources: what is stated wrongly for a source is refused with its place") {
  const std::string folder = fresh_folder();
  const std::string front = "  front: {kind: gnss, file: gnss.csv, ";
  check_refused(run_with(folder, front + "common: nowhere}\n"), 3,
                "common: there is no absolute source 'nowhere'");
  check_refused(run_with(folder, front + "common: front}\n"), 3, "name each other in a ring");
  check_refused(run_with(folder, front + "modeling: nothing}\n"), 3, "nothing");
  check_refused(run_with(folder, front + "modeling: {name: g2, options: {wait: 1}}}\n"), 3, "wait");
  check_refused(run_with(folder, front + "modeling: {name: g2, loss: 'couchy:1'}}\n"), 3, "couchy");
  check_refused(run_with(folder, front + "calibration: {time_ofset: constant}}\n"), 3,
                "did you mean 'time_offset'?");
  check_refused(run_with(folder, front + "calibration: {time_offset: sometimes}}\n"), 3, "sometimes");
  const std::string visual = "  visual: {kind: odometry, file: odometry.csv, ";
  check_refused(run_with(folder, visual + "model: constant_twists}\n"), 3, "did you mean 'constant_twist'?");
  check_refused(run_with(folder, visual + "options: {heading: 1}}\n"), 3, "heading");
  check_refused(run_with(folder, visual + "calibration: {gyro_bia: constant}}\n"), 3,
                "did you mean 'gyro_bias'?");
  for (const std::string& wrong :
       {front + "common: nowhere}\n", front + "modeling: nothing}\n",
        front + "calibration: {time_offset: sometimes}}\n", visual + "options: {heading: 1}}\n"})
    CHECK(contains(run_with(folder, wrong).err, "drive.yaml:"));
}

TEST_CASE(
    "sources: one of several whose log holds nothing is left out with a warning, the only one is an error") {
  const std::string folder = fresh_folder();
  const std::string drive = several_sources(folder);
  write_text(folder + "d/front.json", "{\"class\":\"TPV\",\"mode\":1,\"time\":\"2021-01-01T00:00:00Z\"}\n");
  const RunResult result = run({"convert", drive, "-o", folder + "a.graph", "--noise", "stated"});
  INFO(result.err);
  CHECK(result.code == 0);
  CHECK(contains(result.err,
                 "front.json: not one fix in 1 records (1 are marked as without a fix); front is left out"));
  std::string text = read_text(drive);
  text.replace(
      text.find("  front:"), 0,
      "  other: {kind: odometry, file: other.csv, columns: {time: time_s, speed: speed_mps, yaw_rate: "
      "yaw_rate_radps}}\n");
  write_text(drive, text);
  write_text(folder + "d/other.csv", "time_s,speed_mps,yaw_rate_radps\n");
  const RunResult silent = run({"convert", drive, "-o", folder + "b.graph", "--noise", "stated"});
  CHECK(silent.code == 0);
  CHECK(contains(silent.err, "other is left out: "));
  // A file that is wrong is an error all the same.
  write_text(folder + "d/front.json", "{\"class\":\"TPV\",\"mode\":3,\"time\":\"garbage\"}\n");
  CHECK(run({"convert", drive, "-o", folder + "c.graph"}).code == 3);
}

TEST_CASE("sources: receivers of a modeling without common errors are refused") {
  const std::string folder = fresh_folder();
  const RunResult result =
      run_with(folder, "  front: {kind: gnss, file: gnss.csv, common: gnss}\nmodeling: g1\n");
  check_refused(result, 3,
                "source 'gnss': the modeling 'g1' has no errors that sources could have in common; leave out "
                "'common'");
  CHECK(contains(result.err, "drive.yaml:6:"));
}

}  // namespace source_table_test
