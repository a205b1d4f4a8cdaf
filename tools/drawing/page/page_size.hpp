/// Keeps a page below 5 MB, however long the drive. A page carries the numbers of its figures. If they are
/// too many, it carries points of each series that keep the shape. The files of the figures have all.
#pragma once

#include <cstddef>
#include <limits>
#include <vector>

#include <waymark/tools/drawing/figure/figure.hpp>

namespace waymark::drawing {

/// How many points of each series a page carries.
struct PageSize {
  std::size_t of_series = std::numeric_limits<std::size_t>::max();
  std::size_t of_track = std::numeric_limits<std::size_t>::max();  ///< of a line on a map
};

/// Returns the size with which the figures of a page fit. A drive of 100,000 poses fits as it is.
[[nodiscard]] PageSize size_that_fits(const std::vector<const Figure*>& figures);

/// Returns how many points of a series are carried.
[[nodiscard]] std::size_t points_carried(const Series& series, const Figure& figure, const PageSize& size);

/// Returns the indices of at most `most` points of a series, in order. Of every stretch of it they are the
/// first, the lowest, the highest and the last; on a map the first and the one that is farthest from the
/// line through first and last. Of single points on a map they are every so many.
[[nodiscard]] std::vector<std::size_t> points_that_keep_shape(const Series& series, bool on_map,
                                                              std::size_t most);

/// Returns the series with these points only.
[[nodiscard]] Series with_points(const Series& series, const std::vector<std::size_t>& indices);

}  // namespace waymark::drawing
