/// Draws the legend of a figure: samples of the marks with their names, in rows above the plot.
#pragma once

#include <string>

#include <waymark/tools/drawing/figure/figure.hpp>
#include <waymark/tools/drawing/figure/view.hpp>

namespace waymark::drawing {

/// Returns the number of rows. It is 0 if at most one series has a name, because the axis already
/// says what it is.
[[nodiscard]] int legend_rows(const Figure& figure);

/// Returns the legend. Each entry is a group of class "entry" with the index of the series in
/// data-series.
[[nodiscard]] std::string legend_svg(const Figure& figure, const View& view);

}  // namespace waymark::drawing
