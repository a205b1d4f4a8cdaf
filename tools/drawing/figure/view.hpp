/// The part of the data that a figure shows, its place on the drawing, and the ticks on its axes.
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

/// The rectangle of the plot inside the drawing, in px; y grows downwards.
struct PlotBox {
  double left = 0;
  double top = 0;
  double width = 1;
  double height = 1;
};

/// Maps data to px.
struct View {
  Range x;
  Range y;
  bool logarithmic_x = false;
  bool logarithmic_y = false;
  bool downwards = false;
  PlotBox box;
  double grain = 1;  ///< px, of thinning

  [[nodiscard]] double px_x(double value) const;
  [[nodiscard]] double px_y(double value) const;
  /// Tells whether a point can be drawn: its numbers are at most 1e150, and on a logarithmic axis
  /// at least 1e-150.
  [[nodiscard]] bool shows(double x_value, double y_value) const;
};

/// Returns the view of all data. @param rows_of_legend height that is reserved for the
/// legend at the top
[[nodiscard]] View full_view(const Figure& figure, int rows_of_legend);

struct Tick {
  double value = 0;
  std::string label;
};

/// Returns how many ticks fit on an axis with this width in px.
[[nodiscard]] int ticks_in_width(double width);
[[nodiscard]] int ticks_in_height(double height);

/// Estimates the width of a label in px. Fonts differ, so it is not exact.
[[nodiscard]] double text_width(std::string_view text);

/// Returns about `count` round numbers (1, 2 or 5 times a power of ten). On a logarithmic axis they
/// are powers of ten, and also 2 and 5 between them if the powers are few. There are at least
/// three.
[[nodiscard]] std::vector<Tick> ticks(Range range, bool logarithmic, int count);

/// Returns the largest of 1, 2, 5 times a power of ten that is at most `value`. @param value > 0
[[nodiscard]] double round_down_125(double value);

}  // namespace waymark::drawing
