/// Draws the axes of a figure: grid, ticks and labels. A map has a scale bar and a north arrow in
/// their place.
#pragma once

#include <string>

#include <waymark/tools/drawing/figure/figure.hpp>
#include <waymark/tools/drawing/figure/view.hpp>

namespace waymark::drawing {

[[nodiscard]] std::string axes_svg(const Figure& figure, const View& view);

/// Draws a scale bar in the lower left corner and a north arrow in the upper right one.
[[nodiscard]] std::string map_ornaments_svg(const View& view);

}  // namespace waymark::drawing
