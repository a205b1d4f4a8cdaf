#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include <fmt/format.h>

#include <waymark/tools/drawing/figure/bars.hpp>
#include <waymark/tools/drawing/figure/look.hpp>
#include <waymark/tools/report/consistency_bars.hpp>
#include <waymark/tools/reproduction/experiment/setting.hpp>
#include <waymark/tools/reproduction/page/reproduction_parts.hpp>

namespace waymark::reproduction {
namespace {

using Drives = std::vector<DriveResult>;

/// A system in the figures of the paper: our name, and the paper's name.
struct System {
  const char* name;
  const char* title;
  const char* paper;  ///< its name in the tables of the paper; empty: it is not in them
  drawing::Look look;
};

constexpr std::array kSystems = {System{"gnss", "raw GNSS", "gnss", drawing::Look::raw},
                                 System{"ours_g1", "G1", "g1", drawing::Look::first},
                                 System{"ours_g2", "G2", "g2", drawing::Look::second},
                                 System{"ours_g3", "G3", "g3", drawing::Look::third},
                                 System{kDefaultModel, "default model", "", drawing::Look::fused}};

/// One of the paper's three numbers.
struct PaperColumn {
  const char* name;
  const char* id;
  const char* about;
  double PaperMetrics::*value;
};

constexpr std::array kPaperColumns = {
    PaperColumn{"Max", "max", "Largest distance from the truth.", &PaperMetrics::max_m},
    PaperColumn{"Acc", "acc", "Length of the mean offset.", &PaperMetrics::accuracy_m},
    PaperColumn{"Prec", "prec", "Deviation about the mean offset.", &PaperMetrics::precision_m}};

Drives with_truth(const Drives& drives) {
  Drives result;
  std::copy_if(drives.begin(), drives.end(), std::back_inserter(result),
               [](const DriveResult& drive) { return metrics_of(drive, "gnss").has_value(); });
  return result;
}

bool any_of_paper(const Drives& drives) {
  return std::any_of(drives.begin(), drives.end(),
                     [](const DriveResult& drive) { return drive.dataset > 0; });
}

/// Returns the numbers of a column, with the average after those of the drives.
std::vector<double> values_of(const MetricsColumn& column, double PaperMetrics::*value) {
  std::vector<double> values;
  for (const auto& metrics : column.of_drive)
    values.push_back(metrics ? (*metrics).*value : evaluation::kUndefined);
  values.push_back(column.average ? (*column.average).*value : evaluation::kUndefined);
  return values;
}

void add_bars(const MetricsColumn& column, const System& system, double PaperMetrics::*value,
              drawing::Figure& figure) {
  drawing::Series bars{.name = system.title, .mark = drawing::Mark::bars, .look = system.look};
  const std::vector<double> values = values_of(column, value);
  for (std::size_t row = 0; row < values.size(); ++row) {
    if (!std::isfinite(values[row])) continue;
    bars.x.push_back(values[row]);
    bars.y.push_back(static_cast<double>(row));
  }
  if (!bars.x.empty()) figure.series.push_back(std::move(bars));
}

/// Adds at each bar the number of the paper for the same system on its own drive.
void add_printed(const Drives& drives, double PaperMetrics::*value, drawing::Figure& figure) {
  drawing::Series printed{
      .name = "the paper's own number", .mark = drawing::Mark::points, .look = drawing::Look::truth};
  for (std::size_t s = 0; s < figure.series.size(); ++s) {
    const auto* system = std::find_if(kSystems.begin(), kSystems.end(), [&](const System& known) {
      return figure.series[s].name == known.title;
    });
    if (system == kSystems.end() || *system->paper == '\0') continue;
    const std::vector<double> values = values_of(paper_column(drives, system->paper), value);
    for (const double row : figure.series[s].y) {
      printed.x.push_back(values[static_cast<std::size_t>(row)]);
      printed.y.push_back(row + drawing::bar_place(figure, s, row).offset);
    }
  }
  if (!printed.x.empty()) figure.series.push_back(std::move(printed));
}

drawing::Figure paper_error_figure(const Drives& drives, const PaperColumn& column) {
  drawing::Figure figure{.id = std::string("error-") + column.id,
                         .title = column.name,
                         .description = column.about,
                         .x = {.title = column.name, .unit = "m"},
                         .y = {.title = "drive", .unit = ""},
                         .series = {}};
  for (const DriveResult& drive : drives) figure.y.categories.push_back(labelled(drive));
  figure.y.categories.emplace_back("average");
  for (const System& system : kSystems)
    add_bars(metrics_column(drives, system.name), system, column.value, figure);
  if (any_of_paper(drives)) {
    figure.description +=
        " The drives are simulated; a diamond is the number that the paper prints for the same "
        "system on its own drive.";
    add_printed(drives, column.value, figure);
  }
  drawing::fit_bars(figure);
  return figure;
}

std::string model_title(const std::string& setting) {
  for (const System& system : kSystems)
    if (setting == system.name) return system.title;
  return setting;
}

const evaluation::WithheldMetrics* at_withheld(const Outcome& outcome) {
  for (const evaluation::WithheldMetrics& at : outcome.evaluation.at_withheld)
    if (at.label == "fused") return &at;
  return nullptr;
}

}  // namespace

std::vector<drawing::Figure> paper_error_figures(const Drives& drives) {
  const Drives judged = with_truth(drives);
  if (judged.empty()) return {};
  std::vector<drawing::Figure> figures;
  for (const PaperColumn& column : kPaperColumns) figures.push_back(paper_error_figure(judged, column));
  return figures;
}

std::vector<drawing::Figure> stated_error_figures(const Drives& drives) {
  std::vector<report::StatedErrors> rows;
  for (const DriveResult& drive : drives) {
    for (const std::string& setting : {std::string("ours_g2"), std::string(kDefaultModel)}) {
      if (const auto stated = consistency_of(drive, setting))
        rows.push_back({labelled(drive) + ", " + model_title(setting), *stated});
    }
  }
  return report::consistency_bars("stated", rows);
}

std::vector<drawing::Figure> withheld_figures(const Drives& drives) {
  drawing::Figure figure{
      .id = "withheld",
      .title = "RMS error at withheld fixes",
      .description =
          "Drives without truth: distance of the fused antenna from the withheld fixes. It contains "
          "the errors of the fixes.",
      .x = {.title = "RMS error", .unit = "m"},
      .y = {.title = "drive", .unit = ""},
      .series = {}};
  std::vector<drawing::Series> of_system;
  for (const System& system : kSystems)
    of_system.push_back({.name = system.title, .mark = drawing::Mark::bars, .look = system.look});
  for (const DriveResult& drive : drives) {
    for (const WithheldResult& way : drive.withheld) {
      const double row = static_cast<double>(figure.y.categories.size());
      figure.y.categories.push_back(drive.label() + ": " + way.way);
      for (std::size_t s = 0; s < kSystems.size(); ++s) {
        const Outcome* outcome = find_outcome(way.outcomes, kSystems[s].name);
        const evaluation::WithheldMetrics* at = outcome == nullptr ? nullptr : at_withheld(*outcome);
        if (at == nullptr || !std::isfinite(at->at_fixes.rmse_m)) continue;
        of_system[s].x.push_back(at->at_fixes.rmse_m);
        of_system[s].y.push_back(row);
      }
    }
  }
  for (drawing::Series& series : of_system)
    if (!series.x.empty()) figure.series.push_back(std::move(series));
  if (figure.series.empty()) return {};
  drawing::fit_bars(figure);
  return {figure};
}

}  // namespace waymark::reproduction
