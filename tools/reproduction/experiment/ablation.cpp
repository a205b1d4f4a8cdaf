#include <cmath>

#include <waymark/tools/reproduction/experiment/ablation.hpp>
#include <waymark/tools/reproduction/tables/convergence_tables.hpp>
#include <waymark/tools/text/number_text.hpp>

namespace waymark::reproduction {
namespace {

Ablation switched(const std::string& title, const std::string& name, Setting setting) {
  setting.name += "/" + name;
  return {title, std::move(setting)};
}

/// Returns the default model with stated options of its modeling.
Ablation with_options(const std::string& title, const std::string& name, const Options& options) {
  Setting setting = default_setting();
  setting.fusion.modeling_options = options;
  return switched(title, name, std::move(setting));
}

/// Returns the default model without one of its calibration states.
Ablation without_state(const std::string& title, const std::string& state) {
  Setting setting = default_setting();
  setting.fusion.calibration = drive::default_calibration();
  setting.fusion.calibration->erase(state);
  return switched(title, "no_" + state, std::move(setting));
}

template <typename Change>
Ablation with_change(const std::string& title, const std::string& name, Change change) {
  Setting setting = default_setting();
  change(setting.fusion);
  return switched(title, name, std::move(setting));
}

std::vector<Ablation> ingredients() {
  return {
      {"default", default_setting()},
      without_state("no gyro bias", "gyro_bias"),
      without_state("no speed scale", "speed_scale"),
      without_state("no latency", "time_offset"),
      with_options("no lasting part (multipath_sigma 1 mm)", "no_multipath", {{"multipath_sigma", "0.001"}}),
      with_options("no slow bias (bias_floor 1 cm, bias_share 0)", "no_bias",
                   {{"bias_floor", "0.01"}, {"bias_share", "0"}}),
      with_options("normal instead of Student's t", "normal", {{"tails", "normal"}}),
      with_options("claimed accuracy ignored (exponent 0)", "accuracy_ignored", {{"accuracy_exponent", "0"}}),
      with_options("claimed accuracy as claimed (exponent 1)", "accuracy_claimed",
                   {{"accuracy_exponent", "1"}}),
      with_options("time constant 30 s", "time_30", {{"multipath_time", "30"}}),
      with_change("noise as stated", "noise_stated",
                  [](drive::FusionSettings& fusion) { fusion.estimates_noise = false; }),
      with_change("with the paper's gate", "gate",
                  [](drive::FusionSettings& fusion) { fusion.gate.enabled = true; }),
      with_change("dead-reckoned initial guess", "dead_reckoning",
                  [](drive::FusionSettings& fusion) {
                    fusion.initial_guess.method = drive::StartMethod::dead_reckoning;
                  }),
  };
}

/// Returns g1 with calibration states and no gate.
Setting white_noise() {
  Setting setting = stated_setting("white", "g1");
  setting.fusion.gate.enabled = false;
  setting.fusion.calibration = drive::default_calibration();
  return setting;
}

/// Returns losses with customary scales: 95 % efficiency for normal errors in one dimension, or
/// else 1 standard deviation.
std::vector<std::string> customary_losses() {
  return {"huber:1.345", "cauchy:1", "geman_mcclure:1", "welsch:2.985", "dcs:1", "tukey:4.685"};
}

std::vector<Ablation> alternatives() {
  std::vector<Ablation> rows;
  Setting reference = our_settings().front();
  rows.push_back({"white noise, paper's gate, no calibration (g1)", reference});
  rows.push_back(switched("white noise, calibration: squared", "squared", white_noise()));
  for (const std::string& loss : customary_losses()) {
    Setting setting = white_noise();
    setting.fusion.loss = loss;
    rows.push_back(
        switched("white noise, calibration: " + loss, loss.substr(0, loss.find(':')), std::move(setting)));
  }
  Setting graduated = white_noise();
  graduated.outliers = OutlierTreatment::graduation;
  rows.push_back(switched("white noise, calibration: GNC", "gnc", graduated));
  Setting gated = white_noise();
  gated.fusion.gate.enabled = true;
  rows.push_back(switched("white noise, calibration: paper's gate", "gate", gated));
  gated.fusion.gate.chord_s = 5;
  gated.fusion.gate.max_chord_s = 10;
  rows.push_back(switched("white noise, calibration: gate over 5 s", "gate_5s", gated));
  Setting inflated = white_noise();
  inflated.outliers = OutlierTreatment::inflation;
  rows.push_back(switched("white noise, calibration: adaptive inflation", "inflation", inflated));
  return rows;
}

const std::vector<Outcome>& judged(const DriveResult& drive) {
  return drive.outcomes.empty() && !drive.withheld.empty() ? drive.withheld.front().outcomes : drive.outcomes;
}

/// Returns the drive, and how it is judged if that is not by truth.
std::string column_label(const DriveResult& drive) {
  return drive.outcomes.empty() && !drive.withheld.empty()
             ? labelled(drive) + ": " + drive.withheld.front().way
             : labelled(drive);
}

const Outcome* outcome_of(const DriveResult& drive, const std::string& setting) {
  const Outcome* outcome = find_outcome(judged(drive), setting);
  return outcome != nullptr && outcome->failure.empty() ? outcome : nullptr;
}

using Drives = std::vector<DriveResult>;

/// Returns a table with a line for each ablation and a column for each drive.
template <typename Value>
text::Table table_of(const Drives& drives, const std::string& file, const std::string& title, int digits,
                     Value value) {
  text::Table table;
  table.file = file;
  table.title = title;
  table.columns = {"switched"};
  for (const DriveResult& drive : drives) table.columns.push_back(column_label(drive));
  for (const Ablation& ablation : ablations()) {
    text::Row row{ablation.title};
    for (const DriveResult& drive : drives)
      row.push_back(text::decimals(value(drive, ablation.setting.name), digits));
    table.rows.push_back(row);
  }
  return table;
}

std::vector<double> rms_errors(const Drives& drives, const std::string& setting) {
  std::vector<double> errors;
  for (const DriveResult& drive : drives) errors.push_back(judged_errors(drive, setting).rmse_m);
  return errors;
}

/// Adds changes against the default, and for the alternatives also against the reference
/// of the field.
void add_changes(const Drives& drives, text::Table& table) {
  table.columns.emplace_back("change %, mean");
  table.columns.emplace_back("against g1 with gate %, mean");
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    const std::vector<double> errors = rms_errors(drives, ablations()[i].setting.name);
    for (const std::string& reference : {std::string(kDefaultModel), std::string(kWhiteReference)})
      table.rows[i].push_back(text::decimals(mean_change_percent(errors, rms_errors(drives, reference)), 1));
  }
}

void note_failures(const Drives& drives, text::Table& table) {
  for (const DriveResult& drive : drives) {
    for (const Outcome& outcome : judged(drive)) {
      if (!outcome.failure.empty())
        table.notes.push_back(labelled(drive) + ", " + outcome.setting.name + ": " + outcome.failure);
      else if (!outcome.ending.converged)
        table.notes.push_back(labelled(drive) + ", " + outcome.setting.name +
                              ": no minimum was reached: " + outcome.ending.message);
    }
  }
}

text::Table error_table(const Drives& drives) {
  text::Table table = table_of(drives, "ablation_error", "RMS errors, m", 2,
                               [](const DriveResult& drive, const std::string& setting) {
                                 return judged_errors(drive, setting).rmse_m;
                               });
  add_changes(drives, table);
  table.notes = {
      "Errors against truth. If the name of the drive says so, they are at withheld fixes and "
      "contain the errors of those. Positive changes are worse. Means are of the logarithms "
      "of the ratios.",
      "white noise: modeling g1, the claimed covariances as they are, noise as stated. GNC: "
      "outliers among the fixes found by graduated non-convexity. adaptive inflation: a second "
      "pass, which multiplies the covariance of each fix by the mean of nu / 2 of the fixes within "
      "15 s if that is above 1."};
  note_failures(drives, table);
  return table;
}

}  // namespace

