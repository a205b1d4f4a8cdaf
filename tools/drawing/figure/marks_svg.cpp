#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include <waymark/tools/drawing/figure/bars.hpp>
#include <waymark/tools/drawing/figure/look.hpp>
#include <waymark/tools/drawing/figure/marks_svg.hpp>
#include <waymark/tools/drawing/figure/markup.hpp>
#include <waymark/tools/drawing/figure/thinning.hpp>
#include <waymark/tools/text/number_text.hpp>

namespace waymark::drawing {
namespace {

constexpr int kShades = 4;
constexpr double kMarkerRadius = 3;  // px
constexpr double kNumberWidth = 44;  // px, for a number behind a bar

std::string path(const Series& series, std::size_t index, const std::string& d, std::string_view kind) {
  return fmt::format("<path class=\"{} look-{}\" data-series=\"{}\" d=\"{}\"/>\n", kind,
                     style_of(series.look).name, index, d);
}

/// Appends tenths of a px as short as SVG allows: "-.5", and a space only if needed.
void append_tenths(std::string& d, long tenths) {
  if (tenths >= 0 && d.back() != 'l') d += ' ';
  if (tenths < 0) d += '-';
  const long size = std::abs(tenths);
  if (size >= 10 || size == 0) d += std::to_string(size / 10);
  if (size % 10 != 0) d += "." + std::to_string(size % 10);
}

/// Points may lie far outside of the plot.
long tenths_of(double px_value) {
  constexpr double kFarOutside = 1e15;
  return std::lround(std::clamp(10 * px_value, -kFarOutside, kFarOutside));
}

/// Returns a path through the points. All but the first are told by their distance from the one before, which takes
/// half of the bytes.
std::string polyline(const std::vector<DrawnPoint>& points, char first) {
  std::string d;
  long x = 0;
  long y = 0;
  for (const DrawnPoint& point : points) {
    const long next_x = tenths_of(point.x);
    const long next_y = tenths_of(point.y);
    if (d.empty()) {
      d = first + px(point.x) + " " + px(point.y) + "l";
    } else {
      append_tenths(d, next_x - x);
      append_tenths(d, next_y - y);
    }
    x = next_x;
    y = next_y;
  }
  if (points.size() == 1) d.pop_back();
  return d;
}

std::string line_path(const Series& series, const View& view) {
  std::string d;
  for (const auto& part : thin_line(series.x, series.y, view)) d += polyline(part, 'M');
  return d;
}

std::string markers(const Series& series, const View& view) {
  const std::string_view marker = style_of(series.look).marker;
  std::string d;
  for (const DrawnPoint& point : thin_points(series.x, series.y, view)) {
    d += fmt::format("M{} {}{}", px(point.x), px(point.y), marker);
  }
  return d;
}

std::string error_bars(const Series& series, const View& view) {
  std::string d;
  for (std::size_t i = 0; i < series.low.size(); ++i) {
    if (!view.shows(series.x[i], series.low[i]) || !view.shows(series.x[i], series.high[i])) continue;
    d += fmt::format("M{} {}V{}", px(view.px_x(series.x[i])), px(view.px_y(series.low[i])),
                     px(view.px_y(series.high[i])));
  }
  return d;
}

std::string band_path(const Series& series, const View& view) {
  const auto upper = thin_line(series.x, series.high, view);
  auto lower = thin_line(series.x, series.low, view);
  std::string d;
  for (std::size_t part = 0; part < std::min(upper.size(), lower.size()); ++part) {
    std::reverse(lower[part].begin(), lower[part].end());
    d += polyline(upper[part], 'M') + polyline(lower[part], 'L') + "Z";
  }
  return d;
}

/// Draws the rings of which a part is in the plot.
std::string areas_path(const Series& series, const View& view) {
  const PlotBox& box = view.box;
  std::string d;
  for (const auto& ring : thin_line(series.x, series.y, view)) {
    const auto [left, right] =
        std::minmax_element(ring.begin(), ring.end(), [](const auto& a, const auto& b) { return a.x < b.x; });
    const auto [top, bottom] =
        std::minmax_element(ring.begin(), ring.end(), [](const auto& a, const auto& b) { return a.y < b.y; });
    const bool misses = right->x < box.left || left->x > box.left + box.width || bottom->y < box.top ||
                        top->y > box.top + box.height;
    if (!misses && ring.size() > 2) d += polyline(ring, 'M') + "Z";
  }
  return d;
}

std::string spans_path(const Series& series, const View& view) {
  std::string d;
  double covered = -std::numeric_limits<double>::infinity();  // px, by the spans before
  for (std::size_t i = 0; i < series.low.size(); ++i) {
    const double left = view.px_x(series.low[i]);
    const double width = std::max(view.px_x(series.high[i]) - left, 1.0);
    if (left + width <= covered + 0.5) continue;
    covered = left + width;
    d += fmt::format("M{} {}h{}v{}h-{}z", px(left), px(view.box.top), px(width), px(view.box.height),
                     px(width));
  }
  return d;
}

/// Returns where the number of a bar begins, in px: behind the bar and behind points on it.
double behind_points(const Figure& figure, const View& view, double row, double height, double end) {
  for (const Series& series : figure.series) {
    if (series.mark != Mark::points) continue;
    for (std::size_t i = 0; i < series.x.size(); ++i) {
      if (std::abs(series.y[i] - row) > 0.5 * height || !view.shows(series.x[i], series.y[i])) continue;
      const double x = view.px_x(series.x[i]) + kMarkerRadius;
      if (x > end && x < end + kNumberWidth) end = x;
    }
  }
  return end;
}

std::string bars(const Figure& figure, std::size_t index, const View& view) {
  const Series& series = figure.series[index];
  const double row_height = std::abs(view.px_y(1) - view.px_y(0));
  const double origin = view.logarithmic_x ? view.box.left : view.px_x(std::max(view.x.low, 0.0));
  std::string boxes;
  std::string spread;
  std::string values;
  for (std::size_t i = 0; i < series.x.size(); ++i) {
    if (!view.shows(series.x[i], series.y[i])) continue;
    const BarPlace place = bar_place(figure, index, series.y[i]);
    const double height = place.height * row_height;
    const double y = view.px_y(series.y[i]) + place.offset * row_height;
    double end = view.px_x(series.x[i]);
    boxes += fmt::format("M{} {}H{}v{}H{}z", px(origin), px(y - 0.45 * height), px(end), px(0.9 * height),
                         px(origin));
    if (i < series.high.size() && view.shows(series.low[i], 0.0 + series.y[i])) {
      const double low = view.px_x(series.low[i]);
      const double high = view.px_x(series.high[i]);
      spread += fmt::format("M{} {}H{}m0-3v6M{} {}v6", px(low), px(y), px(high), px(low), px(y - 3));
      end = std::max(end, high);
    }
    if (height >= 8) {
      end = behind_points(figure, view, series.y[i] + place.offset, place.height, end);
      values += fmt::format("<text class=\"value\" data-series=\"{}\" x=\"{}\" y=\"{}\">{}</text>", index,
                            px(std::max(end, origin) + 5), px(y + 4), escaped(text::readable(series.x[i])));
    }
  }
  std::string svg = path(series, index, boxes, "bars");
  if (!style_of(series.look).hatch.empty())
    svg += fmt::format("<path fill=\"url(#{}-hatch-{})\" data-series=\"{}\" d=\"{}\"/>\n", figure.id,
                       style_of(series.look).name, index, boxes);
  if (!spread.empty()) svg += path(series, index, spread, "spread");
  return svg + values;
}

/// Draws cells in a few shades, with one path for each.
std::string cells(const Series& series, std::size_t index, const View& view) {
  std::array<std::string, kShades> of_shade;
  const double side_x = view.px_x(view.x.low + 1) - view.box.left;
  const double side_y = std::abs(view.px_y(view.y.low + 1) - view.px_y(view.y.low));
  for (std::size_t i = 0; i < series.x.size(); ++i) {
    if (!view.shows(series.x[i], series.y[i])) continue;
    const int shade = static_cast<int>(std::clamp(series.weight[i], 0.0, 0.999) * kShades);
    of_shade[static_cast<std::size_t>(shade)] +=
        fmt::format("M{:.2f} {:.2f}h{:.2f}v{:.2f}h-{:.2f}z", view.px_x(series.x[i]), view.px_y(series.y[i]),
                    side_x, side_y, side_x);
  }
  std::string svg;
  for (std::size_t shade = 0; shade < of_shade.size(); ++shade) {
    if (!of_shade[shade].empty())
      svg += path(series, index, of_shade[shade], fmt::format("cells shade-{}", shade + 1));
  }
  return svg;
}

}  // namespace

std::string_view name_of(Mark mark) {
  switch (mark) {
    case Mark::line:
      return "line";
    case Mark::points:
      return "points";
    case Mark::band:
      return "band";
    case Mark::spans:
      return "spans";
    case Mark::bars:
      return "bars";
    case Mark::cells:
      return "cells";
    case Mark::areas:
      return "areas";
  }
  return "";
}

std::string marks_svg(const Figure& figure, std::size_t index, const View& view) {
  const Series& series = figure.series[index];
  switch (series.mark) {
    case Mark::line:
      return path(series, index, line_path(series, view), "line");
    case Mark::points: {
      const std::string bars_of_error = error_bars(series, view);
      const std::string svg = path(series, index, markers(series, view), "points");
      return bars_of_error.empty() ? svg : path(series, index, bars_of_error, "spread") + svg;
    }
    case Mark::band:
      return path(series, index, band_path(series, view), "band");
    case Mark::spans:
      return path(series, index, spans_path(series, view), "spans");
    case Mark::bars:
      return bars(figure, index, view);
    case Mark::cells:
      return cells(series, index, view);
    case Mark::areas:
      return path(series, index, areas_path(series, view), "areas");
  }
  return "";
}

}  // namespace waymark::drawing
