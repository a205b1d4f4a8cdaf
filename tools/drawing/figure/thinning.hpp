/// Which points of a series can be left out of a drawing without being missed: at most a few a pixel are
/// drawn, whatever the length of the series. The page's script thins by the same rules for what is in view.
#pragma once

#include <cstddef>
#include <vector>

#include <waymark/tools/drawing/figure/view.hpp>

namespace waymark::drawing {

/// A point that is drawn, px. `index` is its place in the series.
struct DrawnPoint {
  double x = 0;
  double y = 0;
  std::size_t index = 0;
};

/// Parts of a line, each unbroken. Where x ascends, the first, lowest, highest and last point of every column
/// of pixels are kept: the drawn line covers the same pixels. Elsewhere points that are less than 0.4 px from
/// the last one kept are left out.
[[nodiscard]] std::vector<std::vector<DrawnPoint>> thin_line(const std::vector<double>& x,
                                                             const std::vector<double>& y, const View& view);

/// Markers, at most one in a square of 1.5 px.
[[nodiscard]] std::vector<DrawnPoint> thin_points(const std::vector<double>& x, const std::vector<double>& y,
                                                  const View& view);

}  // namespace waymark::drawing
