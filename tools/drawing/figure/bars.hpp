/// Figures of bars: rows of categories, one or several bars in each.
#pragma once

#include <cstddef>
#include <string>

#include <waymark/tools/drawing/figure/figure.hpp>

namespace waymark::drawing {

/// Where a bar stands in its row, in units of the rows' distance.
struct BarPlace {
  double offset = 0;  ///< of its middle from the row's, downwards
  double height = 0;
};

/// Bars of a row stand one below the other, in the order of the series. A row is shared by the series that
/// have something in it. @param row index of its category
[[nodiscard]] BarPlace bar_place(const Figure& figure, std::size_t series, double row);

/// Gives a figure of bars the height that its rows need, and its axis of values room for the numbers that
/// stand behind the bars. To be called when all series are there.
void fit_bars(Figure& figure);

/// A dashed line across all rows at a value: what is honest, equal, the reference.
[[nodiscard]] Series line_across(const std::string& name, double value, std::size_t rows);

}  // namespace waymark::drawing
