/// The data with which the script of a page moves its figures.
#pragma once

#include <string>
#include <vector>

#include <waymark/tools/drawing/figure/figure.hpp>
#include <waymark/tools/drawing/page/page_size.hpp>

namespace waymark::drawing {

/// Returns a JSON document that is safe inside a script element: {"columns": [...], "figures": {ID:
/// ...}}. Equal columns of numbers are stored once, and long ones are rounded (rounded_column.hpp).
/// Figures of cells are left out, because they do not move.
/// @param size how many points of each series the page carries
[[nodiscard]] std::string page_data(const std::vector<const Figure*>& figures, const PageSize& size);

}  // namespace waymark::drawing
