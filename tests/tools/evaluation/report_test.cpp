#include <numbers>
#include <sstream>
#include <string>
#include <vector>

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include <waymark/tools/evaluation/output/report.hpp>

namespace report_test {

using namespace waymark;
using namespace waymark::evaluation;
using Catch::Matchers::Contains;

namespace {

/// Three fixes 2 m off, fused `offset` m off, heading error 1 degree; the last fix as `last`.
Evaluation drive(double offset, FixStatus last = FixStatus::accepted) {
  EvaluationInput input;
  for (int i = 0; i < 3; ++i) {
    const Stamp stamp{1'000'000'000LL * i};
    Fix fix;
    fix.stamp = stamp;
    fix.position = {10.0 * i, 2};
    input.fixes.push_back(fix);
    input.fused.push_back({.stamp = stamp, .pose = {10.0 * i, offset, std::numbers::pi / 180}});
    input.truth.push_back({.stamp = stamp, .position = {10.0 * i, 0}, .heading_rad = 0.0});
  }
  input.fixes.back().status = last;
  return evaluate(input);
}

std::vector<std::string> lines(const std::string& text) {
  std::vector<std::string> out;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) out.push_back(line);
  return out;
}

std::size_t count_lines_starting(const std::string& text, const std::string& start) {
  std::size_t count = 0;
  for (const std::string& line : lines(text)) count += line.starts_with(start) ? 1 : 0;
  return count;
}

}  // namespace

TEST_CASE("metrics table: the table: raw gnss, then the modelings, then improvements, aligned") {
  const std::vector<LabelledEvaluation> evaluations{{"g1", drive(1)}, {"g2", drive(0.5)}, {"g3", drive(3)}};
  const auto rows = lines(metrics_table(evaluations));
  REQUIRE(rows.size() > 9);
  CHECK(rows[0] ==
        "against truth  n  Max [m]  Acc [m]  Prec [m]  RMSE [m]  median [m]  CEP50 [m]  CEP95 [m]");
  CHECK(rows[1] ==
        "raw gnss       3    2.000    2.000     0.000     2.000       2.000      2.000      2.000");
  CHECK(rows[2] ==
        "g1             3    1.000    1.000     0.000     1.000       1.000      1.000      1.000");
  CHECK_THAT(rows[3], Catch::StartsWith("g2             3    0.500"));
  CHECK_THAT(rows[4], Catch::StartsWith("g3             3    3.000"));
  CHECK(rows[5].empty());
  CHECK_THAT(rows[6], Catch::StartsWith("improvement over raw gnss  Max [%]"));
  CHECK_THAT(rows[7], Catch::StartsWith("g1                           50.00    50.00         -"));
  CHECK_THAT(rows[8], Catch::StartsWith("g2                           75.00"));
  CHECK_THAT(rows[9], Catch::StartsWith("g3                          -50.00"));
}

TEST_CASE("metrics table: the table has track, heading, innovation and counts") {
  const std::string text = metrics_table(std::vector<LabelledEvaluation>{{"g1", drive(1)}});
  CHECK_THAT(text, Contains("along / across track"));
  CHECK_THAT(text, Contains("1.000      1.000\n"));  // heading rms and max in degrees
  CHECK_THAT(text, Contains("g1, post-fit residuals"));
  CHECK_THAT(text, !Contains("withheld fixes"));
  CHECK_THAT(text, Contains("rejected [%]"));
}

TEST_CASE("metrics table: raw rows appear once unless they differ") {
  const std::vector<LabelledEvaluation> same{{"g1", drive(1)}, {"g2", drive(0)}};
  CHECK(count_lines_starting(metrics_table(same), "raw gnss") == 3);  // truth, track, autocorrelation
  const std::vector<LabelledEvaluation> gated{{"g1", drive(1)}, {"g2", drive(0, FixStatus::rejected)}};
  const std::string text = metrics_table(gated);
  CHECK_THAT(text, Contains("raw gnss, accepted (g2)  2"));
}

TEST_CASE("metrics table: withheld fixes have their own block, without truth too") {
  Evaluation evaluation = drive(1, FixStatus::withheld);
  evaluation.truth.reset();
  const std::string text = metrics_table(std::vector<LabelledEvaluation>{{"g1", evaluation}});
  CHECK_THAT(text, !Contains("against truth"));
  CHECK_THAT(text, Catch::StartsWith("against withheld fixes  n"));
  CHECK_THAT(text, Contains("g1, innovations"));
}

TEST_CASE("metrics table: tables of nothing do not crash") {
  CHECK(metrics_table({}).empty());
  CHECK(metrics_table(std::vector<LabelledEvaluation>{{"g1", Evaluation{}}}).empty());
}

TEST_CASE("metrics.json: schema, values, null for undefined, exact doubles") {
  Evaluation evaluation = drive(0.1);
  evaluation.truth->fused.position.max_m = 0.1 + 0.2;
  const std::vector<LabelledEvaluation> evaluations{{"g1", evaluation}, {"empty", Evaluation{}}};
  const auto json = nlohmann::json::parse(
      metrics_json(evaluations, {.drive = "nagoya", .provenance = {{"version", "0.1.0"}}}));
  CHECK(json["schema"] == "waymark-metrics");
  CHECK(json["version"] == 1);
  CHECK(json["drive"] == "nagoya");
  CHECK(json["provenance"]["version"] == "0.1.0");
  REQUIRE(json["evaluations"].size() == 2);

  const auto& g1 = json["evaluations"][0];
  CHECK(g1["label"] == "g1");
  CHECK(g1["fixes"]["total"] == 3);
  CHECK(g1["truth"]["match"]["matched"] == 3);
  CHECK(g1["truth"]["fused"]["position"]["max_m"].get<double>() == 0.1 + 0.2);
  CHECK(g1["truth"]["gnss"]["position"]["accuracy_m"] == 2.0);
  CHECK(g1["truth"]["gnss"]["position"]["mean_offset_m"][1] == 2.0);
  CHECK(g1["truth"]["improvement_percent"]["precision"].is_null());  // raw precision is zero
  CHECK(g1["truth"]["fused"]["heading"]["rms_rad"].get<double>() == Approx(std::numbers::pi / 180));
  CHECK(g1["truth"]["gnss"]["heading"]["rms_rad"].is_null());
  CHECK(g1["innovation"]["accepted"]["n"] == 3);
  CHECK(g1["innovation"]["accepted"]["kind"] == "post-fit residuals");
  CHECK(g1["withheld_fixes"].is_null());
  CHECK(json["evaluations"][1]["truth"].is_null());
}

TEST_CASE("metrics table: metrics.json without a header has empty objects, not lists") {
  const auto json = nlohmann::json::parse(metrics_json({}));
  CHECK(json["evaluations"].is_array());
  CHECK(json["provenance"].is_object());
}

}  // namespace report_test
