/// Starts: ways to initial values that read a graph's edges rather than the values it came with.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include <waymark/core/graph/graph.hpp>

namespace waymark {

/// What a start makes of a graph.
struct InitialValues {
  std::vector<double> values;  ///< laid out as Graph::values(); empty where the edges do not allow this start
  std::string note;            ///< why not, or what the user should know; empty where all was well
  std::size_t apart = 0;  ///< vertices that nothing joins to the first one that was placed: each part of them
                          ///< begins at its own first vertex
};

/// A registered start. Fixed vertices keep their values; a part of the graph that nothing anchors keeps the
/// value of its first vertex, and with it its place in the plane.
struct StartType {
  std::string name;
  std::string description;
  std::function<InitialValues(const Graph&)> make;
};

}  // namespace waymark
