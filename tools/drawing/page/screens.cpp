#include <algorithm>

#include <waymark/tools/drawing/figure/legend_svg.hpp>
#include <waymark/tools/drawing/page/screens.hpp>

namespace waymark::drawing {
namespace {

constexpr int kNarrow = 340;   // px: a telephone of 360 px, less its margins
constexpr int kWide = 1320;    // px: a screen of 1400 px, less its margins
constexpr int kTallest = 460;  // px: a map on a telephone leaves room to scroll past it
constexpr int kRowOfLegend = 20;
constexpr double kCoarse = 3;  // px

/// Returns the rows of the legend if the figure had this width.
int rows_at(int width, const Figure& figure) {
  Figure names;
  names.width = width;
  for (const Series& series : figure.series) names.series.push_back({.name = series.name});
  return legend_rows(names);
}

}  // namespace

void DrawingForScreen::apply(Figure& figure) const {
  figure.id = id;
  figure.width = width;
  figure.height = height;
  figure.grain = grain;
}

std::vector<DrawingForScreen> drawings_for_screens(const Figure& figure) {
  const bool is_whole = figure.width >= Figure().width;
  const int narrow = std::min(figure.width, kNarrow);
  // A narrow legend has more rows, which must not be taken from the plot.
  const int more_rows = std::max(rows_at(narrow, figure) - rows_at(figure.width, figure), 0);
  const int height = is_whole ? figure.height : figure.height * narrow / figure.width;
  std::vector<DrawingForScreen> drawings = {{"narrow", figure.id + "-narrow", narrow,
                                             std::min(height, kTallest) + kRowOfLegend * more_rows, kCoarse}};
  if (is_whole) drawings.push_back({"wide", figure.id + "-wide", kWide, figure.height, kCoarse});
  drawings.push_back({"usual", figure.id, figure.width, figure.height});
  return drawings;
}

}  // namespace waymark::drawing
