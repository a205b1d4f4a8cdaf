#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <optional>
#include <set>

#include <fmt/format.h>

#include <waymark/tools/benchmark/page/benchmark_parts.hpp>
#include <waymark/tools/drawing/figure/bars.hpp>
#include <waymark/tools/drawing/figure/look.hpp>

namespace waymark::benchmark {
namespace {

using Files = std::vector<FileSummary>;

// looks of systems; with more contestants each one needs its own row
constexpr std::size_t kLooks = 7;

/// The number of a cell that a bar shows.
struct Bar {
  double value = 0;
  std::optional<Spread> spread{};
};
using Measure = std::function<std::optional<Bar>(const FileSummary&, const CellSummary&)>;

std::string nothing_or(const std::string& text, bool wanted) {
  return wanted ? text : std::string();
}

void push(const Bar& bar, double row, drawing::Series& series) {
  series.x.push_back(bar.value);
  series.y.push_back(row);
  if (!bar.spread) return;
  series.low.push_back(bar.spread->least);
  series.high.push_back(bar.spread->largest);
}

/// Crosses at the ends of bars whose cells did not converge.
struct MissedMark {
  std::size_t series = 0;
  double value = 0;
  double row = 0;
};

void add_missed(const std::vector<MissedMark>& missed, drawing::Figure& figure) {
  if (missed.empty()) return;
  drawing::Series crosses{
      .name = "not converged (!)", .mark = drawing::Mark::points, .look = drawing::Look::rejected};
  for (const MissedMark& mark : missed) {
    crosses.x.push_back(mark.value);
    crosses.y.push_back(mark.row + drawing::bar_place(figure, mark.series, mark.row).offset);
  }
  figure.series.push_back(std::move(crosses));
}

/// Returns a figure with a row for each file and a bar for each contestant in it.
drawing::Figure grouped(const Files& files, const ContestantNames& names, drawing::Figure figure,
                        const Measure& measure) {
  std::vector<MissedMark> missed;
  for (std::size_t i = 0; i < names.all().size(); ++i)
    figure.series.push_back(
        {.name = names.all()[i], .mark = drawing::Mark::bars, .look = drawing::look_of_system(i)});
  for (std::size_t f = 0; f < files.size(); ++f) {
    figure.y.categories.push_back(files[f].file);
    for (const CellSummary& cell : files[f].cells) {
      const auto bar = measure(files[f], cell);
      if (!bar) continue;
      const auto place = std::find(names.all().begin(), names.all().end(), names.name_of(cell));
      const auto series = static_cast<std::size_t>(place - names.all().begin());
      push(*bar, static_cast<double>(f), figure.series[series]);
      if (!cell.converged) missed.push_back({series, bar->value, static_cast<double>(f)});
    }
  }
  std::vector<MissedMark> kept;  // a contestant without any bar gets no legend entry
  std::vector<drawing::Series> drawn;
  for (std::size_t s = 0; s < figure.series.size(); ++s) {
    if (figure.series[s].x.empty()) continue;
    for (MissedMark mark : missed) {
      if (mark.series == s) kept.push_back({drawn.size(), mark.value, mark.row});
    }
    drawn.push_back(figure.series[s]);
  }
  figure.series = std::move(drawn);
  add_missed(kept, figure);
  drawing::fit_bars(figure);
  return figure;
}

/// Returns a figure of one file with a row for each contestant.
drawing::Figure of_file(const FileSummary& file, const ContestantNames& names, drawing::Figure figure,
                        const Measure& measure) {
  drawing::Series bars{.name = "converged", .mark = drawing::Mark::bars, .look = drawing::Look::fused};
  std::vector<MissedMark> missed;
  for (const CellSummary& cell : file.cells) {
    const auto bar = measure(file, cell);
    if (!bar) continue;
    const double row = static_cast<double>(figure.y.categories.size());
    push(*bar, row, bars);
    figure.y.categories.push_back(names.name_of(cell));
    if (!cell.converged) missed.push_back({0, bar->value, row});
  }
  figure.series = {bars};
  add_missed(missed, figure);
  drawing::fit_bars(figure);
  return figure;
}

/// Returns one figure if there are enough looks, or else one for each file.
std::vector<drawing::Figure> bar_figures(const Files& files, const ContestantNames& names,
                                         const drawing::Figure& about, const Measure& measure) {
  std::vector<drawing::Figure> figures;
  if (names.all().size() <= kLooks) {
    figures.push_back(grouped(files, names, about, measure));
  } else {
    for (std::size_t f = 0; f < files.size(); ++f) {
      drawing::Figure figure = about;
      figure.id += fmt::format("-{}", f + 1);
      figure.title = about.title + ": " + files[f].file;
      figure.y.title = "contestant";
      figures.push_back(of_file(files[f], names, figure, measure));
    }
  }
  std::erase_if(figures, [](const drawing::Figure& figure) {
    return std::all_of(figure.series.begin(), figure.series.end(),
                       [](const drawing::Series& series) { return series.x.empty(); });
  });
  return figures;
}

std::vector<std::string> peers_of(const Files& files) {
  std::vector<std::string> peers;
  for (const FileSummary& file : files) {
    for (const CellSummary& cell : file.cells) {
      for (const auto& [peer, ratio] : cell.peer_ratios)
        if (std::find(peers.begin(), peers.end(), peer) == peers.end()) peers.push_back(peer);
    }
  }
  return peers;
}

/// Adds the medians of a contestant over the sizes of its files: points with their spread, joined.
void add_size_series(const Files& files, const ContestantNames& names, std::size_t contestant,
                     drawing::Look look, drawing::Figure& figure) {
  std::vector<std::pair<double, Spread>> points;
  for (const FileSummary& file : files) {
    for (const CellSummary& cell : file.cells)
      if (names.name_of(cell) == names.all()[contestant])
        points.emplace_back(static_cast<double>(file.edges), cell.seconds);
  }
  std::stable_sort(points.begin(), points.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  drawing::Series line{.name = "", .mark = drawing::Mark::line, .look = look};
  drawing::Series marks{.name = names.all()[contestant], .mark = drawing::Mark::points, .look = look};
  for (const auto& [edges, seconds] : points) {
    for (drawing::Series* series : {&line, &marks}) {
      series->x.push_back(edges);
      series->y.push_back(1e3 * seconds.median);
    }
    marks.low.push_back(1e3 * seconds.least);
    marks.high.push_back(1e3 * seconds.largest);
  }
  figure.series.push_back(std::move(line));
  figure.series.push_back(std::move(marks));
}

}  // namespace

ContestantNames::ContestantNames(const Files& files) {
  std::set<std::string> solvers;
  std::set<std::string> starts;
  for (const FileSummary& file : files) {
    for (const CellSummary& cell : file.cells) {
      if (!cell.peer) solvers.insert(cell.solver);
      starts.insert(cell.start);
    }
  }
  several_solvers_ = solvers.size() > 1;
  several_starts_ = starts.size() > 1;
  for (const FileSummary& file : files) {
    for (const CellSummary& cell : file.cells) {
      std::string name = name_of(cell);
      if (std::find(all_.begin(), all_.end(), name) == all_.end()) all_.push_back(std::move(name));
    }
  }
}

std::string ContestantNames::name_of(const CellSummary& cell) const {
  return cell.name + nothing_or(" " + cell.solver, several_solvers_ && !cell.solver.empty()) +
         nothing_or(" from " + cell.start, several_starts_);
}

std::vector<drawing::Figure> time_figures(const Files& files, const ContestantNames& names) {
  return bar_figures(
      files, names,
      {.id = "time",
       .title = "Time to the result",
       .description = "Median of the repetitions; a bracket goes from the shortest to the longest. "
                      "The scale is logarithmic, so lengths of bars are not proportional to times.",
       .x = {.title = "time", .unit = "ms", .logarithmic = true},
       .y = {.title = "file", .unit = ""},
       .series = {}},
      [](const FileSummary&, const CellSummary& cell) -> std::optional<Bar> {
        const Spread& s = cell.seconds;
        return Bar{1e3 * s.median, Spread{1e3 * s.median, 1e3 * s.least, 1e3 * s.largest}};
      });
}

std::vector<drawing::Figure> memory_figures(const Files& files, const ContestantNames& names) {
  return bar_figures(
      files, names,
      {.id = "memory",
       .title = "Peak memory",
       .description = "Largest resident set during one run, the graph and the program included, in "
                      "1e6 bytes.",
       .x = {.title = "memory", .unit = "MB"},
       .y = {.title = "file", .unit = ""},
       .series = {}},
      [](const FileSummary&, const CellSummary& cell) -> std::optional<Bar> {
        if (!cell.memory_peak_mb) return std::nullopt;
        return Bar{*cell.memory_peak_mb};
      });
}

std::vector<drawing::Figure> iteration_figures(const Files& files, const ContestantNames& names) {
  return bar_figures(files, names,
                     {.id = "iterations",
                      .title = "Iterations",
                      .description = "Proposed steps, accepted or not.",
                      .x = {.title = "iterations", .unit = ""},
                      .y = {.title = "file", .unit = ""},
                      .series = {}},
                     [](const FileSummary&, const CellSummary& cell) -> std::optional<Bar> {
                       return Bar{static_cast<double>(cell.iterations)};
                     });
}

std::vector<drawing::Figure> excess_figures(const Files& files, const ContestantNames& names) {
  return bar_figures(files, names,
                     {.id = "excess",
                      .title = "chi2 above the optimum",
                      .description = "chi2 / optimum - 1 of the runs that ended above the optimum. "
                                     "Without a bar the optimum was reached, within 1e-6.",
                      .x = {.title = "chi2 / optimum - 1", .unit = "", .logarithmic = true},
                      .y = {.title = "file", .unit = ""},
                      .series = {}},
                     [](const FileSummary& file, const CellSummary& cell) -> std::optional<Bar> {
                       const double excess = cell.final_chi2 / file.optimum - 1;
                       if (cell.optimality != Optimality::above || !std::isfinite(excess) || excess <= 0)
                         return std::nullopt;
                       return Bar{excess};
                     });
}

std::vector<drawing::Figure> ratio_figures(const Files& files, const ContestantNames& names) {
  std::vector<drawing::Figure> figures;
  for (const std::string& peer : peers_of(files)) {
    std::string id = peer;
    std::replace(id.begin(), id.end(), '_', '-');
    std::vector<drawing::Figure> of_peer = bar_figures(
        files, names,
        {.id = "ratio-" + id,
         .title = "Time of " + peer + " over this one's",
         .description =
             "Ratio of two runs that were made in turn, median over the repetitions. Above 1: faster than " +
             peer + ".",
         .x = {.title = peer + " / this", .unit = ""},
         .y = {.title = "file", .unit = ""},
         .series = {}},
        [&](const FileSummary&, const CellSummary& cell) -> std::optional<Bar> {
          for (const auto& [name, ratio] : cell.peer_ratios)
            if (name == peer) return Bar{ratio};
          return std::nullopt;
        });
    for (drawing::Figure& figure : of_peer) {
      figure.series.push_back(drawing::line_across("equal", 1, figure.y.categories.size()));
      figures.push_back(std::move(figure));
    }
  }
  return figures;
}

std::vector<drawing::Figure> size_figures(const Files& files, const ContestantNames& names) {
  std::set<std::size_t> sizes;
  for (const FileSummary& file : files) sizes.insert(file.edges);
  if (sizes.size() < 2) return {};
  std::vector<drawing::Figure> figures;
  for (std::size_t first = 0; first < names.all().size(); first += kLooks) {
    const std::size_t end = std::min(first + kLooks, names.all().size());
    drawing::Figure figure{.id = fmt::format("size-{}", figures.size() + 1),
                           .title = "Time against size",
                           .description =
                               "Median time over the number of edges, with its spread. Both scales "
                               "are logarithmic: if time is proportional to size, the "
                               "line has slope 1.",
                           .x = {.title = "edges", .unit = "", .logarithmic = true},
                           .y = {.title = "time", .unit = "ms", .logarithmic = true},
                           .series = {},
                           .height = 380};
    if (names.all().size() > kLooks) figure.title += fmt::format(", contestants {} to {}", first + 1, end);
    for (std::size_t i = first; i < end; ++i)
      add_size_series(files, names, i, drawing::look_of_system(i - first), figure);
    figures.push_back(std::move(figure));
  }
  return figures;
}

}  // namespace waymark::benchmark
