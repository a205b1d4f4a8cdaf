/// Bar figures: rows of categories with one or several bars in each.
#pragma once

#include <cstddef>
#include <string>

#include <waymark/tools/drawing/figure/figure.hpp>

namespace waymark::drawing {

/// The place of a bar in its row, in units of the row distance.
struct BarPlace {
  double offset = 0;  ///< from the middle of the row to the middle of the bar, downwards
  double height = 0;
};

/// Returns the place of a bar. The bars of a row are stacked downwards in the order of the series.
/// Only series with a value in the row share it. @param row index of its category
[[nodiscard]] BarPlace bar_place(const Figure& figure, std::size_t series, double row);

/// Sets the height of a bar figure to what its rows need. It also makes room on the value axis for
/// the numbers behind the bars. Call it after all series have been added.
void fit_bars(Figure& figure);

/// Returns a dashed line across all rows at a value, for example at a reference.
[[nodiscard]] Series line_across(const std::string& name, double value, std::size_t rows);

}  // namespace waymark::drawing