const std::vector<Ablation>& ablations() {
  static const std::vector<Ablation> all = [] {
    std::vector<Ablation> rows = ingredients();
    for (Ablation& row : alternatives()) rows.push_back(std::move(row));
    return rows;
  }();
  return all;
}

evaluation::PositionMetrics judged_errors(const DriveResult& drive, const std::string& setting) {
  const Outcome* outcome = outcome_of(drive, setting);
  if (outcome == nullptr) return {};
  if (outcome->evaluation.truth) return outcome->evaluation.truth->fused.position;
  for (const evaluation::WithheldMetrics& at : outcome->evaluation.at_withheld) {
    if (at.label == "fused") return at.at_fixes;
  }
  return {};
}

evaluation::ConsistencyStatistics judged_stated_errors(const DriveResult& drive, const std::string& setting) {
  const Outcome* outcome = outcome_of(drive, setting);
  if (outcome == nullptr || !outcome->evaluation.truth) return {};
  return outcome->evaluation.truth->consistency.value_or(evaluation::ConsistencyStatistics());
}

std::vector<Setting> ablation_settings() {
  std::vector<Setting> settings;
  for (const Ablation& ablation : ablations()) {
    settings.push_back(ablation.setting);
    settings.back().objective.clear();  // their ends are not compared
  }
  return settings;
}

double mean_change_percent(const std::vector<double>& errors, const std::vector<double>& references) {
  double sum = 0;
  double count = 0;
  for (std::size_t i = 0; i < errors.size(); ++i) {
    const double change = std::log(errors[i] / references[i]);
    if (!std::isfinite(change)) continue;
    sum += change;
    ++count;
  }
  return count > 0 ? 100 * std::expm1(sum / count) : evaluation::kUndefined;
}

ReproductionReport ablation_report(const Drives& drives, const std::string& introduction) {
  ReproductionReport report;
  report.name = "ablation";
  report.title = "One part changed at a time";
  report.introduction = introduction;
  report.tables.push_back(error_table(drives));
  report.tables.push_back(table_of(drives, "ablation_max", "Largest errors, m", 2,
                                   [](const DriveResult& drive, const std::string& setting) {
                                     return judged_errors(drive, setting).max_m;
                                   }));
  Drives with_truth;
  for (const DriveResult& drive : drives) {
    if (metrics_of(drive, "gnss")) with_truth.push_back(drive);
  }
  if (!with_truth.empty()) {
    report.tables.push_back(table_of(with_truth, "ablation_nees",
                                     "Mean NEES, drives with truth; 2 if covariances are consistent", 2,
                                     [](const DriveResult& drive, const std::string& setting) {
                                       return judged_stated_errors(drive, setting).nees_mean;
                                     }));
    report.tables.push_back(table_of(with_truth, "ablation_coverage",
                                     "Truth within the stated 95 % regions, percent", 0,
                                     [](const DriveResult& drive, const std::string& setting) {
                                       return 100 * judged_stated_errors(drive, setting).coverage;
                                     }));
  }
  report.runs = run_table(drives);
  return report;
}

}  // namespace waymark::reproduction
