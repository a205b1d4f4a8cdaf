/// Axes of a figure: grid, ticks, labels, and what a map needs instead.
#pragma once

#include <string>

#include <waymark/tools/drawing/figure/figure.hpp>
#include <waymark/tools/drawing/figure/view.hpp>

namespace waymark::drawing {

[[nodiscard]] std::string axes_svg(const Figure& figure, const View& view);

/// A scale bar in the lower left corner and a north arrow in the upper right one.
[[nodiscard]] std::string map_ornaments_svg(const View& view);

}  // namespace waymark::drawing
