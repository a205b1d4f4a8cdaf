#include <waymark/tools/evaluation/output/metrics_reader.hpp>
#include <waymark/tools/text/json_place.hpp>

namespace waymark::evaluation {
namespace {

constexpr int kVersion = 1;

std::pair<double, double> two_numbers(const text::JsonPlace& json) {
  const std::vector<text::JsonPlace> items = json.items();
  if (items.size() != 2) json.expected("two numbers");
  return {items[0].number(), items[1].number()};
}

PositionMetrics position(const text::JsonPlace& json) {
  PositionMetrics m;
  m.count = json.count("n");
  m.max_m = json.number("max_m");
  m.accuracy_m = json.number("accuracy_m");
  m.precision_m = json.number("precision_m");
  m.rmse_m = json.number("rmse_m");
  m.median_m = json.number("median_m");
  m.cep50_m = json.number("cep50_m");
  m.cep95_m = json.number("cep95_m");
  const auto [x, y] = two_numbers(json.at("mean_offset_m"));
  m.mean_m = {x, y};
  return m;
}

/// @param unit suffix of the keys: "m" or "rad"
ScalarStatistics scalar(const text::JsonPlace& json, const std::string& unit) {
  ScalarStatistics s;
  s.count = json.count("n");
  s.mean = json.number("mean_" + unit);
  s.deviation = json.number("std_" + unit);
  s.rms = json.number("rms_" + unit);
  s.max_abs = json.number("max_abs_" + unit);
  return s;
}

SpaceMetrics space(const text::JsonPlace& json) {
  return {.height = scalar(json.at("height"), "m"),
          .max_m = json.number("max_m"),
          .rmse_m = json.number("rmse_m"),
          .precision_m = json.number("precision_m")};
}

SystemMetrics system(const text::JsonPlace& json) {
  return {position(json.at("position")),
          {scalar(json.at("along_track"), "m"), scalar(json.at("cross_track"), "m")},
          scalar(json.at("heading"), "rad")};
}

Improvement improvement_of(const text::JsonPlace& json) {
  return {json.number("max"),    json.number("accuracy"), json.number("precision"), json.number("rmse"),
          json.number("median"), json.number("cep50"),    json.number("cep95")};
}

/// @param kind kind of the fixes at this place
InnovationStatistics innovation(const text::JsonPlace& json, ResidualKind kind) {
  InnovationStatistics s;
  s.kind = kind;
  s.count = json.count("n");
  s.undefined = json.count("undefined");
  s.mean = json.number("mean");
  s.expected_deviation = json.number("expected_deviation_of_mean");
  s.fraction_inside = json.number("fraction_inside");
  s.max = json.number("max");
  return s;
}

Interval95 interval(const text::JsonPlace& json) {
  const auto [low, high] = two_numbers(json);
  return {low, high};
}

ConsistencyStatistics consistency(const text::JsonPlace& json) {
  ConsistencyStatistics s;
  s.count = json.count("n");
  s.undefined = json.count("undefined");
  s.effective_samples = json.number("effective_n");
  s.nees_mean = json.number("nees_mean");
  s.nees_mean_consistent = interval(json.at("honest_nees_mean"));
  s.coverage = json.number("coverage_95");
  s.coverage_consistent = interval(json.at("honest_coverage_95"));
  s.median_error_ratio = json.number("median_error_ratio");
  return s;
}

std::vector<double> numbers(const text::JsonPlace& json) {
  std::vector<double> values;
  for (const text::JsonPlace& item : json.items()) values.push_back(item.number());
  return values;
}

OffsetTakenOut offset_taken_out(const text::JsonPlace& json) {
  return {json.number("along_m"), json.number("cross_m"), position(json.at("position"))};
}

std::vector<RelativePoseError> relative_errors(const text::JsonPlace& json) {
  std::vector<RelativePoseError> errors;
  for (const text::JsonPlace& item : json.items())
    errors.push_back(
        {item.number("distance_m"), scalar(item.at("translation"), "m"), scalar(item.at("rotation"), "rad")});
  return errors;
}

/// Files of this version without offsets taken out and relative errors exist.
TruthEvaluation truth(const text::JsonPlace& json) {
  TruthEvaluation t;
  const text::JsonPlace match = json.at("match");
  t.match.matched = match.count("matched");
  t.match.before_truth = match.count("before_truth");
  t.match.after_truth = match.count("after_truth");
  t.match.in_gap = match.count("in_gap");
  t.match.median_interval_s = match.number("median_interval_s");
  t.match.longest_interpolated_s = match.number("longest_interpolated_s");
  t.gnss = system(json.at("gnss"));
  t.gnss_accepted = system(json.at("gnss_accepted"));
  t.fused = system(json.at("fused"));
  t.improvement = improvement_of(json.at("improvement_percent"));
  if (json.has("gnss_without_constant_offset"))
    t.gnss_without_offset = offset_taken_out(json.at("gnss_without_constant_offset"));
  if (json.has("fused_without_constant_offset"))
    t.fused_without_offset = offset_taken_out(json.at("fused_without_constant_offset"));
  if (json.has("relative_pose_error")) t.relative = relative_errors(json.at("relative_pose_error"));
  if (json.has("space")) t.space = space(json.at("space"));
  if (json.has("no_space")) t.no_space = json.text("no_space");
  if (json.has("consistency")) t.consistency = consistency(json.at("consistency"));
  t.gnss_autocorrelation = numbers(json.at("autocorrelation").at("gnss"));
  t.fused_autocorrelation = numbers(json.at("autocorrelation").at("fused"));
  return t;
}

Frame frame(const text::JsonPlace& json) {
  return {static_cast<int>(json.count("utm_zone")), json.at("north").flag(), json.number("origin_easting_m"),
          json.number("origin_northing_m")};
}

std::vector<WithheldMetrics> predictions(const text::JsonPlace& json) {
  std::vector<WithheldMetrics> result;
  for (const std::string& label : json.keys()) {
    const text::JsonPlace p = json.at(label);
    result.push_back({label, position(p.at("at_fixes")), position(p.at("at_ends")),
                      innovation(p.at("innovation"), ResidualKind::prediction)});
  }
  return result;
}

HeldOut held_out(const text::JsonPlace& json) {
  HeldOut held{.run_s = json.number("run_s"), .every_s = json.number("every_s")};
  held.predictions = predictions(json.at("predictions"));
  held.innovation = innovation(json.at("innovation"), ResidualKind::prediction);
  held.expected_rmse_m = json.number("expected_rmse_m");
  return held;
}

/// Files of this version without outages and predictions exist, because these were added later.
LabelledEvaluation labelled(const text::JsonPlace& json) {
  Evaluation e;
  e.frame = frame(json.at("frame"));
  const text::JsonPlace fixes = json.at("fixes");
  e.accepted = fixes.count("accepted");
  e.rejected = fixes.count("rejected");
  e.withheld = fixes.count("withheld");
  if (json.has("truth")) e.truth = truth(json.at("truth"));
  if (json.has("withheld_fixes")) e.withheld_fixes = system(json.at("withheld_fixes"));
  if (json.has("outages")) e.outages = json.count("outages");
  if (json.has("withheld_predictions")) e.at_withheld = predictions(json.at("withheld_predictions"));
  if (json.has("held_out")) e.held_out = held_out(json.at("held_out"));
  const text::JsonPlace innovations = json.at("innovation");
  e.post_fit = innovation(innovations.at("accepted"), ResidualKind::post_fit);
  e.gated = innovation(innovations.at("rejected"), ResidualKind::gated);
  e.prediction = innovation(innovations.at("withheld"), ResidualKind::prediction);
  return {json.text("label"), std::move(e)};
}

}  // namespace

MetricsDocument read_metrics_json(std::string_view text, const std::string& name) {
  const nlohmann::ordered_json document = text::parse_json(text, name);
  const text::JsonPlace json(document, name);
  const text::JsonPlace schema = json.at("schema");
  if (schema.text() != "waymark-metrics") schema.expected("\"waymark-metrics\"");
  const text::JsonPlace version = json.at("version");
  if (version.number() != kVersion) version.expected("version 1");
  MetricsDocument result;
  result.header.drive = json.text("drive");
  const text::JsonPlace provenance = json.at("provenance");
  for (const std::string& key : provenance.keys()) result.header.provenance[key] = provenance.text(key);
  for (const text::JsonPlace& evaluation : json.at("evaluations").items())
    result.evaluations.push_back(labelled(evaluation));
  return result;
}

}  // namespace waymark::evaluation
