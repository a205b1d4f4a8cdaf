#include <algorithm>
#include <queue>
#include <tuple>

#include <waymark/core/system/foreign_poses.hpp>
#include <waymark/types_se2/se2.hpp>
#include <waymark/types_se2/start/detail/bodies.hpp>
#include <waymark/types_se2/start/detail/points.hpp>
#include <waymark/types_se2/start/detail/relations.hpp>
#include <waymark/types_se2/start/detail/starts.hpp>

namespace waymark {
namespace {

std::size_t at(VertexIndex v) {
  return static_cast<std::size_t>(v);
}

/// A motion as seen from one of its ends.
struct Branch {
  VertexIndex to = -1;
  Pose2<double> motion;
  double heading_variance = 0;
};

/// Grows poses over a graph. Each pose is placed once, from one that already has its place.
class Tree {
 public:
  explicit Tree(const Graph& graph)
      : graph_(graph),
        values_(graph.values()),
        branches_(graph.vertex_count()),
        placed_(graph.vertex_count()),
        bodies_(graph.vertex_count(), kNoBody) {
    for (const Relation& relation : planar_relations(graph)) {
      if (relation.from == Relation::kWorld || !relation.is_motion()) continue;
      const Pose2<double> motion(relation.translation, relation.turn);
      const double variance = 1 / relation.heading_weight;
      branches_[at(relation.from)].push_back({relation.to, motion, variance});
      branches_[at(relation.to)].push_back({relation.from, inverse(motion), variance});
    }
  }

  [[nodiscard]] const std::vector<Branch>& branches(VertexIndex v) const { return branches_[at(v)]; }
  [[nodiscard]] bool placed(VertexIndex v) const { return placed_[at(v)] != 0; }
  [[nodiscard]] VertexIndex vertex_count() const { return static_cast<VertexIndex>(placed_.size()); }

  /// Returns the vertices at which a part may begin: fixed ones first, then in order of insertion.
  [[nodiscard]] std::vector<VertexIndex> roots() const {
    std::vector<VertexIndex> roots;
    for (const bool fixed : {true, false}) {
      for (VertexIndex v = 0; v < vertex_count(); ++v) {
        if (!branches(v).empty() && graph_.fixed(v) == fixed) roots.push_back(v);
      }
    }
    return roots;
  }

  /// Begins a part of the graph. The vertex keeps its value.
  void begin_at(VertexIndex root) {
    placed_[at(root)] = 1;
    if (first_root_ < 0) first_root_ = root;
    bodies_[at(root)] = graph_.fixed(root) ? kWorldBody : ++last_body_;
  }

  void grow(VertexIndex from, const Branch& branch) {
    placed_[at(branch.to)] = 1;
    bodies_[at(branch.to)] = bodies_[at(from)];
    if (graph_.fixed(branch.to)) return;
    const double* base = value(from);
    const Pose2<double> pose = compose(Pose2<double>(base[0], base[1], base[2]), branch.motion);
    double* moved = value(branch.to);
    moved[0] = pose.position[0];
    moved[1] = pose.position[1];
    moved[2] = wrap_angle(pose.heading);
  }

  /// Moves the parts to where the points that they share are, and places the points that placed poses saw.
  /// @return the number of poses moved, without the first part
  std::size_t place_points() {
    const std::vector<Sighting> sightings = planar_sightings(graph_);
    std::size_t joined = 0;
    if (has_several(graph_, bodies_)) {
      const std::vector<char> moved = join_bodies(graph_, sightings, bodies_, values_);
      for (std::size_t v = 0; v < moved.size(); ++v)
        joined += moved[v] != 0 && bodies_[v] != bodies_[at(first_root_)] ? 1 : 0;
    }
    waymark::place_points(graph_, sightings, placed_, values_);
    return joined;
  }

