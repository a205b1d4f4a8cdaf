// Two poses, one measurement between them, one call.
#include <iostream>

#include <waymark/solvers/optimize.hpp>
#include <waymark/types_se2/edge_se2.hpp>

using namespace waymark;

int main() {
  Graph graph;
  const VertexIndex start = graph.add_vertex<VertexSe2>(VertexId{1}, {0, 0, 0});  // x, y in m, heading in rad
  const VertexIndex end = graph.add_vertex<VertexSe2>(VertexId{2}, {9, 1, 0.2});  // a rough guess
  graph.set_fixed(start, true);
  graph.add_edge(EdgeSe2{{10, 0, 0}}, {start, end}, Eigen::Matrix3d::Identity());  // "10 m straight on"
  const MultiStartSummary summary = optimize(graph);
  const Pose2<double> pose = graph.value<VertexSe2>(end);
  std::cout << summary.brief() << "\nend: " << pose.vector().transpose() << "\n";
  return summary.converged() && (pose.vector() - Eigen::Vector3d(10, 0, 0)).norm() < 1e-9 ? 0 : 1;
}
