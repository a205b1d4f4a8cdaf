#include <algorithm>
#include <cmath>
#include <limits>

#include <waymark/tools/drawing/figure/bars.hpp>
#include <waymark/tools/drawing/figure/legend_svg.hpp>
#include <waymark/tools/drawing/figure/view.hpp>

namespace waymark::drawing {
namespace {

constexpr double kShareOfRow = 0.8;  // the rest is the gap between rows
constexpr double kBarHeight = 15;    // px, with its share of the gap
constexpr double kLeastRow = 22;     // px
constexpr double kNumber = 52;       // px for a number behind a bar

bool has_bar(const Series& series, double row) {
  for (std::size_t i = 0; i < series.x.size(); ++i)
    if (series.y[i] == row && std::isfinite(series.x[i])) return true;
  return false;
}

/// Returns the largest number of bars in any row.
std::size_t most_bars(const Figure& figure) {
  std::size_t most = 1;
  for (std::size_t row = 0; row < figure.y.categories.size(); ++row) {
    const auto bars = std::count_if(figure.series.begin(), figure.series.end(), [&](const Series& series) {
      return series.mark == Mark::bars && has_bar(series, static_cast<double>(row));
    });
    most = std::max(most, static_cast<std::size_t>(bars));
  }
  return most;
}

}  // namespace

BarPlace bar_place(const Figure& figure, std::size_t series, double row) {
  double bars = 0;
  double before = 0;
  for (std::size_t s = 0; s < figure.series.size(); ++s) {
    if (figure.series[s].mark != Mark::bars || !has_bar(figure.series[s], row)) continue;
    ++bars;
    if (s < series) ++before;
  }
  const double height = kShareOfRow / std::max(bars, 1.0);
  return {height * (before + 0.5) - 0.5 * kShareOfRow, height};
}

Series line_across(const std::string& name, double value, std::size_t rows) {
  return {.name = name,
          .mark = Mark::line,
          .look = Look::reference,
          .x = {value, value},
          .y = {-0.5, static_cast<double>(rows) - 0.5}};
}

void fit_bars(Figure& figure) {
  const double row = std::max(kLeastRow, kBarHeight * static_cast<double>(most_bars(figure)) / kShareOfRow);
  const View bare = full_view(figure, legend_rows(figure));
  const double around = figure.height - bare.box.height;
  figure.height = static_cast<int>(std::ceil(around + row * static_cast<double>(figure.y.categories.size())));
  if (figure.x.high) return;
  const double share = std::min(kNumber / bare.box.width, 0.5);
  const Range range = bare.x;
  figure.x.high = figure.x.logarithmic ? range.high * std::pow(range.high / range.low, share)
                                       : range.high + share * (range.high - range.low);
}

}  // namespace waymark::drawing
