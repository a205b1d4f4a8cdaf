/// Wrong initial guesses of a drive, for the convergence table.
#pragma once

#include <array>
#include <numbers>

#include <waymark/core/graph/graph.hpp>
#include <waymark/types_se2/se2.hpp>

namespace waymark_test {

/// A way to spoil a dead-reckoned track. The fixes stay in place.
struct Spoiling {
  const char* name;
  double turn_deg;      ///< about its first pose
  bool begins_at_zero;  ///< moved so that the first pose is (0, 0)
};
inline constexpr Spoiling kSpoilings[] = {{"dead reckoning", 0, false},
                                          {"heading +30", 30, false},
                                          {"heading +90", 90, false},
                                          {"heading +180", 180, false},
                                          {"track at (0,0)", 0, true}};

/// Returns the graph with spoilt free vertices.
/// @param is_node vertices with a GNSS reading: they keep their place and only turn
template <typename IsNode>
[[nodiscard]] waymark::Graph spoil(const waymark::Graph& graph, const Spoiling& how, IsNode is_node) {
  using namespace waymark;
  Graph spoilt = graph;
  VertexIndex first = 0;
  while (graph.fixed(first)) ++first;
  const Eigen::Vector2d pivot(graph.value(first)[0], graph.value(first)[1]);
  const double turn = how.turn_deg * std::numbers::pi / 180;
  for (VertexIndex v = 0; v < static_cast<VertexIndex>(graph.vertex_count()); ++v) {
    if (graph.fixed(v)) continue;
    const auto value = graph.value(v);
    Eigen::Vector2d position(value[0], value[1]);
    if (!is_node(v)) {
      position = rotate(turn, Eigen::Vector2d(position - pivot));
      if (!how.begins_at_zero) position += pivot;
    }
    spoilt.set_value(v, std::array{position[0], position[1], wrap_angle(value[2] + turn)});
  }
  return spoilt;
}

}  // namespace waymark_test
