#include <cmath>

#include <nlohmann/json.hpp>

#include <waymark/tools/evaluation/output/report.hpp>
#include <waymark/tools/text/json_number.hpp>

namespace waymark::evaluation {
namespace {

using Json = nlohmann::ordered_json;

Json to_json(const PositionMetrics& m) {
  return {{"n", m.count},
          {"max_m", text::number_or_null(m.max_m)},
          {"accuracy_m", text::number_or_null(m.accuracy_m)},
          {"precision_m", text::number_or_null(m.precision_m)},
          {"rmse_m", text::number_or_null(m.rmse_m)},
          {"median_m", text::number_or_null(m.median_m)},
          {"cep50_m", text::number_or_null(m.cep50_m)},
          {"cep95_m", text::number_or_null(m.cep95_m)},
          {"mean_offset_m",
           Json::array({text::number_or_null(m.mean_m.x()), text::number_or_null(m.mean_m.y())})}};
}

/// @param unit suffix of the keys: "m" or "rad"
Json to_json(const ScalarStatistics& s, const std::string& unit) {
  return {{"n", s.count},
          {"mean_" + unit, text::number_or_null(s.mean)},
          {"std_" + unit, text::number_or_null(s.deviation)},
          {"rms_" + unit, text::number_or_null(s.rms)},
          {"max_abs_" + unit, text::number_or_null(s.max_abs)}};
}

Json to_json(const SystemMetrics& m) {
  return {{"position", to_json(m.position)},
          {"along_track", to_json(m.track.along, "m")},
          {"cross_track", to_json(m.track.cross, "m")},
          {"heading", to_json(m.heading, "rad")}};
}

Json to_json(const Improvement& i) {
  return {{"max", text::number_or_null(i.max_percent)},
          {"accuracy", text::number_or_null(i.accuracy_percent)},
          {"precision", text::number_or_null(i.precision_percent)},
          {"rmse", text::number_or_null(i.rmse_percent)},
          {"median", text::number_or_null(i.median_percent)},
          {"cep50", text::number_or_null(i.cep50_percent)},
          {"cep95", text::number_or_null(i.cep95_percent)}};
}

Json to_json(const InnovationStatistics& s) {
  const auto expected = [&](double value) {
    return s.has_expectation() ? text::number_or_null(value) : Json(nullptr);
  };
  return {{"kind", to_string(s.kind)},
          {"n", s.count},
          {"undefined", s.undefined},
          {"mean", text::number_or_null(s.mean)},
          {"expected_mean", expected(InnovationStatistics::kExpectedMean)},
          {"expected_deviation_of_mean", expected(s.expected_deviation)},
          {"bound_95", InnovationStatistics::kBound95},
          {"fraction_inside", text::number_or_null(s.fraction_inside)},
          {"expected_fraction_inside", expected(InnovationStatistics::kExpectedInside)},
          {"max", text::number_or_null(s.max)}};
}

Json to_json(const TruthMatch& m) {
  return {{"matched", m.matched},
          {"unmatched", m.unmatched()},
          {"before_truth", m.before_truth},
          {"after_truth", m.after_truth},
          {"in_gap", m.in_gap},
          {"median_interval_s", text::number_or_null(m.median_interval_s)},
          {"longest_interpolated_s", text::number_or_null(m.longest_interpolated_s)}};
}

Json to_json(const Interval95& i) {
  return Json::array({text::number_or_null(i.low), text::number_or_null(i.high)});
}

Json to_json(const ConsistencyStatistics& s) {
  return {{"n", s.count},
          {"undefined", s.undefined},
          {"effective_n", text::number_or_null(s.effective_samples)},
          {"nees_mean", text::number_or_null(s.nees_mean)},
          {"expected_nees_mean", ConsistencyStatistics::kExpectedMean},
          {"honest_nees_mean", to_json(s.nees_mean_consistent)},
          {"coverage_95", text::number_or_null(s.coverage)},
          {"expected_coverage_95", ConsistencyStatistics::kExpectedCoverage},
          {"honest_coverage_95", to_json(s.coverage_consistent)},
          {"median_error_ratio", text::number_or_null(s.median_error_ratio)}};
}

Json numbers(std::span<const double> values) {
  Json list = Json::array();
  for (const double value : values) list.push_back(text::number_or_null(value));
  return list;
}

Json to_json(const OffsetTakenOut& o) {
  return {{"along_m", text::number_or_null(o.along_m)},
          {"cross_m", text::number_or_null(o.cross_m)},
          {"position", to_json(o.rest)}};
}

Json to_json(std::span<const RelativePoseError> errors) {
  Json list = Json::array();
  for (const RelativePoseError& error : errors)
    list.push_back({{"distance_m", error.distance_m},
                    {"translation", to_json(error.translation_m, "m")},
                    {"rotation", to_json(error.rotation_rad, "rad")}});
  return list;
}

Json to_json(const SpaceMetrics& m) {
  return {{"height", to_json(m.height, "m")},
          {"max_m", text::number_or_null(m.max_m)},
          {"rmse_m", text::number_or_null(m.rmse_m)},
          {"precision_m", text::number_or_null(m.precision_m)}};
}

Json to_json(const TruthEvaluation& t) {
  return {{"match", to_json(t.match)},
          {"gnss", to_json(t.gnss)},
          {"gnss_accepted", to_json(t.gnss_accepted)},
          {"fused", to_json(t.fused)},
          {"improvement_percent", to_json(t.improvement)},
          {"gnss_without_constant_offset", to_json(t.gnss_without_offset)},
          {"fused_without_constant_offset", to_json(t.fused_without_offset)},
          {"relative_pose_error", to_json(t.relative)},
          {"space", t.space ? to_json(*t.space) : Json(nullptr)},
          {"no_space", t.space ? Json(nullptr) : Json(t.no_space)},
          {"consistency", t.consistency ? to_json(*t.consistency) : Json(nullptr)},
          {"autocorrelation",
           {{"lags_s", Json(kAutocorrelationLags)},
            {"gnss", numbers(t.gnss_autocorrelation)},
            {"fused", numbers(t.fused_autocorrelation)}}}};
}

/// Returns the predictions at withheld fixes, by label.
Json predictions_json(std::span<const WithheldMetrics> at_withheld) {
  Json predictions = Json::object();
  for (const WithheldMetrics& w : at_withheld)
    predictions[w.label] = {{"at_fixes", to_json(w.at_fixes)},
                            {"at_ends", to_json(w.at_ends)},
                            {"innovation", to_json(w.innovation)}};
  return predictions;
}

/// Returns null if no fixes were kept out for a verdict.
Json held_out_json(const std::optional<HeldOut>& held) {
  if (!held) return nullptr;
  return {{"run_s", held->run_s},
          {"every_s", held->every_s},
          {"expected_rmse_m", text::number_or_null(held->expected_rmse_m)},
          {"predictions", predictions_json(held->predictions)},
          {"innovation", to_json(held->innovation)}};
}

Json to_json(const Frame& frame) {
  return {{"utm_zone", frame.zone},
          {"north", frame.north},
          {"origin_easting_m", text::number_or_null(frame.origin_easting_m)},
          {"origin_northing_m", text::number_or_null(frame.origin_northing_m)}};
}

Json to_json(const SourceComparison& comparison) {
  Json sources = Json::array();
  for (const SourceReport& s : comparison.sources)
    sources.push_back({{"name", s.name},
                       {"kind", s.kind},
                       {"readings", s.readings},
                       {"accepted", s.accepted},
                       {"availability", text::number_or_null(s.availability)},
                       {"raw_rmse_m", text::number_or_null(s.raw_rmse_m)},
                       {"residual_rms_m", text::number_or_null(s.residual_rms_m)},
                       {"share", text::number_or_null(s.share)},
                       {"without_rmse_m", text::number_or_null(s.without_rmse_m)},
                       {"without_sigma_m", text::number_or_null(s.without_sigma_m)},
                       {"without_residual_rms_m", text::number_or_null(s.without_residual_rms_m)}});
  return sources;
}

Json to_json(std::span<const QualityMetrics> by_quality) {
  Json list = Json::array();
  for (const QualityMetrics& m : by_quality)
    list.push_back({{"quality", to_string(m.quality)},
                    {"fixes", m.fixes},
                    {"accepted", m.accepted},
                    {"gnss", to_json(m.gnss)},
                    {"fused", to_json(m.fused)}});
  return list;
}

Json to_json(const LabelledEvaluation& labelled) {
  const Evaluation& e = labelled.evaluation;
  return {
      {"label", labelled.label},
      {"frame", to_json(e.frame)},
      {"fixes",
       {{"total", e.fixes()}, {"accepted", e.accepted}, {"rejected", e.rejected}, {"withheld", e.withheld}}},
      {"truth", e.truth ? to_json(*e.truth) : Json(nullptr)},
      {"withheld_fixes", e.withheld_fixes ? to_json(*e.withheld_fixes) : Json(nullptr)},
      {"outages", e.outages},
      {"withheld_predictions", predictions_json(e.at_withheld)},
      {"held_out", held_out_json(e.held_out)},
      {"innovation",
       {{"accepted", to_json(e.post_fit)},
        {"rejected", to_json(e.gated)},
        {"withheld", to_json(e.prediction)}}},
      {"by_quality", to_json(e.by_quality)},
      {"sources", to_json(e.sources)},
      {"residuals", source_residuals_json(e.residuals)},
      {"groups", grouped_residuals_json(e.groups)}};
}

}  // namespace

std::string metrics_json(std::span<const LabelledEvaluation> evaluations, const ReportHeader& header) {
  Json list = Json::array();
  for (const LabelledEvaluation& evaluation : evaluations) list.push_back(to_json(evaluation));
  const Json document = {{"schema", "waymark-metrics"},
                         {"version", 1},
                         {"drive", header.drive},
                         {"provenance", Json(header.provenance)},
                         {"evaluations", std::move(list)}};
  // A label that is no UTF-8 must not make the whole file fail.
  return document.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace waymark::evaluation
