#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <waymark/tools/drawing/figure/axes_svg.hpp>
#include <waymark/tools/drawing/figure/figure_svg.hpp>
#include <waymark/tools/drawing/figure/legend_svg.hpp>
#include <waymark/tools/drawing/figure/look.hpp>
#include <waymark/tools/drawing/figure/marks_svg.hpp>
#include <waymark/tools/drawing/figure/markup.hpp>
#include <waymark/tools/drawing/page/page_assets.hpp>

namespace waymark::drawing {
namespace {

std::string title_and_description(const Figure& figure) {
  return fmt::format("<title id=\"{0}-title\">{1}</title><desc id=\"{0}-desc\">{2}</desc>\n", figure.id,
                     escaped(figure.title), escaped(figure.description));
}

std::string opening(const Figure& figure, std::string_view attributes, std::string_view classes) {
  return fmt::format(
      "<svg {0}class=\"{4}\" viewBox=\"0 0 {1} {2}\" role=\"img\" "
      "aria-labelledby=\"{3}-title {3}-desc\">\n",
      attributes, figure.width, figure.height, figure.id, classes);
}

/// Returns tiles of strokes over bars, for the looks whose bars the figure has.
std::string hatching(const Figure& figure) {
  std::string svg;
  for (const LookStyle& look : all_looks()) {
    const bool used = std::any_of(figure.series.begin(), figure.series.end(), [&](const Series& series) {
      return series.mark == Mark::bars && series.look == look.look;
    });
    if (!used || look.hatch.empty()) continue;
    svg += fmt::format(
        "<pattern id=\"{}-hatch-{}\" width=\"6\" height=\"6\" patternUnits=\"userSpaceOnUse\"><path "
        "class=\"hatch\" d=\"{}\"/></pattern>\n",
        figure.id, look.name, look.hatch);
  }
  return svg;
}

std::string drawing(const Figure& figure) {
  const View view = drawn_view(figure);
  std::string svg = hatching(figure) + legend_svg(figure, view);
  svg += fmt::format(
      "<clipPath id=\"{}-clip\"><rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\"/></clipPath>\n", figure.id,
      px(view.box.left), px(view.box.top), px(view.box.width), px(view.box.height));
  svg += "<g class=\"axes\">" + axes_svg(figure, view) + "</g>\n";
  svg += fmt::format("<g class=\"marks\" clip-path=\"url(#{}-clip)\">\n", figure.id);
  for (std::size_t s = 0; s < figure.series.size(); ++s) svg += marks_svg(figure, s, view);
  svg += "</g>\n";
  if (figure.geographic) svg += "<g class=\"ornaments\">" + map_ornaments_svg(view) + "</g>\n";
  return svg;
}

}  // namespace

std::string heading(const Axis& axis) {
  return axis.unit.empty() ? axis.title : fmt::format("{} [{}]", axis.title, axis.unit);
}

View drawn_view(const Figure& figure) {
  return full_view(figure, legend_rows(figure));
}

std::string figure_style() {
  std::string style(kFigureStyle);
  // No CSS variables are used, because SVG editors do not support them.
  for (const LookStyle& look : all_looks()) {
    style += fmt::format(
        ".line.look-{0},.points.look-{0}{{stroke:{1}}}\n"
        ".bars.look-{0},.band.look-{0},.spans.look-{0},.cells.look-{0},.areas.look-{0}{{fill:{1}}}\n",
        look.name, look.colour);
    if (!look.dash.empty())
      style += fmt::format(".line.look-{}{{stroke-dasharray:{}}}\n", look.name, look.dash);
  }
  return style;
}

std::string figure_svg(const Figure& figure) {
  const std::string attributes = fmt::format(
      "xmlns=\"http://www.w3.org/2000/svg\" width=\"{}\" height=\"{}\" ", figure.width, figure.height);
  return opening(figure, attributes, "plot") + title_and_description(figure) + "<style>" + figure_style() +
         "</style>\n<rect class=\"paper\" width=\"100%\" height=\"100%\"/>\n" + drawing(figure) + "</svg>\n";
}

std::string inline_svg(const Figure& figure, std::string_view screen) {
  // Far above its own size a drawing would have letters like headings.
  const double largest = figure.width >= Figure().width ? 1.45 : 1.1;
  const std::string attributes = fmt::format("style=\"max-width:{:.0f}px\" ", figure.width * largest);
  return opening(figure, attributes, fmt::format("plot {}", screen)) + title_and_description(figure) +
         drawing(figure) + "</svg>\n";
}

}  // namespace waymark::drawing
