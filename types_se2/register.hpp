/// Registration of the SE(2) vocabulary.
#pragma once

#include <waymark/core/registry/registry.hpp>

namespace waymark {

/// Registers VERTEX_SE2, VERTEX_XY, EDGE_SE2, EDGE_SE2_LOG, EDGE_GNSS_POSITION, EDGE_PRIOR_SE2,
/// EDGE_SE2_XY, the other plane edges of g2o (g2o_edges.hpp), and the starts (initial guesses)
/// odometry, spanning_tree and linear.
void register_se2_types(TypeRegistry& registry);

}  // namespace waymark
