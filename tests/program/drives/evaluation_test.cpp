// The accuracy that `run` states: on the terminal and in metrics.json, in the same numbers.
#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <sstream>
#include <vector>

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "program/support/material.hpp"
#include "program/support/program.hpp"

namespace evaluation_test {

namespace {

using Json = nlohmann::json;

/// The words of the line that begins with `start`, in the block under the heading that begins with `heading`.
std::vector<std::string> row(const std::string& text, const std::string& heading, const std::string& start) {
  const auto block = text.find("\n" + heading);
  if (block == std::string::npos) return {};
  const std::string rest = text.substr(block, text.find("\n\n", block) - block);
  const auto line = rest.find("\n" + start + "  ");
  if (line == std::string::npos) return {};
  const std::string numbers = rest.substr(line + 1 + start.size());
  std::istringstream stream(numbers.substr(0, numbers.find('\n')));
  std::vector<std::string> words;
  for (std::string word; stream >> word;) words.push_back(word);
  return words;
}

/// A cell of the table is this number, to the digits it has.
void check_cell(const std::string& cell, const Json& value) {
  INFO(cell << " against " << value);
  const auto point = cell.find('.');
  REQUIRE(point != std::string::npos);
  const double half_digit = 0.5001 * std::pow(10.0, -static_cast<double>(cell.size() - point - 1));
  CHECK(std::stod(cell) == Approx(value.get<double>()).margin(half_digit).epsilon(0));
}

}  // namespace

TEST_CASE("evaluation: run states whether its covariances are consistent, in the table and in metrics.json") {
  const std::string folder = fresh_folder();
  const RunResult result = run({"run", bundled_drive(), "-m", "g1", "--out", folder + "r"});
  REQUIRE(result.code == 0);
  const Json truth = Json::parse(read_text(folder + "r/metrics.json"))["evaluations"][0]["truth"];

  const Json& consistency = truth["consistency"];
  const auto cells = row(result.out, "stated against actual error", "g1");
  REQUIRE(cells.size() == 11);  // the two intervals are three words each
  CHECK(cells[0] == std::to_string(truth["match"]["matched"].get<int>()));
  CHECK(consistency["n"] == truth["match"]["matched"]);
  check_cell(cells[1], consistency["effective_n"]);
  check_cell(cells[2], consistency["nees_mean"]);
  check_cell(cells[3], consistency["honest_nees_mean"][0]);
  check_cell(cells[5], consistency["honest_nees_mean"][1]);
  check_cell(cells[6], 100 * consistency["coverage_95"].get<double>());
  check_cell(cells[7], 100 * consistency["honest_coverage_95"][0].get<double>());
  check_cell(cells[10], consistency["median_error_ratio"]);
  // White noise is assumed of errors that last for tens of seconds: the covariance cannot be consistent.
  CHECK(consistency["effective_n"] < 20);
  CHECK(consistency["nees_mean"] > consistency["honest_nees_mean"][1]);

  const Json& correlation = truth["autocorrelation"];
  CHECK(correlation["lags_s"] == Json({1.0, 10.0, 60.0}));
  for (const auto& [label, key] : {std::pair("raw gnss", "gnss"), std::pair("g1", "fused")}) {
    const auto numbers = row(result.out, "error autocorrelation", label);
    REQUIRE(numbers.size() == 3);
    for (std::size_t i = 0; i < 3; ++i) check_cell(numbers[i], correlation[key][i]);
  }

  // The covariances of the evaluation are not results that were asked for.
  CHECK_FALSE(contains(read_text(folder + "r/g1.fused.graph"), "\nCOVARIANCE "));
  // Asked for, they are the same ones, and a graph that has them is judged like the run.
  REQUIRE(
      run({"run", bundled_drive(), "-m", "g1", "--out", folder + "c", "--covariance", "fixes", "-q"}).code ==
      0);
  const RunResult again =
      run({"evaluate", folder + "c/g1.fused.graph", "--truth", bundled_drive(), "--json"});
  CHECK(Json::parse(again.out)["evaluations"][0]["truth"]["consistency"] == consistency);
}

TEST_CASE("outages: fused, dead reckoned and causal errors at the withheld fixes and at the ends") {
  const std::string folder = fresh_folder();
  const RunResult result =
      run({"run", bundled_drive(), "-m", "g1", "--out", folder + "r", "--outage", "10/40", "--causal"});
  INFO(result.err);
  REQUIRE(result.code == 0);
  const Json evaluation = Json::parse(read_text(folder + "r/metrics.json"))["evaluations"][0];
  const Json& predictions = evaluation["withheld_predictions"];
  CHECK(evaluation["outages"] == 4);  // 170 s
  CHECK(predictions["fused"]["at_fixes"] == evaluation["withheld_fixes"]["position"]);
  for (const auto& [label, key] :
       {std::pair("g1", "fused"), std::pair("g1, dead reckoning", "dead reckoning"),
        std::pair("g1, causal", "causal")}) {
    INFO(label);
    const Json& prediction = predictions[key];
    const auto at_fixes = row(result.out, "against withheld fixes", label);
    const auto at_ends = row(result.out, "at the end of each outage", label);
    REQUIRE(at_fixes.size() == 9);
    REQUIRE(at_ends.size() == 8);
    CHECK(at_fixes[0] == std::to_string(evaluation["fixes"]["withheld"].get<int>()));
    CHECK(at_ends[0] == "4");
    check_cell(at_fixes[1], prediction["at_fixes"]["max_m"]);
    check_cell(at_fixes[5], prediction["at_fixes"]["median_m"]);
    check_cell(at_ends[4], prediction["at_ends"]["rmse_m"]);
    const Json& inside = prediction["innovation"]["fraction_inside"];
    if (inside.is_null()) {
      CHECK(at_fixes[8] == "-");
    } else {
      check_cell(at_fixes[8], 100 * inside.get<double>());
    }
  }
  CHECK(predictions["dead reckoning"]["innovation"]["fraction_inside"].is_null());
}

TEST_CASE("evaluation: the last outage of a drive is predicted causally as the whole drive is fused") {
  // Nothing comes after it: the causal estimate there is the fused one.
  const std::string folder = fresh_folder();
  const RunResult result = run({"run", bundled_drive(), "-m", "g1", "--out", folder + "r", "--outage",
                                "20/100", "--to", "99.9", "--causal", "--json", "--tolerance", "1e-12"});
  REQUIRE(result.code == 0);
  const Json predictions = Json::parse(result.out)["evaluations"][0]["withheld_predictions"];
  CHECK(predictions["causal"]["at_fixes"]["rmse_m"].get<double>() ==
        Approx(predictions["fused"]["at_fixes"]["rmse_m"].get<double>()).epsilon(1e-6));
}

TEST_CASE("evaluation: an outage without a causal prediction is named in every file with provenance") {
  // One fix before the first outage does not determine a heading.
  const std::string folder = fresh_folder();
  const RunResult result = run({"run", write_drive(folder, {.seconds = 8}), "-m", "g1", "--out", folder + "r",
                                "--outage", "1/2", "--causal"});
  INFO(result.err);
  CHECK(result.code == 0);
  const std::string warning = "no causal prediction for the outage that ends at epoch 1: ";
  CHECK(contains(result.err, "warning: " + warning));
  CHECK(contains(read_text(folder + "r/g1.fused.graph"), "PROVENANCE warning " + warning));
  CHECK(contains(read_text(folder + "r/metrics.json"), warning));
  CHECK(contains(read_text(folder + "r/report.html"), warning));
}

TEST_CASE(
    "evaluation: without truth a second fusion predicts fixes that were kept out, as well as they are") {
  // White errors of 1 m to the east only, so 1 m RMS, whatever is stated of them.
  const std::string folder = fresh_folder();
  const std::string drive =
      write_drive(folder, {.seconds = 900, .with_truth = false, .fix_error_m = [](int second) {
                             std::mt19937_64 random(static_cast<std::uint64_t>(second) + 7);
                             return std::normal_distribution<double>()(random);
                           }});
  const RunResult result = run({"run", drive, "-m", "g1", "--no-gate", "--out", folder + "r"});
  INFO(result.err);
  REQUIRE(result.code == 0);
  const Json held = Json::parse(read_text(folder + "r/metrics.json"))["evaluations"][0]["held_out"];
  const Json& fused = held["predictions"]["fused"]["at_fixes"];
  CHECK(fused["n"] == 90);  // a tenth
  CHECK(fused["rmse_m"].get<double>() == Approx(1).margin(0.25));
  const auto verdict =
      result.out.find("There is no truth to compare with. A second fusion predicts 90 fixes");
  REQUIRE(verdict != std::string::npos);
  CHECK(result.out.ends_with("\nRead on in " + folder + "r/report.html\n"));
  CHECK(contains(result.out, "written:\n  " + folder + "r/report.html\n"));
  CHECK(contains(read_text(folder + "r/report.html"), "Stated errors</h2>"));
}

TEST_CASE("evaluation: without truth the innovations of errors that last are as large as promised") {
  const std::string folder = fresh_folder();
  // 60 fixes in 12 runs, so the mean of three drives is known to a third or so.
  double sum = 0;
  for (const std::string seed : {"1", "3", "4"}) {
    const std::string drive = folder + seed;
    REQUIRE(run({"simulate", "--preset", "rural", "--seed", seed, "-o", drive}).code == 0);
    const std::string yaml = read_text(drive + "/drive.yaml");
    write_text(drive + "/drive.yaml", yaml.substr(0, yaml.find("truth:")));
    const RunResult result = run({"run", drive + "/drive.yaml", "--out", folder + "r"});
    INFO(result.err);
    REQUIRE(result.code == 0);
    const Json held = Json::parse(read_text(folder + "r/metrics.json"))["evaluations"][0]["held_out"];
    const Json& innovation = held["innovation"];
    CHECK(innovation["n"] == 60);
    sum += innovation["mean"].get<double>();
    // Both are over the same fixes: the promise is that of the innovations.
    const double rmse_m = held["predictions"]["with lasting errors"]["at_fixes"]["rmse_m"];
    CHECK(held["expected_rmse_m"].get<double>() == Approx(rmse_m).epsilon(0.5));
    CHECK(contains(result.out, "m is expected). The mean NIS is "));
  }
  CHECK(sum / 3 == Approx(2).margin(0.8));
}

TEST_CASE("evaluation: run says why nothing is kept out") {
  const std::string folder = fresh_folder();
  const std::string drive = write_drive(folder, {.seconds = 60, .with_truth = false});
  const RunResult result = run({"run", drive, "--out", folder + "r"});
  REQUIRE(result.code == 0);
  CHECK(contains(result.err,
                 "note: the result is not judged by fixes that are kept out: only 5 fixes could be "
                 "kept out, and 10 are needed\n"));
}

TEST_CASE("evaluation: nothing is kept out of a drive that has truth or withheld fixes") {
  const std::string folder = fresh_folder();
  for (const bool with_truth : {true, false}) {
    const std::string drive = write_drive(folder, {.seconds = 120, .with_truth = with_truth});
    REQUIRE(
        run({"run", drive, "-m", "g1", "--withhold", with_truth ? "0" : "5", "--out", folder + "r"}).code ==
        0);
    CHECK(Json::parse(read_text(folder + "r/metrics.json"))["evaluations"][0]["held_out"].is_null());
  }
}

TEST_CASE("evaluation: a graph without normal equations has no matrices, and report and metrics say so") {
  const std::string folder = fresh_folder();
  REQUIRE(run({"run", write_drive(folder), "-m", "g1", "--out", folder + "r", "-q"}).code == 0);
  // A point that is seen in one direction: nothing determines its distance.
  const std::string graph =
      write_text(folder + "lone.graph", read_text(folder + "r/g1.fused.graph") +
                                            "VERTEX_SE2 900000 0 0 0\nFIX 900000\nVERTEX_XY 900001 1 1\n"
                                            "EDGE_BEARING_SE2_XY 900000 900001 0.7 1\n");
  const RunResult result = run({"evaluate", graph, "--out", folder + "e"});
  INFO(result.err);
  CHECK(result.code == 0);
  const std::string warning = "the report has no matrices: ";
  CHECK(contains(result.err, "warning: " + warning));
  CHECK(contains(read_text(folder + "e/metrics.json"), warning));
  CHECK(contains(read_text(folder + "e/report.html"), warning));
}

TEST_CASE("evaluation: causal predictions without outages are refused") {
  const std::string folder = fresh_folder();
  const RunResult refused = run({"run", bundled_drive(), "-m", "g1", "--out", folder + "r", "--causal"});
  CHECK(refused.code == 2);
  CHECK(contains(refused.err, "--causal: there are no outages to predict; name them with --outage"));
  CHECK_FALSE(exists(folder + "r"));
}

namespace {

/// Statistics of the columns of epochs.csv; fields of the bundled drive hold no separators.
struct EpochsTable {
  explicit EpochsTable(const std::string& text) {
    std::istringstream stream(text);
    std::string line;
    std::getline(stream, line);
    names = split(line);
    while (std::getline(stream, line)) rows.push_back(split(line));
  }
  static std::vector<std::string> split(const std::string& line) {
    std::vector<std::string> fields(1);
    for (const char c : line) {
      if (c == ',') {
        fields.emplace_back();
      } else {
        fields.back() += c;
      }
    }
    return fields;
  }
  [[nodiscard]] std::vector<double> column(const std::string& name) const {
    const auto place = std::find(names.begin(), names.end(), name) - names.begin();
    std::vector<double> values;
    for (const auto& row : rows) {
      const std::string& field = row.at(static_cast<std::size_t>(place));
      if (!field.empty()) values.push_back(std::stod(field));
    }
    return values;
  }
  [[nodiscard]] double mean_square(const std::string& name) const {
    const auto values = column(name);
    double sum = 0;
    for (const double value : values) sum += value * value;
    return sum / static_cast<double>(values.size());
  }
  std::vector<std::string> names;
  std::vector<std::vector<std::string>> rows;
};

}  // namespace

TEST_CASE("evaluation: epochs.csv holds what metrics.json is made of") {
  const std::string folder = fresh_folder();
  REQUIRE(run({"run", bundled_drive(), "-m", "g1", "--out", folder, "-q"}).code == 0);
  const EpochsTable epochs(read_text(folder + "g1.epochs.csv"));
  const Json evaluation = Json::parse(read_text(folder + "metrics.json"))["evaluations"][0];
  const Json& truth = evaluation["truth"];
  CHECK(epochs.rows.size() == evaluation["fixes"]["total"]);
  for (const char* system : {"gnss", "fused"}) {
    const std::string name = system;
    const Json& metrics = truth[name];
    const double square = epochs.mean_square(name + "_east_m") + epochs.mean_square(name + "_north_m");
    CHECK(std::sqrt(square) == Approx(metrics["position"]["rmse_m"].get<double>()));
    const double along = epochs.mean_square(name + "_along_m");
    const double cross = epochs.mean_square(name + "_cross_m");
    CHECK(std::sqrt(along) == Approx(metrics["along_track"]["rms_m"].get<double>()));
    CHECK(std::sqrt(cross) == Approx(metrics["cross_track"]["rms_m"].get<double>()));
    CHECK(epochs.column(name + "_along_m").size() == metrics["along_track"]["n"]);
  }
  constexpr double kDegree = 3.14159265358979323846 / 180;
  CHECK(std::sqrt(epochs.mean_square("heading_error_deg")) * kDegree ==
        Approx(truth["fused"]["heading"]["rms_rad"].get<double>()));
  const auto nees = epochs.column("nees");
  CHECK(std::accumulate(nees.begin(), nees.end(), 0.0) / static_cast<double>(nees.size()) ==
        Approx(truth["consistency"]["nees_mean"].get<double>()));
  CHECK(nees.size() == truth["consistency"]["n"]);
  CHECK(epochs.column("covariance_xx_m2").size() == epochs.rows.size());
}

}  // namespace evaluation_test
