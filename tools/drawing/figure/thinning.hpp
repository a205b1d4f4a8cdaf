/// Thinning: leaves out points of a series that a reader would not miss. At most a few points per
/// pixel are drawn, whatever the length of the series. The script of the page uses the same rules
/// for the visible part.
#pragma once

#include <cstddef>
#include <vector>

#include <waymark/tools/drawing/figure/view.hpp>

namespace waymark::drawing {

/// A point that is drawn, in px. `index` is its place in the series.
struct DrawnPoint {
  double x = 0;
  double y = 0;
  std::size_t index = 0;
};

/// Returns the unbroken parts of a line. As long as x ascends, it keeps the first, lowest, highest
/// and last point of every column that is a grain wide, so with a grain of 1 px the line covers the
/// same pixels. Otherwise it leaves out points less than 0.4 grains from the last one kept.
[[nodiscard]] std::vector<std::vector<DrawnPoint>> thin_line(const std::vector<double>& x,
                                                             const std::vector<double>& y, const View& view);

/// Returns markers, at most one in a square of 2.5 grains.
[[nodiscard]] std::vector<DrawnPoint> thin_points(const std::vector<double>& x, const std::vector<double>& y,
                                                  const View& view);

}  // namespace waymark::drawing
