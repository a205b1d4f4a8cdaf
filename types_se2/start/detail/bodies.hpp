/// Bodies: sets of poses whose places to each other are known, such as the track of one robot. Points that
/// several bodies see tell where the bodies are to each other.
#pragma once

#include <vector>

#include <waymark/types_se2/start/detail/sightings.hpp>

namespace waymark {

inline constexpr int kNoBody = -1;  ///< a vertex that takes no part
inline constexpr int kWorldBody =
    0;  ///< poses that have their place in the frame; fixed points belong to it too

/// Tells whether there may be something to join: two bodies, or one and something fixed. @param bodies as below
[[nodiscard]] bool has_several(const Graph& graph, const std::vector<int>& bodies);

/// Moves whole bodies so that the points they share come together: each body to where its points are known
/// already, the one with the most such points first. Where none belongs to the world, the body with the lowest
/// number stays. A body with fewer than two such points, or of which no two are as
/// far apart as it sees them (rigid_alignment.hpp), stays too.
/// @param bodies per vertex: the number of its body
/// @param values in the layout of Graph::values(); poses are moved, points are not
/// @return per vertex, not zero: it is a pose that was moved
[[nodiscard]] std::vector<char> join_bodies(const Graph& graph, std::vector<Sighting> sightings,
                                            const std::vector<int>& bodies, std::vector<double>& values);

}  // namespace waymark
