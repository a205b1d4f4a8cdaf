/// A drive with G1. One state scales every tenth step, so its column is dense and all
/// chunks add to it.
#pragma once

#include "support/problems.hpp"
#include "support/scalar_types.hpp"

namespace waymark_test {

[[nodiscard]] inline waymark::Graph calibrated_drive(const waymark::TypeRegistry& registry, int poses) {
  Drive drive = make_drive(registry, poses);
  drive.add_fixes(registry, "g1");
  const waymark::VertexIndex scale =
      drive.graph.add_vertex<VertexScale>(waymark::VertexId{10'000'000}, {1.01});
  for (int i = 0; i + 1 < poses; i += 10) {
    drive.graph.add_edge(EdgeScaledOdometry{0.36, 0.001}, {i, scale, i + 1}, pose_information(0.1, 0.02));
  }
  return std::move(drive.graph);
}

}  // namespace waymark_test
