#include <fmt/format.h>

#include <waymark/tools/reproduction/drive_tables.hpp>

namespace waymark {
namespace {

using Drives = std::vector<DriveResult>;
using Row = std::vector<std::string>;

std::string labelled(const DriveResult& drive) {
  std::string label = drive.label();
  if (drive.simulated && !label.starts_with("Simulated")) label += " (simulated)";
  if (drive.imitated_odometry) label += " (imitated odometry)";
  return label;
}

void add_position(const PositionMetrics& m, Row& row) {
  for (const double value : {m.max_m, m.accuracy_m, m.precision_m, m.rmse_m, m.cep95_m})
    row.push_back(cell(value, 2));
}

const char* reached_word(const Outcome& outcome) {
  return at_minimum(outcome, kReachedPoses) ? "yes" : "no";
}

Row failed_row(const DriveResult& drive, const Outcome& outcome, std::size_t cells, ReportTable& table) {
  Row row{labelled(drive), outcome.setting.name};
  row.resize(cells, "-");
  table.notes.push_back(labelled(drive) + ", " + outcome.setting.name + ": " + outcome.failure);
  return row;
}

}  // namespace

ReportTable overview_table(const Drives& drives) {
  ReportTable table;
  table.file = "drives_overview";
  table.title = "The drives";
  table.columns = {"Drive", "s", "km", "fixes", "odometry", "rejected %"};
  for (const DriveResult& drive : drives) {
    const Outcome* gated = find_outcome(drive.outcomes, "ours_g2");
    const bool known = gated != nullptr && gated->failure.empty();
    table.rows.push_back({labelled(drive), cell(drive.duration_s, 0), cell(drive.distance_m / 1000, 2),
                          std::to_string(drive.fixes), std::to_string(drive.odometry_samples),
                          cell(known ? gated->rejected_percent() : kUndefined, 1)});
  }
  return table;
}

ReportTable truth_table(const Drives& drives) {
  ReportTable table;
  table.file = "drives_truth";
  table.title = "Drives with truth: errors in metres";
  table.columns = {"Drive", "system", "Max", "Acc", "Prec", "RMSE", "CEP95", "rejected %", "minimum reached"};
  for (const DriveResult& drive : drives) {
    const auto raw = metrics_of(drive, "gnss");
    if (!raw) continue;
    Row row{labelled(drive), "raw"};
    add_position(*raw, row);
    row.insert(row.end(), {"-", "-"});
    table.rows.push_back(row);
    for (const Outcome& outcome : drive.outcomes) {
      if (!outcome.setting.evaluated) continue;
      if (!outcome.failure.empty()) {
        table.rows.push_back(failed_row(drive, outcome, table.columns.size(), table));
        continue;
      }
      Row fused{labelled(drive), outcome.setting.name};
      add_position(outcome.evaluation.truth->fused.position, fused);
      fused.push_back(cell(outcome.rejected_percent(), 1));
      fused.push_back(reached_word(outcome));
      table.rows.push_back(fused);
    }
  }
  return table;
}

ReportTable withheld_table(const Drives& drives) {
  ReportTable table;
  table.file = "drives_withheld";
  table.title = "Drives without truth: errors at fixes that were kept out of the graph, in metres";
  table.columns = {"Drive", "kept out", "system", "fixes",          "median",
                   "RMS",   "Max",      "CEP95",  "minimum reached"};
  for (const DriveResult& drive : drives) {
    for (const WithheldResult& withheld : drive.withheld) {
      for (const Outcome& outcome : withheld.outcomes) {
        Row row{labelled(drive), withheld.way, outcome.setting.name};
        if (!outcome.failure.empty() || !outcome.evaluation.withheld_fixes) {
          row.resize(table.columns.size(), "-");
          table.notes.push_back(labelled(drive) + ", " + withheld.way + ", " + outcome.setting.name + ": " +
                                (outcome.failure.empty() ? "no fix was kept out" : outcome.failure));
        } else {
          const PositionMetrics& m = outcome.evaluation.withheld_fixes->position;
          row.push_back(std::to_string(m.count));
          for (const double value : {m.median_m, m.rmse_m, m.max_m, m.cep95_m}) row.push_back(cell(value, 2));
          row.push_back(reached_word(outcome));
        }
        table.rows.push_back(row);
      }
    }
  }
  return table;
}

}  // namespace waymark
