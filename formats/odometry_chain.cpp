#include <cmath>
#include <vector>

#include <waymark/formats/graph_document.hpp>

namespace waymark {
namespace {

struct Motion {
  VertexIndex to;
  double x, y, heading;
};

Motion inverse(const Motion& m, VertexIndex to) {
  const double c = std::cos(m.heading);
  const double s = std::sin(m.heading);
  return {to, -c * m.x - s * m.y, s * m.x - c * m.y, -m.heading};
}

void place(Graph& graph, VertexIndex from, const Motion& motion) {
  const auto pose = graph.value(from);
  const double c = std::cos(pose[2]);
  const double s = std::sin(pose[2]);
  const double value[3] = {pose[0] + c * motion.x - s * motion.y, pose[1] + s * motion.x + c * motion.y,
                           std::remainder(pose[2] + motion.heading, 2 * 3.14159265358979323846)};
  graph.set_value(motion.to, value);
}

}  // namespace

std::size_t start_from_odometry_chain(Graph& graph) {
  std::vector<std::vector<Motion>> motions(graph.vertex_count());
  for (std::size_t b = 0; b < graph.batch_count(); ++b) {
    const std::string& tag = graph.edge_type(b).tag;
    if (tag != "EDGE_SE2" && tag != "EDGE_SE2_LOG") continue;
    const EdgeBatchBase& batch = graph.batch(b);
    std::vector<double> fields;
    for (std::size_t e = 0; e < batch.size(); ++e) {
      fields.clear();
      batch.fields(e, fields);
      const auto v = batch.vertices(e);
      const Motion forward{v[1], fields[0], fields[1], fields[2]};
      motions[static_cast<std::size_t>(v[0])].push_back(forward);
      motions[static_cast<std::size_t>(v[1])].push_back(inverse(forward, v[0]));
    }
  }
  std::vector<char> placed(graph.vertex_count(), 0);
  std::vector<VertexIndex> queue;
  const auto reach = [&](VertexIndex from, const Motion& motion) {
    if (!graph.fixed(motion.to)) place(graph, from, motion);
    placed[static_cast<std::size_t>(motion.to)] = 1;
    queue.push_back(motion.to);
  };
  std::size_t first = 0;
  while (first < motions.size() && motions[first].empty()) ++first;
  if (first == motions.size()) return motions.size();
  placed[first] = 1;
  queue.push_back(static_cast<VertexIndex>(first));
  // The chain first: the edge from one vertex to the next.
  for (std::size_t v = first; v + 1 < graph.vertex_count() && placed[v]; ++v) {
    for (const Motion& motion : motions[v]) {
      if (static_cast<std::size_t>(motion.to) != v + 1 || placed[v + 1]) continue;
      reach(static_cast<VertexIndex>(v), motion);
    }
  }
  for (std::size_t next = 0; next < queue.size(); ++next) {
    const VertexIndex from = queue[next];
    for (const Motion& motion : motions[static_cast<std::size_t>(from)]) {
      if (!placed[static_cast<std::size_t>(motion.to)]) reach(from, motion);
    }
  }
  return graph.vertex_count() - queue.size();
}

}  // namespace waymark
