#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include <waymark/tools/drawing/figure/bars.hpp>
#include <waymark/tools/drawing/figure/look.hpp>
#include <waymark/tools/report/comparison/comparison_parts.hpp>
#include <waymark/tools/report/drive/epoch_series.hpp>

namespace waymark::report {
namespace {

using Groups = std::vector<DriveGroup>;

constexpr std::size_t kRunsInFigure = 7;  // the number of looks for systems
constexpr int kHalfWidth = 460;
constexpr std::size_t kLongName = 22;  // characters; bars with longer names need the whole width

/// Tells whether a metric has its own figure. The others are only in the table.
bool is_drawn(const PositionColumn& column) {
  return column.name != "CEP50";  // it would be next to the median
}

/// Returns the width for bar figures with these names.
int width_for(const std::vector<std::string>& names) {
  const bool has_long =
      std::any_of(names.begin(), names.end(), [](const auto& name) { return name.size() > kLongName; });
  return has_long ? drawing::Figure().width : kHalfWidth;
}

/// At most seven runs of a drive that have epochs.
struct Part {
  const DriveGroup* group = nullptr;
  std::vector<const ComparedRun*> runs;
  std::size_t first = 0;  ///< index in the group of the first of them
  std::size_t number = 0;
};

std::vector<Part> parts_with_epochs(const Groups& groups) {
  std::vector<Part> parts;
  for (const DriveGroup& group : groups) {
    Part part{&group, {}, 0, parts.size()};
    for (std::size_t r = 0; r < group.runs.size(); ++r) {
      const evaluation::Evaluation& evaluation = group.runs[r]->evaluation;
      if (evaluation.epochs.empty() || !evaluation.truth) continue;
      if (part.runs.size() == kRunsInFigure) {
        parts.push_back(part);
        part = {&group, {}, r, parts.size()};
      }
      part.runs.push_back(group.runs[r]);
    }
    if (!part.runs.empty()) parts.push_back(part);
  }
  return parts;
}

double length_of(const std::optional<Eigen::Vector2d>& offset) {
  return offset ? offset->norm() : evaluation::kUndefined;
}

drawing::Series distribution_of(const ComparedRun& run, Offset offset, const std::string& name,
                                drawing::Look look) {
  drawing::Series series{.name = name, .mark = drawing::Mark::line, .look = look};
  for (const evaluation::EpochResult& epoch : run.evaluation.epochs)
    if (epoch.*offset) series.x.push_back((epoch.*offset)->norm());
  std::sort(series.x.begin(), series.x.end());
  for (std::size_t i = 0; i < series.x.size(); ++i)
    series.y.push_back(100 * static_cast<double>(i + 1) / static_cast<double>(series.x.size()));
  return series;
}

drawing::Series course_of(const ComparedRun& run, Offset offset, Stamp begin, const std::string& name,
                          drawing::Look look) {
  drawing::Series series{.name = name, .mark = drawing::Mark::line, .look = look};
  for (const evaluation::EpochResult& epoch : run.evaluation.epochs) {
    series.x.push_back(seconds_between(begin, epoch.stamp));
    series.y.push_back(length_of(epoch.*offset));
  }
  series.time = series.x;
  return series;
}

/// One line for the raw fixes of the first run, and one for each run.
template <typename MakeSeries>
void add_systems(const Part& part, const MakeSeries& make, drawing::Figure& figure) {
  figure.series.push_back(
      make(*part.runs.front(), &evaluation::EpochResult::gnss_offset_m, "raw GNSS", drawing::Look::raw));
  for (std::size_t r = 0; r < part.runs.size(); ++r)
    figure.series.push_back(make(*part.runs[r], &evaluation::EpochResult::fused_offset_m, part.runs[r]->label,
                                 drawing::look_of_system(r)));
}

std::string titled(const Groups& groups, const Part& part, const std::string& title) {
  std::string text = groups.size() > 1 ? title + ", " + part.group->drive : title;
  if (part.group->runs.size() > kRunsInFigure)
    text += fmt::format(", runs {} to {}", part.first + 1, part.first + part.runs.size());
  return text;
}

/// Returns the common end of the distributions. The tail of the raw one would leave no room
/// for the others.
double common_end(const drawing::Figure& figure) {
  double end = 0;
  for (const drawing::Series& series : figure.series) {
    if (series.x.empty()) continue;
    end = std::max(end, series.look == drawing::Look::raw
                            ? evaluation::nearest_rank_quantile(series.x, 0.9)
                            : 1.2 * evaluation::nearest_rank_quantile(series.x, 0.99));
  }
  return end;
}

/// Returns a figure for a metric. Predictions other than the fused poses are only in the table,
/// because dead reckoning would leave no room for the others.
drawing::Figure bars_of(const Groups& groups, const PositionColumn& column, const std::string& prefix,
                        std::vector<SystemRow> (*rows_of)(const DriveGroup&)) {
  drawing::Figure figure{.id = prefix + column.id,
                         .title = column.name,
                         .description = column.about + ".",
                         .x = {.title = column.name, .unit = "m"},
                         .y = {.title = "run", .unit = ""},
                         .series = {}};
  drawing::Series raw{.name = "raw GNSS", .mark = drawing::Mark::bars, .look = drawing::Look::raw};
  drawing::Series fused{.name = "fused", .mark = drawing::Mark::bars, .look = drawing::Look::fused};
  for (const DriveGroup& group : groups) {
    for (const SystemRow& row : rows_of(group)) {
      if (row.run != nullptr && row.label != row.run->label) continue;
      drawing::Series& series = row.run == nullptr ? raw : fused;
      series.x.push_back(row.metrics.position.*column.value);
      series.y.push_back(static_cast<double>(figure.y.categories.size()));
      figure.y.categories.push_back(row_name(groups, group, row.label));
    }
  }
  if (!raw.x.empty()) figure.series.push_back(std::move(raw));
  figure.series.push_back(std::move(fused));
  figure.width = width_for(figure.y.categories);
  drawing::fit_bars(figure);
  return figure;
}

std::vector<drawing::Figure> without_empty(std::vector<drawing::Figure> figures) {
  std::erase_if(figures, [](const drawing::Figure& figure) { return figure.y.categories.empty(); });
  return figures;
}

drawing::Figure bars_of_endings(const std::string& id, const std::string& title,
                                const std::string& description, const drawing::Axis& axis) {
  return {.id = id,
          .title = title,
          .description = description,
          .x = axis,
          .y = {.title = "run", .unit = ""},
          .series = {}};
}

}  // namespace

std::vector<drawing::Figure> error_bars(const Groups& groups) {
  std::vector<drawing::Figure> figures;
  for (const PositionColumn& column : position_columns())
    if (is_drawn(column)) figures.push_back(bars_of(groups, column, "error-", rows_against_truth));
  return without_empty(std::move(figures));
}

std::vector<drawing::Figure> withheld_bars(const Groups& groups) {
  std::vector<drawing::Figure> figures;
  for (const PositionColumn& column : position_columns()) {
    if (column.name != "RMSE" && column.name != "CEP95") continue;
    figures.push_back(bars_of(groups, column, "withheld-", rows_at_withheld));
    figures.back().title += " at withheld fixes";
    figures.back().description = "Distance of the fused antenna from the withheld fixes.";
  }
  return without_empty(std::move(figures));
}

std::vector<drawing::Figure> distribution_figures(const Groups& groups) {
  std::vector<drawing::Figure> figures;
  for (const Part& part : parts_with_epochs(groups)) {
    drawing::Figure figure{
        .id = fmt::format("distribution-{}", part.number + 1),
        .title = titled(groups, part, "Distribution of the position error"),
        .description =
            "Share of the epochs whose error is at most this large. The axis holds 99 % of the "
            "errors of every run and 90 % of the raw errors; the largest are in the table.",
        .x = {.title = "position error", .unit = "m", .low = 0},
        .y = {.title = "epochs", .unit = "%", .low = 0, .high = 100},
        .series = {}};
    add_systems(part, distribution_of, figure);
    figure.x.high = common_end(figure);
    figures.push_back(std::move(figure));
  }
  return figures;
}

std::vector<drawing::Figure> course_figures(const Groups& groups) {
  std::vector<drawing::Figure> figures;
  for (const Part& part : parts_with_epochs(groups)) {
    Stamp begin = part.runs.front()->evaluation.epochs.front().stamp;
    for (const ComparedRun* run : part.runs) begin = std::min(begin, run->evaluation.epochs.front().stamp);
    drawing::Figure figure{.id = fmt::format("course-{}", part.number + 1),
                           .title = titled(groups, part, "Position error over time"),
                           .description = "Distance from the truth at each fix. Drag to move, wheel to zoom.",
                           .x = {.title = "time since the first fix", .unit = "s"},
                           .y = {.title = "position error", .unit = "m", .logarithmic = true},
                           .series = {},
                           .motion = drawing::Motion::x,
                           .link = "time-" + std::to_string(part.number + 1)};
    add_systems(
        part,
        [&](const ComparedRun& run, Offset offset, const std::string& name, drawing::Look look) {
          return course_of(run, offset, begin, name, look);
        },
        figure);
    figures.push_back(std::move(figure));
  }
  return figures;
}

std::vector<drawing::Figure> chi2_figures(const std::vector<ComparedRun>& runs) {
  std::vector<drawing::Figure> figures;
  std::vector<drawing::Series> lines;
  const auto finish = [&] {
    if (lines.empty()) return;
    figures.push_back({.id = fmt::format("chi2-{}", figures.size() + 1),
                       .title = "chi2 over the accepted steps",
                       .description = "chi2 of the graph of each run; only graphs of "
                                      "one modeling are comparable.",
                       .x = {.title = "accepted steps", .unit = ""},
                       .y = {.title = "chi2", .unit = "", .logarithmic = true},
                       .series = std::exchange(lines, {})});
  };
  for (const ComparedRun& run : runs) {
    if (!run.ending || run.ending->chi2.size() < 2) continue;
    drawing::Series line{
        .name = run.label, .mark = drawing::Mark::line, .look = drawing::look_of_system(lines.size())};
    for (std::size_t i = 0; i < run.ending->chi2.size(); ++i) line.x.push_back(static_cast<double>(i));
    line.y = run.ending->chi2;
    lines.push_back(std::move(line));
    if (lines.size() == kRunsInFigure) finish();
  }
  finish();
  return figures;
}

std::vector<drawing::Figure> ending_figures(const std::vector<ComparedRun>& runs) {
  drawing::Figure iterations =
      bars_of_endings("iterations", "Iterations", "Accepted and rejected steps. A cross: not converged.",
                      {.title = "iterations", .unit = ""});
  drawing::Figure seconds =
      bars_of_endings("seconds", "Time of the minimisation", "Wall time of one run. A cross: not converged.",
                      {.title = "time", .unit = "s"});
  for (drawing::Figure* figure : {&iterations, &seconds}) {
    drawing::Series bars{.name = "converged", .mark = drawing::Mark::bars, .look = drawing::Look::fused};
    drawing::Series missed{
        .name = "not converged", .mark = drawing::Mark::points, .look = drawing::Look::rejected};
    for (const ComparedRun& run : runs) {
      if (!run.ending) continue;
      const double row = static_cast<double>(figure->y.categories.size());
      const double value =
          figure == &seconds ? run.ending->seconds : static_cast<double>(run.ending->iterations);
      figure->y.categories.push_back(run.label);
      bars.x.push_back(value);
      bars.y.push_back(row);
      if (run.ending->converged) continue;
      missed.x.push_back(value);
      missed.y.push_back(row);
    }
    if (figure->y.categories.empty()) return {};
    figure->series = {bars};
    if (!missed.x.empty()) figure->series.push_back(missed);
    figure->width = width_for(figure->y.categories);
    drawing::fit_bars(*figure);
  }
  return {iterations, seconds};
}

}  // namespace waymark::report
