/// Draws the marks of a series as SVG paths. There is one path per series, however many
/// points it has.
#pragma once

#include <cstddef>
#include <string>

#include <waymark/tools/drawing/figure/figure.hpp>
#include <waymark/tools/drawing/figure/view.hpp>

namespace waymark::drawing {

/// Returns paths of class MARK and look-LOOK with the index of the series in data-series.
[[nodiscard]] std::string marks_svg(const Figure& figure, std::size_t series, const View& view);

/// Returns the name of a mark in style sheet and page data: "line", "points", ...
[[nodiscard]] std::string_view name_of(Mark mark);

}  // namespace waymark::drawing
