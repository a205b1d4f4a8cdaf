/// The numbers of a figure as CSV.
#pragma once

#include <string>

#include <waymark/tools/drawing/figure/figure.hpp>

namespace waymark::drawing {

/// RFC 4180 with "\n" line ends, one row a point: series, x and y under the headings of their axes, and,
/// where a series has them, low, high, weight, time [s], note. Numbers in the shortest form that reads back
/// exactly; what is not defined is an empty field.
[[nodiscard]] std::string figure_csv(const Figure& figure);

}  // namespace waymark::drawing
