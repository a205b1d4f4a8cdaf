#include <cmath>

#include <fmt/format.h>

#include <waymark/tools/drawing/figure/axes_svg.hpp>
#include <waymark/tools/drawing/figure/markup.hpp>

namespace waymark::drawing {
namespace {

/// Cuts the middle out of a long name, because names often differ at the end.
std::string fitted(const std::string& name, double width) {
  std::string text = name;
  for (std::size_t half = name.size() / 2; half > 4 && text_width(text) > width; --half)
    text = name.substr(0, half) + "..." + name.substr(name.size() - half);
  return text;
}

/// @param width px available for a name
std::vector<Tick> category_ticks(const Axis& axis, double width) {
  std::vector<Tick> result;
  for (std::size_t i = 0; i < axis.categories.size(); ++i)
    result.push_back({static_cast<double>(i), fitted(axis.categories[i], width)});
  return result;
}

std::string label(const char* kind, double x, double y, const std::string& text) {
  return fmt::format("<text class=\"{}\" x=\"{}\" y=\"{}\">{}</text>", kind, px(x), px(y), escaped(text));
}

}  // namespace

std::string axes_svg(const Figure& figure, const View& view) {
  const PlotBox& box = view.box;
  const double bottom = box.top + box.height;
  std::string grid;
  std::string labels;
  for (const Tick& tick : ticks(view.x, view.logarithmic_x, ticks_in_width(box.width))) {
    const double x = view.px_x(tick.value);
    grid += fmt::format("M{} {}v{}", px(x), px(box.top), px(box.height));
    labels += label("tick-x", x, bottom + 16, tick.label);
  }
  const std::vector<Tick> rows = figure.y.categories.empty()
                                     ? ticks(view.y, view.logarithmic_y, ticks_in_height(box.height))
                                     : category_ticks(figure.y, box.left - 16);
  for (const Tick& tick : rows) {
    const double y = view.px_y(tick.value);
    if (figure.y.categories.empty()) grid += fmt::format("M{} {}h{}", px(box.left), px(y), px(box.width));
    labels += label("tick-y", box.left - 8, y + 4, tick.label);
  }
  std::string svg = fmt::format("<path class=\"grid\" d=\"{}\"/>{}", grid, labels);
  svg += fmt::format("<rect class=\"frame\" x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\"/>", px(box.left),
                     px(box.top), px(box.width), px(box.height));
  svg += label("title-x", box.left + box.width / 2, bottom + 36, heading(figure.x));
  if (figure.y.categories.empty()) {
    svg += fmt::format("<text class=\"title-y\" transform=\"translate(15 {}) rotate(-90)\">{}</text>",
                       px(box.top + box.height / 2), escaped(heading(figure.y)));
  }
  return svg;
}

std::string map_ornaments_svg(const View& view) {
  const PlotBox& box = view.box;
  const double px_per_metre = box.width / (view.x.high - view.x.low);
  const double length = round_down_125(box.width / 4 / px_per_metre);
  const std::string text =
      length >= 1000 ? fmt::format("{:g} km", length / 1000) : fmt::format("{:g} m", length);
  const double x = box.left + 16;
  const double y = box.top + box.height - 16;
  std::string svg = fmt::format("<path class=\"scale-bar\" d=\"M{} {}v6h{}v-6\"/>", px(x), px(y - 6),
                                px(length * px_per_metre));
  svg += label("scale-text", x + length * px_per_metre / 2, y - 5, text);
  svg += fmt::format(
      "<g class=\"north\" transform=\"translate({} {})\"><path d=\"M0-16l6 18l-6-4l-6 4z\"/><text "
      "y=\"16\">N</text></g>",
      px(box.left + box.width - 22), px(box.top + 26));
  return svg;
}

}  // namespace waymark::drawing
