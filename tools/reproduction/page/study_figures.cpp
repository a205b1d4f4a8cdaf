#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <waymark/tools/drawing/figure/bars.hpp>
#include <waymark/tools/reproduction/experiment/ablation.hpp>
#include <waymark/tools/reproduction/experiment/consistency_study.hpp>
#include <waymark/tools/reproduction/page/reproduction_parts.hpp>

namespace waymark::reproduction {
namespace {

using Drives = std::vector<DriveResult>;

/// Returns a bar for each setting: the geometric mean over the drives, with the smallest and the
/// largest value.
template <typename Value>
drawing::Figure over_drives(const Drives& drives, drawing::Figure figure, const Value& value) {
  drawing::Series bars{
      .name = "mean over the drives", .mark = drawing::Mark::bars, .look = drawing::Look::withheld};
  for (const Ablation& ablation : ablations()) {
    std::vector<double> values;
    double logarithms = 0;
    for (const DriveResult& drive : drives) {
      const double of_drive = value(drive, ablation.setting.name);
      if (!std::isfinite(of_drive) || of_drive <= 0) continue;
      values.push_back(of_drive);
      logarithms += std::log(of_drive);
    }
    if (values.empty()) continue;
    const auto [least, largest] = std::minmax_element(values.begin(), values.end());
    bars.y.push_back(static_cast<double>(figure.y.categories.size()));
    figure.y.categories.push_back(ablation.title);
    bars.x.push_back(std::exp(logarithms / static_cast<double>(values.size())));
    bars.low.push_back(*least);
    bars.high.push_back(*largest);
  }
  figure.series = {std::move(bars)};
  return figure;
}

/// Returns the drives of a study in the order of their draws.
drawing::Figure of_draws(const Drives& drives, const Setting& setting, drawing::Figure figure, double unit,
                         double evaluation::ConsistencyStatistics::*value,
                         evaluation::Interval95 evaluation::ConsistencyStatistics::*consistent) {
  drawing::Series band{
      .name = "consistent, 95 of 100 drives", .mark = drawing::Mark::band, .look = drawing::Look::reference};
  drawing::Series points{.name = "drives", .mark = drawing::Mark::points, .look = drawing::Look::fused};
  std::vector<double> values;
  for (std::size_t d = 0; d < drives.size(); ++d) {
    const auto stated = consistency_of(drives[d], setting.name);
    if (!stated) continue;
    const double number = static_cast<double>(d + 1);
    band.x.push_back(number);
    band.low.push_back(unit * ((*stated).*consistent).low);
    band.high.push_back(unit * ((*stated).*consistent).high);
    points.x.push_back(number);
    points.y.push_back(unit * (*stated).*value);
    points.note.push_back(static_cast<int>(points.notes.size()));
    points.notes.push_back(drives[d].name);
    values.push_back(points.y.back());
  }
  const double mean = pooled_mean(values).mean;
  const double last = static_cast<double>(drives.size());
  drawing::Series line{.name = fmt::format("mean {:.3g}", mean),
                       .mark = drawing::Mark::line,
                       .look = drawing::Look::first,
                       .x = {1, last},
                       .y = {mean, mean}};
  if (!values.empty()) figure.series = {std::move(band), std::move(line), std::move(points)};
  return figure;
}

std::string title_of(const Setting& setting) {
  return setting.name == kDefaultModel ? "default model" : "white noise with gate";
}

}  // namespace

std::vector<drawing::Figure> ablation_figures(const Drives& drives) {
  drawing::Figure errors = over_drives(
      drives,
      {.id = "ablation-error",
       .title = "RMS error of each setting over that of the default",
       .description =
           "Geometric mean over the drives; a bracket goes from the best drive to the worst. Right of "
           "the dashed line: worse than the default. The scale is logarithmic.",
       .x = {.title = "RMS error / default's", .unit = "", .logarithmic = true},
       .y = {.title = "setting", .unit = ""},
       .series = {}},
      [](const DriveResult& drive, const std::string& setting) {
        return judged_errors(drive, setting).rmse_m / judged_errors(drive, kDefaultModel).rmse_m;
      });
  drawing::Figure nees = over_drives(
      drives,
      {.id = "ablation-nees",
       .title = "Mean NEES of each setting",
       .description = "Geometric mean over the drives with truth; a bracket goes from the smallest "
                      "to the largest. 2 is consistent. Above 2 the stated errors are too small.",
       .x = {.title = "mean NEES", .unit = "", .logarithmic = true},
       .y = {.title = "setting", .unit = ""},
       .series = {}},
      [](const DriveResult& drive, const std::string& setting) {
        return judged_stated_errors(drive, setting).nees_mean;
      });
  std::vector<drawing::Figure> figures;
  for (drawing::Figure* figure : {&errors, &nees}) {
    const std::size_t rows = figure->y.categories.size();
    if (rows == 0) continue;
    figure->series.push_back(figure == &errors ? drawing::line_across("default", 1, rows)
                                               : drawing::line_across("consistent: 2", 2, rows));
    drawing::fit_bars(*figure);
    figures.push_back(std::move(*figure));
  }
  return figures;
}

std::vector<drawing::Figure> consistency_figures(const Drives& drives) {
  std::vector<drawing::Figure> figures;
  const drawing::Axis numbers{.title = "drive, in the order drawn", .unit = ""};
  for (const Setting& setting : consistency_settings()) {
    const std::string id = setting.name == kDefaultModel ? "default" : "white";
    drawing::Figure nees =
        of_draws(drives, setting,
                 {.id = "nees-" + id,
                  .title = "NEES of each drive, " + title_of(setting),
                  .description = "Mean over the epochs of the drive. With consistent covariances 95 "
                                 "of 100 drives lie in the band.",
                  .x = numbers,
                  .y = {.title = "mean NEES", .unit = "", .logarithmic = true},
                  .series = {},
                  .width = 460},
                 1, &evaluation::ConsistencyStatistics::nees_mean,
                 &evaluation::ConsistencyStatistics::nees_mean_consistent);
    drawing::Figure coverage =
        of_draws(drives, setting,
                 {.id = "coverage-" + id,
                  .title = "Coverage of each drive, " + title_of(setting),
                  .description = "Share of the drive's epochs whose stated 95 % region holds the truth.",
                  .x = numbers,
                  .y = {.title = "inside 95 %", .unit = "%", .low = 0, .high = 104},
                  .series = {},
                  .width = 460},
                 100, &evaluation::ConsistencyStatistics::coverage,
                 &evaluation::ConsistencyStatistics::coverage_consistent);
    for (drawing::Figure* figure : {&nees, &coverage})
      if (!figure->series.empty()) figures.push_back(std::move(*figure));
  }
  return figures;
}

}  // namespace waymark::reproduction
