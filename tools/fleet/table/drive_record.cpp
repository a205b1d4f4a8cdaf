#include <waymark/tools/fleet/table/drive_record.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <nlohmann/json.hpp>

#include <waymark/core/base/angle.hpp>
#include <waymark/core/base/error.hpp>
#include <waymark/formats/text/text_file.hpp>
#include <waymark/tools/evaluation/output/metrics_reader.hpp>
#include <waymark/tools/evaluation/output/result_folder.hpp>
#include <waymark/tools/text/json_number.hpp>
#include <waymark/tools/text/json_place.hpp>

namespace waymark::fleet {
namespace {

using evaluation::Evaluation;
using evaluation::kUndefined;
using evaluation::RunEnding;

constexpr std::array<std::pair<DriveState, const char*>, 3> kStateWords = {
    {{DriveState::done, "done"},
     {DriveState::not_converged, "not converged"},
     {DriveState::failed, "failed"}}};

double count_of(std::size_t count) {
  return static_cast<double>(count);
}

/// Returns a metric of the fused positions against truth.
template <double evaluation::PositionMetrics::*metric>
double fused(const Evaluation& e, const RunEnding*) {
  return e.truth ? e.truth->fused.position.*metric : kUndefined;
}

double held_out(const Evaluation& e, double value) {
  return e.held_out && !e.held_out->predictions.empty() ? value : kUndefined;
}

using Metrics = evaluation::PositionMetrics;

const std::array kColumns = {
    Column{"fixes", "Fixes of the drive.",
           [](const Evaluation& e, const RunEnding*) { return count_of(e.fixes()); }},
    Column{"rejected", "Fixes that the gate rejected.",
           [](const Evaluation& e, const RunEnding*) { return count_of(e.rejected); }},
    Column{"epochs", "Epochs that are compared with the truth.",
           [](const Evaluation& e, const RunEnding*) {
             return e.truth ? count_of(e.truth->match.matched) : kUndefined;
           }},
    Column{"gnss_rmse_m", "Root mean square error of the raw fixes against truth, metres.",
           [](const Evaluation& e, const RunEnding*) {
             return e.truth ? e.truth->gnss.position.rmse_m : kUndefined;
           }},
    Column{"rmse_m", "The same of the fused positions.", fused<&Metrics::rmse_m>},
    Column{"median_m", "Median error of the fused positions.", fused<&Metrics::median_m>},
    Column{"cep95_m", "Radius that holds 95 % of the fused positions.", fused<&Metrics::cep95_m>},
    Column{"max_m", "Largest error of the fused positions.", fused<&Metrics::max_m>},
    Column{"accuracy_m", "Length of their mean error.", fused<&Metrics::accuracy_m>},
    Column{"precision_m", "Their deviation from the mean error.", fused<&Metrics::precision_m>},
    Column{"heading_rms_deg", "Root mean square error of the headings, degrees.",
           [](const Evaluation& e, const RunEnding*) {
             return e.truth ? e.truth->fused.heading.rms / kDegree : kUndefined;
           }},
    Column{"improvement_percent", "Reduction of the root mean square error by the fusion.",
           [](const Evaluation& e, const RunEnding*) {
             return e.truth ? e.truth->improvement.rmse_percent : kUndefined;
           }},
    Column{"nees_mean", "Mean normalised squared error of the fused positions; consistent: 2.",
           [](const Evaluation& e, const RunEnding*) {
             return e.truth && e.truth->consistency ? e.truth->consistency->nees_mean : kUndefined;
           }},
    Column{"coverage_95", "Share of the errors inside the 95 % ellipses.",
           [](const Evaluation& e, const RunEnding*) {
             return e.truth && e.truth->consistency ? e.truth->consistency->coverage : kUndefined;
           }},
    Column{"held_out_rmse_m", "Distance of fixes that a second fusion did not know, root mean square.",
           [](const Evaluation& e, const RunEnding*) {
             return held_out(e, e.held_out ? e.held_out->fused().at_fixes.rmse_m : kUndefined);
           }},
    Column{"held_out_expected_m", "The same as the covariances promise it.",
           [](const Evaluation& e, const RunEnding*) {
             return held_out(e, e.held_out ? e.held_out->expected_rmse_m : kUndefined);
           }},
    Column{"iterations", "Steps of the optimizer.",
           [](const Evaluation&, const RunEnding* ending) {
             return ending != nullptr ? count_of(ending->iterations) : kUndefined;
           }},
    Column{"chi2", "chi2 at the end.", [](const Evaluation&, const RunEnding* ending) {
             return ending != nullptr ? ending->final_chi2 : kUndefined;
           }}};

std::string text_or_empty(const std::map<std::string, std::string>& texts, const std::string& key) {
  const auto found = texts.find(key);
  return found == texts.end() ? "" : found->second;
}

/// A run without a minimum says why in its summary.
void add_reason(const std::string& modeling, const RunEnding& ending, DriveRecord& record) {
  if (ending.converged || record.state == DriveState::done) return;
  record.reason += (record.reason.empty() ? "" : "; ") + modeling + ": " + ending.message;
}

nlohmann::ordered_json row_json(const ModelingRow& row) {
  nlohmann::ordered_json json = {{"modeling", row.modeling}};
  for (std::size_t c = 0; c < kColumns.size(); ++c)
    json[kColumns[c].name] = text::number_or_null(row.numbers[c]);
  return json;
}

ModelingRow read_row(const text::JsonPlace& json) {
  ModelingRow row{json.text("modeling"), {}};
  for (const Column& column : kColumns)
    row.numbers.push_back(json.has(column.name) ? json.number(column.name) : kUndefined);
  return row;
}

DriveState state_of(const text::JsonPlace& json) {
  const std::string word = json.text();
  for (const auto& [state, known] : kStateWords)
    if (word == known) return state;
  json.expected("done, not converged or failed");
}

}  // namespace

std::string to_string(DriveState state) {
  for (const auto& [value, word] : kStateWords)
    if (value == state) return word;
  return {};
}

std::span<const Column> columns() {
  return kColumns;
}

double ModelingRow::number(std::string_view column) const {
  for (std::size_t c = 0; c < kColumns.size(); ++c)
    if (column == kColumns[c].name) return numbers[c];
  throw UsageError("the table of a fleet has no column '" + std::string(column) + "'");
}

double ModelingRow::error_m() const {
  const double against_truth = number("rmse_m");
  return std::isfinite(against_truth) ? against_truth : number("held_out_rmse_m");
}

std::string ModelingRow::error_measure() const {
  if (std::isfinite(number("rmse_m"))) return "truth";
  return std::isfinite(number("held_out_rmse_m")) ? "held-out fixes" : "";
}

void add_results(const std::string& folder, DriveRecord& record) {
  const evaluation::ResultFolder results(folder);
  const evaluation::MetricsDocument metrics =
      evaluation::read_metrics_json(formats::read_text_file(results.metrics()), results.metrics());
  const auto endings =
      evaluation::read_run_summary(formats::read_text_file(results.summary()), results.summary());
  record.title = metrics.header.drive;
  for (const evaluation::LabelledEvaluation& of : metrics.evaluations) {
    const auto ending = endings.find(of.label);
    const RunEnding* known = ending == endings.end() ? nullptr : &ending->second;
    record.environment = text_or_empty(metrics.header.provenance, of.label + ".environment");
    if (known != nullptr) add_reason(of.label, *known, record);
    ModelingRow row{of.label, {}};
    for (const Column& column : kColumns) row.numbers.push_back(column.value(of.evaluation, known));
    record.rows.push_back(std::move(row));
  }
}

std::string record_json(const DriveRecord& record) {
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (const ModelingRow& row : record.rows) rows.push_back(row_json(row));
  const nlohmann::ordered_json json = {{"schema", "waymark-fleet-drive"},
                                       {"version", 1},
                                       {"drive", record.drive},
                                       {"fingerprint", record.fingerprint},
                                       {"label", record.label},
                                       {"program", record.program},
                                       {"state", to_string(record.state)},
                                       {"exit_code", record.exit_code},
                                       {"reason", record.reason},
                                       {"title", record.title},
                                       {"environment", record.environment},
                                       {"rows", std::move(rows)},
                                       {"cost",
                                        {{"wall_s", record.cost.wall_s},
                                         {"processor_s", record.cost.processor_s},
                                         {"memory_bytes", record.cost.memory_bytes},
                                         {"machine", record.cost.machine},
                                         {"ended_s", record.cost.ended_s}}}};
  return json.dump(1, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

DriveRecord read_record(const std::string& file) {
  const nlohmann::ordered_json document = text::parse_json(formats::read_text_file(file), file);
  const text::JsonPlace json(document, file);
  if (json.text("schema") != "waymark-fleet-drive") json.at("schema").expected("\"waymark-fleet-drive\"");
  if (json.number("version") != 1) json.at("version").expected("version 1");
  DriveRecord record{.drive = json.text("drive"),
                     .fingerprint = json.text("fingerprint"),
                     .label = json.text("label"),
                     .program = json.text("program"),
                     .state = state_of(json.at("state")),
                     .exit_code = static_cast<int>(json.count("exit_code")),
                     .reason = json.text("reason"),
                     .title = json.text("title"),
                     .environment = json.text("environment")};
  for (const text::JsonPlace& row : json.at("rows").items()) record.rows.push_back(read_row(row));
  const text::JsonPlace cost = json.at("cost");
  record.cost = {cost.number("wall_s"), cost.number("processor_s"),
                 static_cast<std::uint64_t>(cost.count("memory_bytes")), cost.text("machine"),
                 cost.number("ended_s")};
  return record;
}

}  // namespace waymark::fleet
