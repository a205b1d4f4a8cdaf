/// Points placed from poses that have their place.
#pragma once

#include <vector>

#include <waymark/types_se2/start/detail/sightings.hpp>

namespace waymark {

/// Places each free point that is not placed yet from the placed poses that saw it. Sightings with a
/// range and a bearing give a place each; without any, pairs of rays that cross do. The point comes to the
/// median of these places by each coordinate, which a few false sightings do not move far. A point of ranges
/// alone comes to where their circles meet; of two such places, to the nearer one. A point of parallel rays, or of
/// one ray or circle, keeps its value.
/// @param placed per vertex, not zero: its value is right; of points also: it is left alone
/// @param values in the layout of Graph::values()
void place_points(const Graph& graph, std::vector<Sighting> sightings, const std::vector<char>& placed,
                  std::vector<double>& values);

}  // namespace waymark
