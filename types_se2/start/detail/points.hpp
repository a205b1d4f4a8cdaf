/// Points placed from poses that have their place.
#pragma once

#include <vector>

#include <waymark/types_se2/start/detail/sightings.hpp>

namespace waymark {

/// Where the poses that saw a point say that it is.
struct SeenPoint {
  VertexIndex point = -1;
  Eigen::Vector2d place = Eigen::Vector2d::Zero();
};

/// Returns the places of the points of some sightings, by their poses. Sightings with a
/// range and a bearing give a place each; without any, pairs of rays that cross do. The point is at the
/// median of these places by each coordinate, which a few false sightings do not move far. A point of ranges
/// alone is where their circles meet; of two such places, at the nearer one to its value. A point of parallel
/// rays, or of one ray or circle, has no place.
/// @param values in the layout of Graph::values()
[[nodiscard]] std::vector<SeenPoint> seen_points(const Graph& graph, std::vector<Sighting> sightings,
                                                 const std::vector<double>& values);

/// Places each free point that is not placed yet from the placed poses that saw it, if they say a place.
/// @param placed per vertex, not zero: its value is right; of points also: it is left alone
/// @param values in the layout of Graph::values()
void place_points(const Graph& graph, std::vector<Sighting> sightings, const std::vector<char>& placed,
                  std::vector<double>& values);

}  // namespace waymark
