#include <algorithm>

#include <Eigen/Geometry>

#include <waymark/core/base/detail/disjoint_sets.hpp>
#include <waymark/core/base/detail/index.hpp>
#include <waymark/core/system/detail/components.hpp>
#include <waymark/core/system/detail/incidence.hpp>

namespace waymark::detail {

// The name of a set is its first vertex.
std::vector<std::int32_t> find_components(const Graph& graph) {
  DisjointSets sets(graph.vertex_count());
  for (std::size_t b = 0; b < graph.batch_count(); ++b) {
    for_each_edge(graph.batch(b), [&](std::span<const VertexIndex> vertices) {
      VertexIndex joined = -1;
      for (const VertexIndex v : vertices) {
        if (graph.fixed(v)) continue;
        joined = joined < 0 ? v : sets.join(joined, v);
      }
    });
  }
  std::vector<std::int32_t> first(graph.vertex_count());
  for (std::size_t v = 0; v < first.size(); ++v) first[v] = sets.of(static_cast<VertexIndex>(v));
  return first;
}

Eigen::MatrixXd motion_of(const Graph& graph, VertexIndex v, const RigidMotionView::Place& place) {
  const VertexType& type = graph.vertex_type(v);
  Eigen::MatrixXd motion(type.tangent_size, 3);
  type.rigid_motion(graph.value(v).data(), place.centre, place.extent, motion.data());
  return motion;
}

Eigen::VectorXd own_turn(const Graph& graph, VertexIndex v) {
  const RigidMotionView::Place here{graph.vertex_type(v).position(graph.value(v).data()), 1.0};
  return motion_of(graph, v, here).col(2);
}

Components describe_components(const Graph& graph) {
  const std::vector<std::int32_t> root = find_components(graph);
  const std::vector<char> has_edge = vertices_with_edges(graph);
  Components result;
  result.of.assign(graph.vertex_count(), -1);
  result.next.assign(graph.vertex_count(), -1);
  std::vector<std::int32_t> number(graph.vertex_count(), -1);  // of the component with that root
  std::vector<VertexIndex> last;
  std::vector<Eigen::AlignedBox2d> boxes;
  for (std::size_t v = 0; v < graph.vertex_count(); ++v) {
    const auto vertex = static_cast<VertexIndex>(v);
    if (!has_edge[v] || graph.fixed(vertex)) continue;
    const VertexType& type = graph.vertex_type(vertex);
    if (type.rigid_motion == nullptr) continue;
    std::int32_t& component = number[at(root[v])];
    if (component < 0) {
      component = static_cast<std::int32_t>(result.first.size());
      result.first.push_back(vertex);
      result.pose.push_back(-1);
      result.count.push_back(0);
      result.stamped.push_back(0);
      boxes.emplace_back();
      last.push_back(vertex);
    } else {
      result.next[at(last[at(component)])] = vertex;
      last[at(component)] = vertex;
    }
    result.of[v] = component;
    ++result.count[at(component)];
    if (graph.stamp(vertex)) result.stamped[at(component)] = 1;
    boxes[at(component)].extend(type.position(graph.value(vertex).data()));
    if (result.pose[at(component)] < 0 && !own_turn(graph, vertex).isZero(0))
      result.pose[at(component)] = vertex;
  }
  // The extent is at least a metre. In a smaller component a turn would only turn its poses.
  for (const Eigen::AlignedBox2d& box : boxes) {
    result.places.push_back({box.center(), std::max(1.0, 0.5 * box.diagonal().norm())});
  }
  return result;
}

}  // namespace waymark::detail
