/// The metric frame of a graph: one UTM zone with a stored local origin.
#pragma once

#include <waymark/core/base/export.hpp>

namespace WAYMARK_EXPORT waymark {

/// x = UTM easting - origin_easting and y = UTM northing - origin_northing, both in grid metres.
/// The heading is in radians, counter-clockwise from grid east. `zone` 0 means a frame without a
/// known place (plain pose-graph files).
struct Frame {
  int zone = 0;                  ///< UTM zone 1..60, or 0 for a local frame
  bool north = true;             ///< hemisphere
  double origin_easting_m = 0;   ///< UTM easting of (0, 0)
  double origin_northing_m = 0;  ///< UTM northing of (0, 0)

  friend bool operator==(const Frame&, const Frame&) = default;
};

}  // namespace waymark
