/// Words at the beginning of a line that no type is registered for.
#pragma once

#include <string_view>

namespace waymark::formats {

/// Vertices and edges of TORO and GTSAM.
inline constexpr std::string_view kToroTags[] = {"VERTEX2", "EDGE2", "VERTEX", "EDGE", "ODOMETRY"};
/// Beginnings of the tags of graphs in space, of g2o and TORO.
inline constexpr std::string_view kSpaceTags[] = {"VERTEX_SE3", "EDGE_SE3", "VERTEX_TRACKXYZ", "VERTEX3",
                                                  "EDGE3"};

/// Tells whether a tag is of a graph in space.
constexpr bool is_of_space(std::string_view tag) {
  for (const std::string_view beginning : kSpaceTags)
    if (tag.starts_with(beginning)) return true;
  return false;
}

}  // namespace waymark::formats
