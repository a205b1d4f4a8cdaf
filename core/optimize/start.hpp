/// Starts: methods that compute an initial guess from the edges of a graph, and not from the values
/// that came with it.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include <waymark/core/base/export.hpp>
#include <waymark/core/graph/graph.hpp>

namespace WAYMARK_EXPORT waymark {

/// Names beside those of the registered starts.
inline constexpr std::string_view kFileStart = "file";  ///< the values that came with the graph
inline constexpr std::string_view kAutoStart = "auto";  ///< the best one (multi_start.hpp)

/// The result of a start.
struct InitialValues {
  /// in the layout of Graph::values(); empty if the edges do not allow this start
  std::vector<double> values;
  std::string note;  ///< the reason for that, or a fact that the user should know; empty: none
  /// vertices that nothing joins to the first one that was placed; each part of them begins at its
  /// own first vertex
  std::size_t apart = 0;
};

/// A registered start. Fixed vertices keep their values. A part of the graph that nothing anchors
/// keeps the value of its first vertex, and so its place in the plane.
struct StartType {
  std::string name;
  std::string description;
  std::function<InitialValues(const Graph&)> make;
};

}  // namespace waymark
