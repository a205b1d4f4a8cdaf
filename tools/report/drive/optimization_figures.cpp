#include <algorithm>
#include <cmath>
#include <map>
#include <span>

#include <fmt/format.h>

#include <waymark/tools/drawing/figure/look.hpp>
#include <waymark/tools/drawing/figure/markup.hpp>
#include <waymark/tools/report/drive/optimization_figures.hpp>
#include <waymark/tools/report/words.hpp>
#include <waymark/tools/text/number_text.hpp>

namespace waymark::report {
namespace {

/// Returns a quantile of the normal distribution by bisection. A figure needs a few hundred of them
/// with three digits.
double normal_quantile(double probability) {
  double low = -10;
  double high = 10;
  for (int step = 0; step < 50; ++step) {
    const double middle = 0.5 * (low + high);
    const double below = 0.5 * std::erfc(-middle / std::sqrt(2.0));
    (below < probability ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

/// At most this many points of the quantiles of a type are drawn. The outermost are always drawn.
constexpr std::size_t kMostQuantiles = 400;
constexpr std::size_t kOutermost = 50;
constexpr std::size_t kMostListed = 5;  // edges of a type

drawing::Series quantiles(const evaluation::TypeResiduals& type, drawing::Look look) {
  std::vector<double> whitened;
  std::copy_if(type.whitened.begin(), type.whitened.end(), std::back_inserter(whitened),
               [](double w) { return std::isfinite(w); });
  std::sort(whitened.begin(), whitened.end());
  drawing::Series series{.name = edge_name(type.tag), .mark = drawing::Mark::points, .look = look};
  const std::size_t n = whitened.size();
  const std::size_t every = std::max<std::size_t>(1, n / kMostQuantiles);
  for (std::size_t i = 0; i < n; ++i) {
    if (i >= kOutermost && i + kOutermost < n && i % every != 0) continue;
    series.x.push_back(normal_quantile((static_cast<double>(i) + 0.5) / static_cast<double>(n)));
    series.y.push_back(whitened[i]);
  }
  return series;
}

std::string joined_numbers(const std::vector<double>& numbers) {
  std::string text;
  for (const double number : numbers) text += (text.empty() ? "" : ", ") + text::readable(number);
  return text;
}

/// Returns the cells of a raster that are not empty. Their darkness is the density.
drawing::Series cells(const evaluation::DensityRaster& raster, const std::string& name) {
  drawing::Series series{.name = name, .mark = drawing::Mark::cells, .look = drawing::Look::fused};
  for (std::size_t row = 0; row < raster.cells; ++row) {
    for (std::size_t column = 0; column <= row; ++column) {
      if (raster.at(row, column) == 0) continue;
      series.x.push_back(static_cast<double>(column));
      series.y.push_back(static_cast<double>(row));
      // The root makes cells visible that are nearly empty, like those on the diagonal of
      // a long chain.
      series.weight.push_back(std::sqrt(static_cast<double>(raster.at(row, column)) /
                                        static_cast<double>(raster.possible(row, column))));
    }
  }
  return series;
}

drawing::Figure raster_figure(const evaluation::DensityRaster& raster, const std::string& id,
                              const std::string& title, const std::string& description) {
  drawing::Figure figure;
  figure.id = id;
  figure.title = title;
  figure.description = description;
  const double columns = static_cast<double>(raster.columns);
  const double cells_per_side = static_cast<double>(raster.cells);
  const std::string unit =
      raster.columns > raster.cells ? fmt::format("{:.4g} blocks", columns / cells_per_side) : "blocks";
  figure.x = {.title = "column", .unit = unit, .low = 0, .high = cells_per_side};
  figure.y = {.title = "row", .unit = unit, .low = 0, .high = cells_per_side};
  figure.downwards = true;
  figure.width = 340;
  figure.height = 330;
  figure.series = {cells(raster, title)};
  return figure;
}

}  // namespace

drawing::Figure convergence_figure(const Summary& summary) {
  drawing::Figure figure;
  figure.id = "convergence";
  figure.title = "chi2 per iteration";
  figure.description =
      "chi2 at every proposed step, above the lowest seen, by the kind of step. A rejected step was not "
      "taken. " +
      summary.message;
  figure.x = {.title = "iteration", .unit = "", .low = 0};
  figure.y = {.title = "chi2 above its lowest", .unit = "", .logarithmic = true};
  figure.height = 260;
  double lowest = std::min(summary.initial_chi2, summary.final_chi2);
  for (const IterationRecord& record : summary.records) {
    if (std::isfinite(record.chi2)) lowest = std::min(lowest, record.chi2);
  }
  // The last decreases are below the resolution of chi2.
  const double floor = std::max(std::abs(lowest) * 1e-13, 1e-300);
  const auto above = [&](double chi2) { return std::max(chi2 - lowest, floor); };
  drawing::Series way{.name = "accepted",
                      .mark = drawing::Mark::line,
                      .look = drawing::Look::truth,
                      .x = {0},
                      .y = {above(summary.initial_chi2)}};
  std::map<std::string, drawing::Series> of_kind;
  for (const IterationRecord& record : summary.records) {
    if (!std::isfinite(record.chi2)) continue;
    const std::string kind = record.accepted ? record.kind : record.kind + ", rejected";
    const auto [place, is_new] =
        of_kind.try_emplace(kind, drawing::Series{.name = kind, .mark = drawing::Mark::points});
    if (is_new)
      place->second.look =
          record.accepted ? drawing::look_of_system(of_kind.size() - 1) : drawing::Look::rejected;
    place->second.x.push_back(record.iteration);
    place->second.y.push_back(above(record.chi2));
    if (!record.accepted) continue;
    way.x.push_back(record.iteration);
    way.y.push_back(above(record.chi2));
  }
  figure.series.push_back(std::move(way));
  for (auto& [kind, series] : of_kind) figure.series.push_back(std::move(series));
  return figure;
}

drawing::Figure residual_figure(const evaluation::GraphResiduals& residuals) {
  drawing::Figure figure;
  figure.id = "residuals";
  figure.title = "Whitened residuals";
  figure.description =
      "Ordered whitened residuals of each type of measurement against the quantiles of a normal "
      "distribution of variance 1. On the line the noise is as stated. A flatter curve: the stated "
      "noise is too large. A steeper curve, or ends that bend away: the stated noise is too small, "
      "or there are outliers.";
  figure.x = {.title = "normal quantile", .unit = "sigma"};
  figure.y = {.title = "whitened residual", .unit = "sigma"};
  figure.height = 360;
  std::size_t index = 0;
  for (const evaluation::TypeResiduals& type : residuals.types) {
    if (type.role == evaluation::EdgeRole::measurement)
      figure.series.push_back(quantiles(type, drawing::look_of_system(index++)));
  }
  figure.series.push_back({.name = "as stated",
                           .mark = drawing::Mark::line,
                           .look = drawing::Look::reference,
                           .x = {-4, 4},
                           .y = {-4, 4}});
  return figure;
}

text::Table residual_table(const evaluation::GraphResiduals& residuals) {
  text::Table table{.title = "Residuals by edge type",
                    .columns = {"edge type", "role", "edges", "share of chi2 [%]", "component",
                                "mean [sigma]", "rms [sigma]", "largest [sigma]"}};
  for (const evaluation::TypeResiduals& type : residuals.types) {
    for (std::size_t k = 0; k < type.components.size(); ++k) {
      const evaluation::ScalarStatistics& s = type.components[k].statistics;
      const bool first = k == 0;
      table.rows.push_back({first ? edge_name(type.tag) : "", first ? to_string(type.role) : "",
                            first ? fmt::to_string(type.edges.size()) : "",
                            first ? fmt::format("{:.1f}", 100 * type.chi2_share) : "",
                            type.components[k].name, text::readable(s.mean), text::readable(s.rms),
                            text::readable(s.max_abs)});
    }
  }
  std::string tags;
  for (const evaluation::TypeResiduals& type : residuals.types)
    tags += fmt::format("{}{}: {}", tags.empty() ? "" : "; ", edge_name(type.tag), type.tag);
  table.notes = {"In the graph file: " + tags + "."};
  return table;
}

text::Table largest_residuals(const evaluation::GraphResiduals& residuals,
                              const std::function<double(Stamp)>& seconds) {
  text::Table table{
      .title = "The largest edges of each type",
      .columns = {"edge type", "edge", "time [s]", "vertices", "squared norm", "weight", "whitened [sigma]"}};
  for (const evaluation::TypeResiduals& type : residuals.types) {
    if (type.role != evaluation::EdgeRole::measurement) continue;
    const std::size_t most = std::min(type.largest.size(), kMostListed);
    for (const evaluation::LargeResidual& large : std::span(type.largest).first(most)) {
      std::string vertices;
      for (const VertexId id : large.vertices) {
        if (!vertices.empty()) vertices += " ";
        vertices += to_string(id);
      }
      const evaluation::EdgeResidual& edge = large.residual;
      table.rows.push_back({edge_name(type.tag), fmt::to_string(edge.edge),
                            edge.stamp ? fmt::format("{:.2f}", seconds(*edge.stamp)) : "", vertices,
                            text::readable(edge.squared), text::readable(edge.weight),
                            joined_numbers(large.whitened)});
    }
  }
  return table;
}

text::Table state_table(const std::vector<evaluation::StateReport>& states) {
  text::Table table{.title = "Estimated with the poses",
                    .columns = {"state", "unit", "values", "first", "last", "smallest", "largest", "sigma",
                                "sigma before", ""}};
  table.notes = {
      "sigma: of the last value, from the marginal covariance. sigma before: of the "
      "first value, from its prior."};
  for (const evaluation::StateReport& s : states) {
    table.rows.push_back({s.name, s.unit, fmt::to_string(s.values), text::readable(s.first),
                          text::readable(s.last), text::readable(s.smallest), text::readable(s.largest),
                          text::readable(s.sigma), text::readable(s.prior_sigma),
                          s.observed ? "" : "not observed by this drive"});
  }
  return table;
}

std::vector<drawing::Figure> state_figures(const std::vector<evaluation::StateReport>& states,
                                           const std::function<double(Stamp)>& seconds, drawing::Range time) {
  std::vector<drawing::Figure> figures;
  for (const evaluation::StateReport& state : states) {
    if (state.stamps.size() < 2) continue;
    drawing::Figure figure;
    figure.id = fmt::format("state-{}", figures.size() + 1);
    figure.title = state.name + " over time";
    const std::string unit = state.unit == "1" ? "" : state.unit;
    figure.description =
        fmt::format("Estimated with the poses: {} values. Sigma of the last: {}{}{}.", state.values,
                    text::readable(state.sigma), unit.empty() ? "" : " ", unit);
    figure.x = {.title = "time since start", .unit = "s", .low = time.low, .high = time.high};
    figure.y = {.title = state.name, .unit = unit};
    figure.motion = drawing::Motion::x;
    figure.link = "time";
    figure.height = 220;
    drawing::Series series{.name = state.name, .mark = drawing::Mark::line, .look = drawing::Look::first};
    for (std::size_t i = 0; i < state.stamps.size(); ++i) {
      series.x.push_back(seconds(state.stamps[i]));
      series.y.push_back(state.wandering[i]);
    }
    series.time = series.x;
    if (std::isfinite(state.sigma)) {
      figure.series.push_back({.name = "last, with its sigma",
                               .mark = drawing::Mark::points,
                               .look = drawing::Look::first,
                               .x = {series.x.back()},
                               .y = {state.last},
                               .low = {state.last - state.sigma},
                               .high = {state.last + state.sigma}});
    }
    figure.series.push_back(std::move(series));
    figures.push_back(std::move(figure));
  }
  return figures;
}

drawing::FigureRow sparsity_figures(const evaluation::Sparsity& sparsity) {
  return {{raster_figure(sparsity.natural, "sparsity-natural", "H, in the order of the graph",
                         "Lower triangle of the matrix of the normal equations. The fuller a cell, "
                         "the darker it is (root of its share)."),
           raster_figure(sparsity.ordered, "sparsity-ordered", "H, in the order of elimination",
                         fmt::format("The same matrix, ordering {}.", sparsity.ordering)),
           raster_figure(sparsity.factor_raster, "sparsity-factor", "Its Cholesky factor",
                         fmt::format("{:.4g} times the numbers of H.", sparsity.fill_ratio()))}};
}

std::string describe_sparsity(const evaluation::Sparsity& sparsity) {
  return fmt::format(
      "{} unknowns in {} block columns. H has {} blocks with {} numbers in its lower triangle, the factor {} "
      "blocks with {} numbers: {:.4g} times as many. Ordering: {}.",
      sparsity.dimension, sparsity.columns, sparsity.matrix.blocks, sparsity.matrix.scalars,
      sparsity.factor.blocks, sparsity.factor.scalars, sparsity.fill_ratio(), sparsity.ordering);
}

}  // namespace waymark::report
