/// Which part of the data a figure shows, where on the drawing, and the ticks on its axes.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <waymark/tools/drawing/figure/figure.hpp>

namespace waymark::drawing {

struct Range {
  double low = 0;
  double high = 1;
};

/// The rectangle of the plot inside the drawing, px; y downwards.
struct PlotBox {
  double left = 0;
  double top = 0;
  double width = 1;
  double height = 1;
};

/// From data to px.
struct View {
  Range x;
  Range y;
  bool logarithmic_x = false;
  bool logarithmic_y = false;
  bool downwards = false;
  PlotBox box;

  [[nodiscard]] double px_x(double value) const;
  [[nodiscard]] double px_y(double value) const;
  /// Whether a point has a place: at most 1e150, and at least 1e-150 on a logarithmic axis.
  [[nodiscard]] bool shows(double x_value, double y_value) const;
};

/// The whole of the data in the whole figure. @param rows_of_legend height that is left for it at the top
[[nodiscard]] View full_view(const Figure& figure, int rows_of_legend);

struct Tick {
  double value = 0;
  std::string label;
};

/// How many ticks an axis of so many px has room for.
[[nodiscard]] int ticks_in_width(double width);
[[nodiscard]] int ticks_in_height(double height);

/// About what a text takes at the size of labels, px: fonts differ.
[[nodiscard]] double text_width(std::string_view text);

/// Round numbers (1, 2 or 5 times a power of ten), about `count` of them; on a logarithmic axis the powers of
/// ten, with 2 and 5 between where those are few.
[[nodiscard]] std::vector<Tick> ticks(Range range, bool logarithmic, int count);

/// The largest of 1, 2, 5 times a power of ten that is at most `value`. @param value > 0
[[nodiscard]] double round_down_125(double value);

}  // namespace waymark::drawing
