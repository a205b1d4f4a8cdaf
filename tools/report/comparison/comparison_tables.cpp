#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include <fmt/format.h>

#include <waymark/tools/report/comparison/comparison_page.hpp>
#include <waymark/tools/report/comparison/comparison_parts.hpp>
#include <waymark/tools/report/consistency_bars.hpp>
#include <waymark/tools/text/number_text.hpp>

namespace waymark::report {
namespace {

using Groups = std::vector<DriveGroup>;
using text::Row;

bool same(const evaluation::PositionMetrics& a, const evaluation::PositionMetrics& b) {
  return a.count == b.count && a.rmse_m == b.rmse_m && a.max_m == b.max_m && a.accuracy_m == b.accuracy_m;
}

/// Returns a table whose first columns are the drive (if there are several) and the
/// name of the row.
text::Table table_with(const Groups& groups, const std::string& title, Row columns) {
  text::Table table{.title = title};
  if (groups.size() > 1) table.columns.emplace_back("drive");
  table.columns.emplace_back("run");
  table.columns.insert(table.columns.end(), columns.begin(), columns.end());
  return table;
}

void add_row(const Groups& groups, const DriveGroup& group, const std::string& label, const Row& cells,
             text::Table& table) {
  Row row;
  if (groups.size() > 1) row.push_back(group.drive);
  row.push_back(label);
  row.insert(row.end(), cells.begin(), cells.end());
  table.rows.push_back(std::move(row));
}

std::string counted(std::size_t value) {
  return std::to_string(value);
}

/// Half of the last digit in tables, m: smaller differences look equal.
constexpr double kShown = 0.0005;

/// Returns the metrics in which no other row is smaller: "Max, RMSE".
std::string best_in(const SystemRow& row, const std::vector<SystemRow>& rows) {
  std::string names;
  for (const PositionColumn& column : position_columns()) {
    const double own = row.metrics.position.*column.value;
    const bool best = std::isfinite(own) && rows.size() > 1 &&
                      std::none_of(rows.begin(), rows.end(), [&](const SystemRow& other) {
                        return other.metrics.position.*column.value < own - kShown;
                      });
    if (best) names.append(names.empty() ? "" : ", ").append(column.name);
  }
  return names;
}

text::Table position_table(const Groups& groups, const std::string& title,
                           std::vector<SystemRow> (*rows_of)(const DriveGroup&)) {
  Row columns{"n"};
  for (const PositionColumn& column : position_columns()) columns.push_back(column.name + " [m]");
  columns.emplace_back("best in");
  text::Table table = table_with(groups, title, columns);
  for (const DriveGroup& group : groups) {
    const std::vector<SystemRow> rows = rows_of(group);
    for (const SystemRow& row : rows) {
      Row cells{counted(row.metrics.position.count)};
      for (const PositionColumn& column : position_columns())
        cells.push_back(text::decimals(row.metrics.position.*column.value, 3));
      cells.push_back(best_in(row, rows));
      add_row(groups, group, row.label, cells, table);
    }
  }
  return table;
}

double degrees(double radians) {
  return radians * 180 / std::numbers::pi;
}

}  // namespace

std::vector<DriveGroup> groups_by_drive(const std::vector<ComparedRun>& runs) {
  std::vector<DriveGroup> groups;
  for (const ComparedRun& run : runs) {
    auto group = std::find_if(groups.begin(), groups.end(),
                              [&](const DriveGroup& known) { return known.drive == run.drive; });
    if (group == groups.end()) group = groups.insert(groups.end(), {run.drive, {}});
    group->runs.push_back(&run);
  }
  return groups;
}

std::string row_name(const Groups& groups, const DriveGroup& group, const std::string& label) {
  return groups.size() > 1 ? group.drive + ": " + label : label;
}

std::vector<SystemRow> rows_against_truth(const DriveGroup& group) {
  std::vector<SystemRow> raw;
  std::vector<SystemRow> fused;
  for (const ComparedRun* run : group.runs) {
    if (!run->evaluation.truth) continue;
    const evaluation::TruthEvaluation& truth = *run->evaluation.truth;
    const bool known = std::any_of(raw.begin(), raw.end(), [&](const SystemRow& row) {
      return same(row.metrics.position, truth.gnss.position);
    });
    if (!known)
      raw.push_back({raw.empty() ? "raw GNSS" : "raw GNSS (" + run->label + ")", nullptr, truth.gnss});
    fused.push_back({run->label, run, truth.fused});
  }
  raw.insert(raw.end(), fused.begin(), fused.end());
  return raw;
}

std::vector<SystemRow> rows_at_withheld(const DriveGroup& group) {
  std::vector<SystemRow> rows;
  for (const ComparedRun* run : group.runs) {
    for (const evaluation::WithheldMetrics& at : run->evaluation.at_withheld) {
      const std::string label = at.label == "fused" ? run->label : run->label + ", " + at.label;
      rows.push_back({label, run, {at.at_fixes, {}, {}}});
    }
  }
  return rows;
}

text::Table error_table(const Groups& groups) {
  return position_table(groups, "Position errors against truth", rows_against_truth);
}

text::Table withheld_error_table(const Groups& groups) {
  text::Table table = position_table(groups, "Errors at withheld fixes", rows_at_withheld);
  table.notes = {"The numbers contain the errors of the withheld fixes."};
  return table;
}

text::Table improvement_table(const Groups& groups) {
  Row columns;
  for (const PositionColumn& column : position_columns()) columns.push_back(column.name + " [%]");
  text::Table table = table_with(groups, "Improvement over raw GNSS", columns);
  table.notes = {"100 (1 - fused / raw) at the same epochs. Negative: worse than raw GNSS."};
  for (const DriveGroup& group : groups) {
    for (const ComparedRun* run : group.runs) {
      if (!run->evaluation.truth) continue;
      const evaluation::Improvement& i = run->evaluation.truth->improvement;
      Row cells;
      for (const double percent : {i.max_percent, i.accuracy_percent, i.precision_percent, i.rmse_percent,
                                   i.median_percent, i.cep50_percent, i.cep95_percent})
        cells.push_back(text::decimals(percent, 1));
      add_row(groups, group, run->label, cells, table);
    }
  }
  return table;
}

text::Table track_table(const Groups& groups) {
  text::Table table = table_with(
      groups, "Along and across the direction of travel, and heading",
      {"n", "along mean [m]", "rms [m]", "across mean [m]", "rms [m]", "heading rms [deg]", "max [deg]"});
  for (const DriveGroup& group : groups) {
    for (const SystemRow& row : rows_against_truth(group)) {
      const evaluation::SystemMetrics& m = row.metrics;
      add_row(groups, group, row.label,
              {counted(m.track.along.count), text::decimals(m.track.along.mean, 3),
               text::decimals(m.track.along.rms, 3), text::decimals(m.track.cross.mean, 3),
               text::decimals(m.track.cross.rms, 3), text::decimals(degrees(m.heading.rms), 3),
               text::decimals(degrees(m.heading.max_abs), 3)},
              table);
    }
  }
  return table;
}

text::Table stated_error_table(const Groups& groups) {
  text::Table table = table_with(groups, "Stated against actual errors",
                                 {"n", "effective n", "mean NEES", "consistent NEES", "inside 95 % [%]",
                                  "consistent share [%]", "actual / stated", "stated errors are"});
  table.notes = {
      "Consistent: a mean NEES of 2, 95 % inside, actual / stated 1. With consistent covariances "
      "the numbers of 95 of 100 drives lie in the intervals. Stated errors are called consistent if "
      "the mean NEES lies in its interval."};
  for (const DriveGroup& group : groups) {
    for (const ComparedRun* run : group.runs) {
      if (!run->evaluation.truth || !run->evaluation.truth->consistency) continue;
      const evaluation::ConsistencyStatistics& s = *run->evaluation.truth->consistency;
      const auto interval = [](const evaluation::Interval95& i, double unit, int digits) {
        return text::decimals(unit * i.low, digits) + " to " + text::decimals(unit * i.high, digits);
      };
      add_row(groups, group, run->label,
              {counted(s.count), text::decimals(s.effective_samples, 1), text::decimals(s.nees_mean, 2),
               interval(s.nees_mean_consistent, 1, 2), text::decimals(100 * s.coverage, 1),
               interval(s.coverage_consistent, 100, 0), text::decimals(s.median_error_ratio, 2),
               consistency_verdict(s)},
              table);
    }
  }
  return table;
}

text::Table fixes_table(const Groups& groups) {
  text::Table table =
      table_with(groups, "Fixes", {"fixes", "accepted", "rejected", "rejected [%]", "withheld"});
  for (const DriveGroup& group : groups) {
    for (const ComparedRun* run : group.runs) {
      const evaluation::Evaluation& e = run->evaluation;
      const double share =
          100 * static_cast<double>(e.rejected) / static_cast<double>(e.accepted + e.rejected);
      add_row(groups, group, run->label,
              {counted(e.fixes()), counted(e.accepted), counted(e.rejected), text::decimals(share, 2),
               counted(e.withheld)},
              table);
    }
  }
  return table;
}

text::Table ending_table(const std::vector<ComparedRun>& runs) {
  text::Table table{.title = "How the minimisations ended",
                    .columns = {"run", "ended", "iterations", "time [s]", "initial chi2", "chi2 at the end"}};
  table.notes = {"chi2 of different modelings is not comparable: their graphs differ."};
  for (const ComparedRun& run : runs) {
    if (!run.ending) continue;
    const evaluation::RunEnding& e = *run.ending;
    table.rows.push_back({run.label, e.converged ? "converged" : "NOT CONVERGED", counted(e.iterations),
                          text::decimals(e.seconds, 3), fmt::format("{:.6g}", e.initial_chi2),
                          fmt::format("{:.6g}", e.final_chi2)});
    if (!e.converged) table.notes.push_back(run.label + ": " + e.message);
  }
  return table;
}

text::Table provenance_differences(const std::vector<ComparedRun>& runs) {
  text::Table table{.title = "Settings that differ", .columns = {"entry"}, .words = true};
  std::map<std::string, Row> entries;
  for (std::size_t r = 0; r < runs.size(); ++r) {
    table.columns.push_back(runs[r].label);
    for (const auto& [key, text] : runs[r].provenance)
      entries.try_emplace(key, Row(runs.size())).first->second[r] = text;
  }
  for (auto& [key, texts] : entries) {
    if (std::adjacent_find(texts.begin(), texts.end(), std::not_equal_to<>()) == texts.end()) continue;
    Row row{key};
    for (std::string& text : texts) row.push_back(text.empty() ? "-" : std::move(text));
    table.rows.push_back(std::move(row));
  }
  return table;
}

}  // namespace waymark::report
