/// The marks of one series as SVG paths: one path a series, however many points it has.
#pragma once

#include <cstddef>
#include <string>

#include <waymark/tools/drawing/figure/figure.hpp>
#include <waymark/tools/drawing/figure/view.hpp>

namespace waymark::drawing {

/// Paths of class MARK and look-LOOK with the series' index in data-series.
[[nodiscard]] std::string marks_svg(const Figure& figure, std::size_t series, const View& view);

/// Name of a mark in style sheet and page data: "line", "points", ...
[[nodiscard]] std::string_view name_of(Mark mark);

}  // namespace waymark::drawing
