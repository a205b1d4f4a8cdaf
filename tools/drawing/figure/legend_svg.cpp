#include <algorithm>
#include <vector>

#include <fmt/format.h>

#include <waymark/tools/drawing/figure/legend_svg.hpp>
#include <waymark/tools/drawing/figure/look.hpp>
#include <waymark/tools/drawing/figure/markup.hpp>

namespace waymark::drawing {
namespace {

constexpr double kSample = 34;  // px, with the space after it
constexpr double kBetween = 18;
constexpr double kRow = 20;

struct Entry {
  std::size_t series = 0;
  double x = 0;
  int row = 0;
};

std::vector<Entry> entries(const Figure& figure) {
  std::vector<Entry> result;
  double x = 0;
  int row = 0;
  for (std::size_t s = 0; s < figure.series.size(); ++s) {
    if (figure.series[s].name.empty()) continue;
    const double width = kSample + text_width(figure.series[s].name);
    if (x > 0 && x + width > figure.width - 20) {
      x = 0;
      ++row;
    }
    result.push_back({s, x, row});
    x += width + kBetween;
  }
  if (result.size() < 2) result.clear();
  return result;
}

std::string sample(const Figure& figure, const Series& series) {
  const LookStyle& look = style_of(series.look);
  switch (series.mark) {
    case Mark::line:
      return fmt::format("<path class=\"line look-{}\" d=\"M0 0h28\"/>", look.name);
    case Mark::points:
      return fmt::format("<path class=\"points look-{}\" d=\"M14 0{}\"/>", look.name, look.marker);
    case Mark::band:
    case Mark::spans:
    case Mark::bars:
    case Mark::cells:
    case Mark::areas:
      break;
  }
  const char* kind = series.mark == Mark::bars    ? "bars"
                     : series.mark == Mark::spans ? "spans"
                     : series.mark == Mark::areas ? "areas"
                                                  : "band";
  static constexpr const char* kBox = "M2-5h24v10h-24z";
  std::string svg = fmt::format("<path class=\"{} look-{}\" d=\"{}\"/>", kind, look.name, kBox);
  if (series.mark == Mark::bars && !look.hatch.empty())
    svg += fmt::format("<path fill=\"url(#{}-hatch-{})\" d=\"{}\"/>", figure.id, look.name, kBox);
  return svg;
}

}  // namespace

int legend_rows(const Figure& figure) {
  const std::vector<Entry> all = entries(figure);
  return all.empty() ? 0 : all.back().row + 1;
}

std::string legend_svg(const Figure& figure, const View& view) {
  std::string svg = "<g class=\"legend\">";
  // The legend begins above the plot if there is room, or else at the edge.
  const std::vector<Entry> all = entries(figure);
  const double left = all.empty() || all.back().row == 0 ? std::min(view.box.left, 20.0) : 10;
  for (const Entry& entry : all) {
    const Series& series = figure.series[entry.series];
    svg += fmt::format(
        "<g class=\"entry\" data-series=\"{}\" transform=\"translate({} {})\">{}<text x=\"{}\" "
        "y=\"4\">{}</text></g>",
        entry.series, px(left + entry.x), px(14 + kRow * entry.row), sample(figure, series), kSample,
        escaped(series.name));
  }
  return svg + "</g>\n";
}

}  // namespace waymark::drawing
