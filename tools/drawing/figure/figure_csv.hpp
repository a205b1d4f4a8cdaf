/// The numbers of a figure as CSV.
#pragma once

#include <string>

#include <waymark/tools/drawing/figure/figure.hpp>

namespace waymark::drawing {

/// Returns CSV (RFC 4180 with "\n" line ends) with one row per point: the series, and x and y
/// under the titles of their axes. The columns low, high, weight, time [s] and note follow if some
/// series has them. Numbers have the shortest form that reads back exactly. Undefined values are
/// empty fields.
[[nodiscard]] std::string figure_csv(const Figure& figure);

}  // namespace waymark::drawing
