#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <waymark/tools/reproduction/tables/paper_tables.hpp>
#include <waymark/tools/text/number_text.hpp>

namespace waymark::reproduction {
namespace {

using text::Row;
using Drives = std::vector<DriveResult>;

void add_triple(const std::optional<PaperMetrics>& metrics, int digits, Row& row) {
  const PaperMetrics m =
      metrics.value_or(PaperMetrics{evaluation::kUndefined, evaluation::kUndefined, evaluation::kUndefined});
  for (const double value : {m.max_m, m.accuracy_m, m.precision_m})
    row.push_back(text::decimals(value, digits));
}

text::Table paper_overview_table(const Drives& drives) {
  text::Table table;
  table.file = "table_1_dataset_overview";
  table.title = "Table 1: dataset overview, the paper's drives and the simulated ones";
  table.columns = {"Dataset",  "km paper",         "km",         "fixes paper", "fixes", "odometry paper",
                   "odometry", "rejected % paper", "rejected %", "environment"};
  for (const DriveResult& drive : drives) {
    const PaperDrive& paper = paper_drives().at(static_cast<std::size_t>(drive.dataset - 1));
    const Outcome* gated = find_outcome(drive.outcomes, "ours_g2");
    const double rejected =
        gated != nullptr && gated->failure.empty() ? gated->rejected_percent() : evaluation::kUndefined;
    table.rows.push_back({drive.label(), text::decimals(paper.distance_km, 0),
                          text::decimals(drive.distance_m / 1000, 2), std::to_string(paper.gnss_points),
                          std::to_string(drive.fixes), std::to_string(paper.odometry_points),
                          std::to_string(drive.odometry_samples), text::decimals(paper.rejected_percent, 2),
                          text::decimals(rejected, 2), paper.environment});
  }
  return table;
}

text::Table gnss_table(const Drives& drives) {
  text::Table table;
  table.file = "table_2_gnss";
  table.title = "Table 2: raw GNSS in metres, the paper's receiver and the simulated one";
  table.columns = {"Dataset", "Max paper", "Acc paper", "Prec paper", "Max", "Acc", "Prec"};
  const MetricsColumn paper = paper_column(drives, "gnss");
  const MetricsColumn ours = metrics_column(drives, "gnss");
  for (std::size_t i = 0; i < drives.size(); ++i) {
    Row row{drives[i].label()};
    add_triple(paper.of_drive[i], 3, row);
    add_triple(ours.of_drive[i], 3, row);
    table.rows.push_back(row);
  }
  Row average{"Average"};
  add_triple(paper.average, 3, average);
  add_triple(ours.average, 3, average);
  table.rows.push_back(average);
  return table;
}

/// Adds "The paper prints 18.391 ..." if its average is not that of its rows.
void note_paper_average(const MetricsColumn& paper, const std::string& system, text::Table& table) {
  const auto printed = paper_metrics(0, system);
  const bool all = paper.of_drive.size() == paper_drives().size();
  if (!printed || !paper.average || !all) return;
  const double worst = std::max({std::abs(printed->max_m - paper.average->max_m),
                                 std::abs(printed->accuracy_m - paper.average->accuracy_m),
                                 std::abs(printed->precision_m - paper.average->precision_m)});
  constexpr double kRounding = 0.00051;
  if (worst <= kRounding) return;
  table.notes.push_back(
      fmt::format("The paper prints the averages {:.3f}, {:.3f}, {:.3f}; the table shows the "
                  "averages of the paper's rows.",
                  printed->max_m, printed->accuracy_m, printed->precision_m));
}

void note_endings(const Drives& drives, const std::string& setting, text::Table& table) {
  std::string missed;
  for (const DriveResult& drive : drives) {
    const Outcome* outcome = find_outcome(drive.outcomes, setting);
    if (outcome == nullptr) continue;
    if (!outcome->failure.empty()) {
      table.notes.push_back(fmt::format("Drive {}, {}: {}", drive.label(), setting, outcome->failure));
    } else if (!outcome->setting.objective.empty() && !near_minimum(*outcome)) {
      missed += missed.empty() ? "" : ", ";
      missed += drive.label();
    }
  }
  if (!missed.empty())
    table.notes.push_back(fmt::format(
        "{} did not reach its minimum in drives {}: the errors are of the state where it stopped.", setting,
        missed));
}

text::Table result_table(const Drives& drives, int number, const std::string& system,
                         const std::string& title) {
  text::Table table;
  table.file = fmt::format("table_{}_{}", number, system);
  table.title = fmt::format("Table {}: {} in metres", number, title);
  table.columns = {"Dataset"};
  for (const char* group : {"paper", "literal", "minimum", "ours"}) {
    for (const char* metric : {"Max", "Acc", "Prec"})
      table.columns.push_back(fmt::format("{} {}", metric, group));
  }
  const MetricsColumn paper = paper_column(drives, system);
  const MetricsColumn literal = metrics_column(drives, "paper_" + system);
  const MetricsColumn minimum = metrics_column(drives, "paper_" + system + "/minimum");
  const MetricsColumn ours = metrics_column(drives, "ours_" + system);
  for (std::size_t i = 0; i < drives.size(); ++i) {
    Row row{drives[i].label()};
    for (const MetricsColumn* column : {&paper, &literal, &minimum, &ours})
      add_triple(column->of_drive[i], 3, row);
    table.rows.push_back(row);
  }
  Row average{"Average"};
  for (const MetricsColumn* column : {&paper, &literal, &minimum, &ours})
    add_triple(column->average, 3, average);
  table.rows.push_back(average);
  const MetricsColumn gnss = metrics_column(drives, "gnss");
  Row better{"Improvement %"};
  add_triple(average_improvement(paper_column(drives, "gnss"), paper), 3, better);
  for (const MetricsColumn* column : {&literal, &minimum, &ours})
    add_triple(average_improvement(gnss, *column), 3, better);
  table.rows.push_back(better);

  table.notes.emplace_back(
      "paper: the figures that it prints. On the simulated drives: literal, the paper's settings; "
      "minimum, the same errors and weights minimised from a good initial guess; "
      "ours, our settings.");
  note_paper_average(paper, system, table);
  if (system == "g1")
    table.notes.push_back(fmt::format(
        "The paper's text gives {:.2f} % for the average precision of G1; its table, and its rows, -7.364 %.",
        kPaperTextG1Precision));
  note_endings(drives, "paper_" + system, table);
  note_endings(drives, "ours_" + system, table);
  return table;
}

/// Adds mean NEES and coverage of both systems. The cells are empty in the lines below the drives.
void add_stated_errors(const DriveResult* drive, Row& row) {
  for (const std::string& setting : {std::string("ours_g2"), std::string(kDefaultModel)}) {
    const auto stated = drive != nullptr ? consistency_of(*drive, setting) : std::nullopt;
    row.push_back(text::decimals(stated ? stated->nees_mean : evaluation::kUndefined, 1));
    row.push_back(text::decimals(stated ? 100 * stated->coverage : evaluation::kUndefined, 0));
  }
}

text::Table default_model_table(const Drives& drives) {
  text::Table table;
  table.file = "table_7_default_model";
  table.title = "Table 7, beyond the paper: the default model beside G2 with rejection, in metres";
  table.columns = {"Dataset"};
  for (const char* group : {"paper G2", "ours G2", "default"}) {
    for (const char* metric : {"Max", "Acc", "Prec"})
      table.columns.push_back(fmt::format("{} {}", metric, group));
  }
  for (const char* group : {"ours G2", "default"}) {
    table.columns.push_back(fmt::format("NEES {}", group));
    table.columns.push_back(fmt::format("95 % coverage {}", group));
  }
  const MetricsColumn paper = paper_column(drives, "g2");
  const MetricsColumn ours = metrics_column(drives, "ours_g2");
  const MetricsColumn model = metrics_column(drives, kDefaultModel);
  for (std::size_t i = 0; i < drives.size(); ++i) {
    Row row{drives[i].label()};
    for (const MetricsColumn* column : {&paper, &ours, &model}) add_triple(column->of_drive[i], 3, row);
    add_stated_errors(&drives[i], row);
    table.rows.push_back(row);
  }
  Row average{"Average"};
  for (const MetricsColumn* column : {&paper, &ours, &model}) add_triple(column->average, 3, average);
  add_stated_errors(nullptr, average);
  table.rows.push_back(average);
  const MetricsColumn gnss = metrics_column(drives, "gnss");
  Row better{"Improvement %"};
  add_triple(average_improvement(paper_column(drives, "gnss"), paper), 3, better);
  for (const MetricsColumn* column : {&ours, &model})
    add_triple(average_improvement(gnss, *column), 3, better);
  add_stated_errors(nullptr, better);
  table.rows.push_back(better);
  table.notes = {
      "paper G2: the figures that the paper prints, on its own drives. ours G2 and default on the "
      "simulated ones. default: what `waymark run` does: no gate, correlated errors with heavy "
      "tails, calibration states, noise estimated from the drive.",
      "NEES: error against truth in units of the stated covariance, 2 if the covariances are consistent."};
  note_endings(drives, kDefaultModel, table);
  return table;
}

}  // namespace

std::vector<text::Table> paper_tables(const Drives& drives) {
  Drives of_paper;
  for (const DriveResult& drive : drives) {
    if (drive.dataset > 0) of_paper.push_back(drive);
  }
  if (of_paper.empty()) return {};
  return {paper_overview_table(of_paper),
          gnss_table(of_paper),
          result_table(of_paper, 3, "g1", "G1 with rejection"),
          result_table(of_paper, 4, "g2", "G2 with rejection"),
          result_table(of_paper, 5, "g3", "G3 with rejection"),
          result_table(of_paper, 6, "g2_no_rejection", "G2 without rejection"),
          default_model_table(of_paper)};
}

}  // namespace waymark::reproduction
