#include <waymark/types_se2/edge_gnss.hpp>
#include <waymark/types_se2/edge_se2.hpp>
#include <waymark/types_se2/g2o_edges.hpp>
#include <waymark/types_se2/register.hpp>
#include <waymark/types_se2/start/detail/starts.hpp>

namespace waymark {

void register_se2_types(TypeRegistry& registry) {
  registry.add_vertex<VertexSe2>();
  registry.add_vertex<VertexXy>();
  registry.add_vertex<VertexTimeOffset>();
  registry.add_edge<EdgeSe2>();
  registry.add_edge<EdgeSe2Log>();
  registry.add_edge<EdgeGnssPosition>();
  registry.add_edge<EdgeGnssPositionLate>();
  registry.add_edge<EdgePriorSe2>();
  registry.add_edge<EdgeSe2Xy>();
  registry.add_edge<EdgePriorSe2Xy>();
  registry.add_edge<EdgePriorXy>();
  registry.add_edge<EdgeBearingSe2Xy>();
  registry.add_edge<EdgeSe2Offset>();
  registry.add_edge<EdgeSe2PointXyOffset>();
  registry.add_start(linear_start());  // the default configuration prefers the first entry
  registry.add_start(spanning_tree_start());
  registry.add_start(odometry_start());
}

}  // namespace waymark
