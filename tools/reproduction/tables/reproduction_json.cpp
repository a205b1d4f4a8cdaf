#include <nlohmann/json.hpp>

#include <waymark/tools/reproduction/tables/reproduction_report.hpp>
#include <waymark/tools/text/json_number.hpp>

namespace waymark::reproduction {
namespace {

using Json = nlohmann::ordered_json;

Json position_json(const evaluation::PositionMetrics& m) {
  return {{"count", m.count},
          {"max_m", text::number_or_null(m.max_m)},
          {"accuracy_m", text::number_or_null(m.accuracy_m)},
          {"precision_m", text::number_or_null(m.precision_m)},
          {"rmse_m", text::number_or_null(m.rmse_m)},
          {"median_m", text::number_or_null(m.median_m)},
          {"cep50_m", text::number_or_null(m.cep50_m)},
          {"cep95_m", text::number_or_null(m.cep95_m)}};
}

Json consistency_json(const evaluation::ConsistencyStatistics& stated) {
  return {{"count", stated.count},
          {"effective_samples", text::number_or_null(stated.effective_samples)},
          {"nees_mean", text::number_or_null(stated.nees_mean)},
          {"nees_mean_honest",
           {text::number_or_null(stated.nees_mean_consistent.low),
            text::number_or_null(stated.nees_mean_consistent.high)}},
          {"coverage", text::number_or_null(stated.coverage)},
          {"coverage_honest",
           {text::number_or_null(stated.coverage_consistent.low),
            text::number_or_null(stated.coverage_consistent.high)}}};
}

Json outcome_json(const Outcome& outcome) {
  Json json = {{"setting", outcome.setting.name}};
  if (!outcome.failure.empty()) {
    json["failure"] = outcome.failure;
    return json;
  }
  const Ending& ending = outcome.ending;
  json["converged"] = ending.converged;
  json["ending"] = ending.message;
  json["steps"] = ending.iterations;
  json["rejected_steps"] = ending.rejected_steps;
  json["initial_chi2"] = text::number_or_null(ending.initial_chi2);
  json["chi2"] = text::number_or_null(ending.chi2);
  if (!outcome.setting.objective.empty()) {
    json["minimum_chi2"] = text::number_or_null(outcome.minimum_chi2);
    json["from_minimum_m"] = text::number_or_null(outcome.from_minimum.position_m);
    json["from_minimum_rad"] = text::number_or_null(outcome.from_minimum.heading_rad);
  }
  json["accepted"] = outcome.accepted;
  json["rejected"] = outcome.rejected;
  for (const drive::NoiseParameter& parameter : outcome.noise.parameters)
    json["noise"][parameter.name()] = text::number_or_null(parameter.value);
  if (!outcome.setting.evaluated) return json;
  const evaluation::Evaluation& evaluation = outcome.evaluation;
  if (evaluation.truth) {
    json["fused"] = position_json(evaluation.truth->fused.position);
    if (evaluation.truth->consistency) json["consistency"] = consistency_json(*evaluation.truth->consistency);
  }
  for (const evaluation::WithheldMetrics& withheld : evaluation.at_withheld)
    json["at_withheld_fixes"][withheld.label] = position_json(withheld.at_fixes);
  return json;
}

Json outcomes_json(const std::vector<Outcome>& outcomes) {
  Json json = Json::array();
  for (const Outcome& outcome : outcomes) json.push_back(outcome_json(outcome));
  return json;
}

Json drive_json(const DriveResult& drive) {
  Json json = {{"name", drive.name},
               {"dataset", drive.dataset > 0 ? Json(drive.dataset) : Json(nullptr)},
               {"simulated", drive.simulated},
               {"imitated_odometry", drive.imitated_odometry},
               {"group", drive.group.empty() ? Json(nullptr) : Json(drive.group)},
               {"duration_s", drive.duration_s},
               {"distance_m", drive.distance_m},
               {"fixes", drive.fixes},
               {"odometry_samples", drive.odometry_samples}};
  if (const auto raw = metrics_of(drive, "gnss")) json["gnss"] = position_json(*raw);
  json["runs"] = outcomes_json(drive.outcomes);
  json["withheld"] = Json::array();
  for (const WithheldResult& withheld : drive.withheld)
    json["withheld"].push_back({{"kept_out", withheld.way}, {"runs", outcomes_json(withheld.outcomes)}});
  return json;
}

}  // namespace

std::string report_json(const ReproductionReport& report, const std::vector<DriveResult>& drives) {
  Json json = {{"schema", "waymark-" + report.name}, {"version", 1}, {"introduction", report.introduction}};
  json["drives"] = Json::array();
  for (const DriveResult& drive : drives) json["drives"].push_back(drive_json(drive));
  json["findings"] = Json::array();
  for (const Finding& finding : report.findings) {
    Json evidence = Json::array();
    for (const Evidence& item : finding.evidence)
      evidence.push_back({{"source", item.source},
                          {"figures", item.figures},
                          {"holds", item.holds ? Json(*item.holds) : Json(nullptr)}});
    json["findings"].push_back({{"statement", finding.statement}, {"evidence", evidence}});
  }
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace waymark::reproduction