  /// Counts the free poses that can be placed and are not placed yet.
  [[nodiscard]] std::size_t waiting() const {
    std::size_t count = 0;
    for (VertexIndex v = 0; v < vertex_count(); ++v) {
      count += !placed(v) && !branches(v).empty() && !graph_.fixed(v) ? 1 : 0;
    }
    return count;
  }

  std::vector<double> take_values() { return std::move(values_); }

 private:
  [[nodiscard]] double* value(VertexIndex v) { return values_.data() + graph_.offsets()[at(v)]; }

  const Graph& graph_;
  std::vector<double> values_;
  std::vector<std::vector<Branch>> branches_;
  std::vector<char> placed_;
  std::vector<int> bodies_;  // the parts, by number
  int last_body_ = kWorldBody;
  VertexIndex first_root_ = -1;
};

/// Places poses along consecutive vertices, both ways from the root, and then along the
/// fewest edges.
void spread_along_chain(Tree& tree, VertexIndex root) {
  std::vector<VertexIndex> queue{root};
  for (const VertexIndex direction : {1, -1}) {
    bool on = true;
    for (VertexIndex v = root; on; v += direction) {
      const auto& branches = tree.branches(v);
      const auto next = std::find_if(branches.begin(), branches.end(), [&](const Branch& branch) {
        return branch.to == v + direction && !tree.placed(branch.to);
      });
      on = next != branches.end();
      if (!on) break;
      tree.grow(v, *next);
      queue.push_back(next->to);
    }
  }
  for (std::size_t next = 0; next < queue.size(); ++next) {
    const VertexIndex from = queue[next];
    for (const Branch& branch : tree.branches(from)) {
      if (tree.placed(branch.to)) continue;
      tree.grow(from, branch);
      queue.push_back(branch.to);
    }
  }
}

/// Places poses along Dijkstra's tree of the least heading variance from the root.
void spread_by_heading(Tree& tree, VertexIndex root) {
  struct Reach {
    double variance;
    std::size_t number;  // order of discovery: decides between equal variances
    VertexIndex from;
    const Branch* branch;
  };
  const auto later = [](const Reach& a, const Reach& b) {
    return std::tie(a.variance, a.number) > std::tie(b.variance, b.number);
  };
  std::priority_queue<Reach, std::vector<Reach>, decltype(later)> open(later);
  std::size_t number = 0;
  const auto discover = [&](VertexIndex from, double variance) {
    for (const Branch& branch : tree.branches(from)) {
      if (!tree.placed(branch.to)) open.push({variance + branch.heading_variance, number++, from, &branch});
    }
  };
  discover(root, 0);
  while (!open.empty()) {
    const Reach reach = open.top();
    open.pop();
    if (tree.placed(reach.branch->to)) continue;
    tree.grow(reach.from, *reach.branch);
    discover(reach.branch->to, reach.variance);
  }
}

InitialValues grow_tree(const Graph& graph, void (*spread)(Tree&, VertexIndex)) {
  InitialValues start;
  if (const VertexIndex foreign = find_joined_foreign_pose(graph); foreign >= 0) {
    start.note = foreign_note(graph, foreign);
    return start;
  }
  Tree tree(graph);
  bool first = true;
  for (const VertexIndex root : tree.roots()) {
    if (tree.placed(root)) continue;
    tree.begin_at(root);
    spread(tree, root);
    if (first) start.apart = tree.waiting();
    first = false;
  }
  if (first) {
    start.note = "no edge gives the motion from one pose to another";
    return start;
  }
  start.apart -= tree.place_points();
  start.values = tree.take_values();
  return start;
}

}  // namespace

StartType odometry_start() {
  return {"odometry", "relative edges chained along consecutive vertices",
          [](const Graph& graph) { return grow_tree(graph, spread_along_chain); }};
}

StartType spanning_tree_start() {
  return {"spanning_tree", "relative edges chained along the tree of least heading variance",
          [](const Graph& graph) { return grow_tree(graph, spread_by_heading); }};
}

}  // namespace waymark
