#include <waymark/tools/reproduction/tables/drive_tables.hpp>
#include <waymark/tools/text/number_text.hpp>

namespace waymark::reproduction {
namespace {

using Drives = std::vector<DriveResult>;
using text::Row;

void add_position(const evaluation::PositionMetrics& m, Row& row) {
  for (const double value : {m.max_m, m.accuracy_m, m.precision_m, m.rmse_m, m.cep95_m})
    row.push_back(text::decimals(value, 2));
}

const char* reached_word(const Outcome& outcome) {
  const bool alone = outcome.setting.objective.empty();  // there is nothing to compare its end with
  return (alone ? outcome.ending.converged : near_minimum(outcome)) ? "yes" : "no";
}

void add_consistency(const std::optional<evaluation::ConsistencyStatistics>& stated, Row& row) {
  if (!stated) return row.resize(row.size() + 3, "-");
  row.push_back(text::decimals(stated->nees_mean, 1));
  row.push_back(text::decimals(stated->nees_mean_consistent.low, 1) + " to " +
                text::decimals(stated->nees_mean_consistent.high, 1));
  row.push_back(text::decimals(100 * stated->coverage, 0));
}

Row failed_row(const DriveResult& drive, const Outcome& outcome, std::size_t cells, text::Table& table) {
  Row row{labelled(drive), outcome.setting.name};
  row.resize(cells, "-");
  table.notes.push_back(labelled(drive) + ", " + outcome.setting.name + ": " + outcome.failure);
  return row;
}

}  // namespace

text::Table overview_table(const Drives& drives) {
  text::Table table;
  table.file = "drives_overview";
  table.title = "The drives";
  table.columns = {"Drive", "s", "km", "fixes", "odometry", "rejected %"};
  for (const DriveResult& drive : drives) {
    const Outcome* gated = find_outcome(drive.outcomes, "ours_g2");
    const bool known = gated != nullptr && gated->failure.empty();
    table.rows.push_back({labelled(drive), text::decimals(drive.duration_s, 0),
                          text::decimals(drive.distance_m / 1000, 2), std::to_string(drive.fixes),
                          std::to_string(drive.odometry_samples),
                          text::decimals(known ? gated->rejected_percent() : evaluation::kUndefined, 1)});
  }
  return table;
}

text::Table truth_table(const Drives& drives) {
  text::Table table;
  table.file = "drives_truth";
  table.title = "Drives with truth: errors in metres";
  table.columns = {"Drive",
                   "system",
                   "Max",
                   "Acc",
                   "Prec",
                   "RMSE",
                   "CEP95",
                   "rejected %",
                   "minimum reached",
                   "NEES",
                   "consistent NEES",
                   "95 % coverage"};
  table.notes = {
      "NEES: error against truth in units of the stated covariance, 2 if the covariances are "
      "consistent. consistent NEES: interval of 95 of 100 drives with consistent covariances, from "
      "the effective number of independent epochs."};
  for (const DriveResult& drive : drives) {
    const auto raw = metrics_of(drive, "gnss");
    if (!raw) continue;
    Row row{labelled(drive), "raw"};
    add_position(*raw, row);
    row.resize(table.columns.size(), "-");
    table.rows.push_back(row);
    for (const Outcome& outcome : drive.outcomes) {
      if (!outcome.setting.evaluated) continue;
      if (!outcome.failure.empty()) {
        table.rows.push_back(failed_row(drive, outcome, table.columns.size(), table));
        continue;
      }
      Row fused{labelled(drive), outcome.setting.name};
      add_position(outcome.evaluation.truth->fused.position, fused);
      fused.push_back(text::decimals(outcome.rejected_percent(), 1));
      fused.push_back(reached_word(outcome));
      add_consistency(outcome.evaluation.truth->consistency, fused);
      table.rows.push_back(fused);
    }
  }
  return table;
}

namespace {

const evaluation::WithheldMetrics* find_prediction(const Outcome& outcome, const std::string& label) {
  for (const evaluation::WithheldMetrics& at : outcome.evaluation.at_withheld) {
    if (at.label == label) return &at;
  }
  return nullptr;
}

void add_withheld(const evaluation::WithheldMetrics& withheld, Row& row) {
  const evaluation::PositionMetrics& m = withheld.at_fixes;
  row.push_back(std::to_string(m.count));
  for (const double value : {m.median_m, m.rmse_m, m.max_m, m.cep95_m})
    row.push_back(text::decimals(value, 2));
}

/// Adds the result of odometry alone in the outages. It begins at the last fix before each outage,
/// with the same fused poses for all systems.
void add_dead_reckoning(const DriveResult& drive, const WithheldResult& way, text::Table& table) {
  const Outcome* from = find_outcome(way.outcomes, "ours_g2");
  const evaluation::WithheldMetrics* reckoned =
      from != nullptr ? find_prediction(*from, "dead reckoning") : nullptr;
  if (reckoned == nullptr) return;
  Row row{labelled(drive), way.way, "dead reckoning"};
  add_withheld(*reckoned, row);
  row.resize(table.columns.size(), "-");
  table.rows.push_back(row);
}

}  // namespace

text::Table withheld_table(const Drives& drives) {
  text::Table table;
  table.file = "drives_withheld";
  table.title = "Drives without truth: errors at withheld fixes, in metres";
  table.columns = {"Drive", "kept out", "system", "fixes",          "median",
                   "RMS",   "Max",      "CEP95",  "minimum reached"};
  table.notes = {
      "The numbers contain the errors of the fixes. dead reckoning: odometry alone from the last "
      "fix before each withheld fix, beginning at the pose of ours_g2."};
  for (const DriveResult& drive : drives) {
    for (const WithheldResult& way : drive.withheld) {
      for (const Outcome& outcome : way.outcomes) {
        if (!outcome.setting.evaluated) continue;
        const evaluation::WithheldMetrics* fused = find_prediction(outcome, "fused");
        Row row{labelled(drive), way.way, outcome.setting.name};
        if (fused == nullptr) {
          row.resize(table.columns.size(), "-");
          table.notes.push_back(labelled(drive) + ", " + way.way + ", " + outcome.setting.name + ": " +
                                (outcome.failure.empty() ? "no fix was withheld" : outcome.failure));
        } else {
          add_withheld(*fused, row);
          row.push_back(reached_word(outcome));
        }
        table.rows.push_back(row);
      }
      add_dead_reckoning(drive, way, table);
    }
  }
  return table;
}

}  // namespace waymark::reproduction
