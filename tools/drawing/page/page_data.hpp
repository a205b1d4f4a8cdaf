/// The data that a page's script needs to move its figures.
#pragma once

#include <string>
#include <vector>

#include <waymark/tools/drawing/figure/figure.hpp>

namespace waymark::drawing {

/// A JSON document that may stand in a script element: {"columns": [...], "figures": {ID: ...}}. Equal
/// columns of numbers are there once, long ones packed (packed_column.hpp). Figures of cells are left out:
/// they do not move.
[[nodiscard]] std::string page_data(const std::vector<const Figure*>& figures);

}  // namespace waymark::drawing
