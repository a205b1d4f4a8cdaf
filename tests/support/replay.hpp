/// Replays a graph as a running system builds it: vertex by vertex, each with the edges that
/// it completes.
#pragma once

#include <algorithm>
#include <vector>

#include <waymark/core/graph/graph.hpp>
#include <waymark/types_se2/se2.hpp>

namespace waymark_test {

class Replay {
 public:
  /// @param order all vertices of the source, in the order of their arrival
  Replay(const waymark::Graph& source, std::vector<waymark::VertexIndex> order)
      : source_(source), order_(std::move(order)), due_(order_.size()) {
    std::vector<std::size_t> place(order_.size());
    for (std::size_t k = 0; k < order_.size(); ++k) place[static_cast<std::size_t>(order_[k])] = k;
    for (std::size_t b = 0; b < source.batch_count(); ++b) {
      for (std::size_t e = 0; e < source.batch(b).size(); ++e) {
        std::size_t last = 0;
        for (const waymark::VertexIndex v : source.batch(b).vertices(e))
          last = std::max(last, place[static_cast<std::size_t>(v)]);
        due_[last].push_back({b, e});
      }
    }
  }

  [[nodiscard]] bool done() const { return next_ == order_.size(); }

  /// Appends the next vertex and its edges. The initial guess of a pose is dead reckoning: the last
  /// pose of the target, moved by the difference of their values in the source.
  /// @return its index in the target
  waymark::VertexIndex append_to(waymark::Graph& target) {
    using namespace waymark;
    const VertexIndex v = order_[next_];
    std::vector<double> value(source_.value(v).begin(), source_.value(v).end());
    if (last_pose_ >= 0 && moves(v)) {
      const Pose2<double> last = pose(target, *target.find(source_.id(last_pose_)));
      const Pose2<double> start = compose(last, between(pose(source_, last_pose_), pose(source_, v)));
      value = {start.position[0], start.position[1], wrap_angle(start.heading)};
    }
    const VertexIndex added = target.add_vertex(source_.vertex_type(v), source_.id(v), value);
    target.set_fixed(added, source_.fixed(v));
    for (const auto& [b, e] : due_[next_]) {
      std::vector<VertexIndex> vertices;
      for (const VertexIndex u : source_.batch(b).vertices(e))
        vertices.push_back(*target.find(source_.id(u)));
      std::vector<double> fields;
      source_.batch(b).fields(e, fields);
      target.add_edge(source_.edge_type(b), vertices, fields, source_.batch(b).information(e));
    }
    if (moves(v)) last_pose_ = v;
    ++next_;
    return added;
  }

 private:
  struct Place {
    std::size_t batch;
    std::size_t edge;
  };

  [[nodiscard]] bool moves(waymark::VertexIndex v) const {
    return source_.vertex_type(v).tag == "VERTEX_SE2" && !source_.fixed(v);
  }
  static waymark::Pose2<double> pose(const waymark::Graph& graph, waymark::VertexIndex v) {
    const auto value = graph.value(v);
    return {value[0], value[1], value[2]};
  }

  const waymark::Graph& source_;
  std::vector<waymark::VertexIndex> order_;
  std::vector<std::vector<Place>> due_;
  std::size_t next_ = 0;
  waymark::VertexIndex last_pose_ = -1;
};

}  // namespace waymark_test
