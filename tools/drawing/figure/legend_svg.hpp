/// The legend of a figure: samples of the marks with their names, in rows above the plot.
#pragma once

#include <string>

#include <waymark/tools/drawing/figure/figure.hpp>
#include <waymark/tools/drawing/figure/view.hpp>

namespace waymark::drawing {

/// 0 where one series or none has a name: its axis says then what it is.
[[nodiscard]] int legend_rows(const Figure& figure);

/// Each entry is a group of class "entry" with the series' index in data-series.
[[nodiscard]] std::string legend_svg(const Figure& figure, const View& view);

}  // namespace waymark::drawing
