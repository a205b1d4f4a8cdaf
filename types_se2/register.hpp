/// Registration of the SE(2) vocabulary.
#pragma once

#include <waymark/core/registry/registry.hpp>

namespace waymark {

/// VERTEX_SE2, VERTEX_XY, EDGE_SE2, EDGE_SE2_LOG, EDGE_GNSS_POSITION, EDGE_PRIOR_SE2, EDGE_SE2_XY; the rest
/// of g2o's plane edges (g2o_edges.hpp); the starts odometry, spanning_tree, linear.
void register_se2_types(TypeRegistry& registry);

}  // namespace waymark
