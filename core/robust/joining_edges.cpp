#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include <waymark/core/base/detail/disjoint_sets.hpp>
#include <waymark/core/base/detail/index.hpp>
#include <waymark/core/robust/detail/free_motions.hpp>
#include <waymark/core/robust/detail/moved_errors.hpp>
#include <waymark/core/robust/edge_selection.hpp>
#include <waymark/core/robust/joining_edges.hpp>
#include <waymark/core/system/detail/components.hpp>
#include <waymark/core/system/detail/finite_motion.hpp>
#include <waymark/core/system/detail/incidence.hpp>
#include <waymark/core/system/gauge.hpp>
#include <waymark/core/system/held_marks.hpp>

namespace waymark {
namespace {

using detail::at;
using detail::FiniteMotion;
using detail::FreeMotions;

/// Returns a place and an extent that hold all the others.
RigidMotionView::Place frame_of(const std::vector<PartlyFree>& parts) {
  RigidMotionView::Place frame;
  if (parts.empty()) return frame;
  frame.centre = parts[0].place.centre;
  for (const PartlyFree& part : parts)
    frame.extent = std::max({frame.extent, part.place.extent, (part.place.centre - frame.centre).norm()});
  return frame;
}

/// The parts of a graph that its edges join, and that further edges would join.
class Parts {
 public:
  /// What an edge would join: one part is moved to another one.
  struct Join {
    std::int32_t moved = -1;
    std::int32_t other = -1;

    friend bool operator==(const Join&, const Join&) = default;
  };

  explicit Parts(const Graph& graph)
      : fixed_(static_cast<std::int32_t>(graph.vertex_count())),
        sets_(graph.vertex_count() + 1),
        motions_(graph.vertex_count() + 1),
        members_(graph.vertex_count() + 1) {
    const std::vector<std::int32_t> component = detail::find_components(graph);
    const Gauge gauge = find_gauge(graph, PartlyAnchored::hold_vertex);
    const std::vector<char> has_edge = vertices_with_edges(graph);
    for (VertexIndex v = 0; v < fixed_; ++v) {
      const std::int32_t part = sets_.join(v, graph.fixed(v) ? fixed_ : component[at(v)]);
      if (graph.fixed(v)) continue;
      members_[at(part)].push_back(v);
      if (has_edge[at(v)] == 0)
        motions_[at(part)] = FreeMotions::all(graph.vertex_type(v).tangent_size);
      else if (is_wholly_held(gauge.held[at(v)]))
        motions_[at(part)] = FreeMotions::all(kOfPoses);
    }
    const RigidMotionView::Place frame = frame_of(gauge.partly);
    for (const PartlyFree& part : gauge.partly)
      motions_[at(sets_.of(part.vertex))] = FreeMotions::some(part.motions, part.place, frame);
  }

  /// Returns the parts of two vertices, if one of them may be moved so that an error becomes zero.
  /// @param dimension of the error
  std::optional<Join> join_by(std::span<const VertexIndex> vertices, int dimension) {
    if (vertices.size() != 2) return std::nullopt;
    Join join{sets_.of(vertices[0]), sets_.of(vertices[1])};
    if (join.moved == join.other) return std::nullopt;
    const int one = motions_[at(join.moved)].unanchored();
    const int other = motions_[at(join.other)].unanchored();
    // The one that is moved loses its motions. 0: it is anchored, or in part.
    const bool is_second = one == other ? join.moved < join.other : one == 0 || (other != 0 && other < one);
    if (is_second) std::swap(join.moved, join.other);
    const FreeMotions& of_moved = motions_[at(join.moved)];
    if (of_moved.unanchored() > 0)
      return dimension < of_moved.unanchored() ? std::nullopt : std::optional(join);
    const bool is_free = dimension >= kOfPoses && of_moved.make_all_with(motions_[at(join.other)]);
    return is_free ? std::optional(join) : std::nullopt;
  }

  void make_one(const Join& join) {
    const FreeMotions& of_moved = motions_[at(join.moved)];
    const FreeMotions left =
        of_moved.unanchored() > 0 ? motions_[at(join.other)] : of_moved.shared_with(motions_[at(join.other)]);
    std::vector<VertexIndex> more = std::move(members_[at(join.moved)]);
    std::vector<VertexIndex>& all = members_[at(join.other)];
    if (all.size() < more.size()) all.swap(more);
    all.insert(all.end(), more.begin(), more.end());
    std::vector<VertexIndex> members = std::move(all);
    const std::int32_t name = sets_.join(join.moved, join.other);
    members_[at(name)] = std::move(members);
    motions_[at(name)] = left;
  }

  [[nodiscard]] bool holds(std::int32_t part, VertexIndex v) { return sets_.of(v) == part; }
  [[nodiscard]] const std::vector<VertexIndex>& members(std::int32_t part) const {
    return members_[at(part)];
  }
  /// Returns the vertices of one of the parts, the smaller one unless the other has fixed vertices.
  [[nodiscard]] const std::vector<VertexIndex>& fewer_members(const Join& join) {
    const bool is_moved =
        sets_.of(fixed_) == join.other || members(join.moved).size() <= members(join.other).size();
    return members(is_moved ? join.moved : join.other);
  }

 private:
  static constexpr int kOfPoses = 3;

  std::int32_t fixed_;  // stands for all fixed vertices
  detail::DisjointSets sets_;
  std::vector<FreeMotions> motions_;               // of each part, by its name
  std::vector<std::vector<VertexIndex>> members_;  // the same; fixed vertices are not named
};

/// Edges that would join the same two parts.
class Rivals {
 public:
  /// @param trial with the values of the parts
  Rivals(const Graph& graph, Graph& trial, Parts& parts, const Parts::Join& join)
      : graph_(graph), trial_(trial), parts_(parts), join_(join) {}

  void add(EdgePlace place) { edges_.push_back(place); }
  /// Returns the edge that the others contradict least, and how it moves the part.
  [[nodiscard]] std::pair<EdgePlace, std::optional<FiniteMotion>> best() {
    constexpr std::size_t kProposals = 50;
    constexpr double kNoise = 3;  // standard deviations of each other edge
    const double noise = kNoise * static_cast<double>(edges_.size() - 1);
    const std::size_t stride = (edges_.size() + kProposals - 1) / kProposals;
    std::size_t best = 0;
    double least = misfit(0);
    for (std::size_t i = stride; i < edges_.size() && least > noise; i += stride) {
      const double sum = misfit(i);
      if (!(sum < least)) continue;
      best = i;
      least = sum;
    }
    return {edges_[best], motion_by(edges_[best])};
  }

 private:
  [[nodiscard]] std::optional<FiniteMotion> motion_by(EdgePlace place) {
    const std::vector<VertexIndex> moved = moved_of(place);
    return detail::motion_to_agree(graph_.batch(place.batch), place.edge, trial_, moved);
  }

  [[nodiscard]] std::vector<VertexIndex> moved_of(EdgePlace place) {
    std::vector<VertexIndex> moved;
    for (const VertexIndex v : graph_.batch(place.batch).vertices(place.edge))
      if (parts_.holds(join_.moved, v)) moved.push_back(v);
    return moved;
  }

  /// Returns the sum of the errors, in standard deviations, if an edge decides: false ones in the minority
  /// add the same to all others.
  [[nodiscard]] double misfit(std::size_t decides) {
    const std::optional<FiniteMotion> motion = motion_by(edges_[decides]);
    if (!motion) return std::numeric_limits<double>::infinity();
    double sum = 0;
    for (const EdgePlace place : edges_) {
      const double squared = detail::squared_error_after(graph_.batch(place.batch), place.edge, trial_,
                                                         moved_of(place), *motion);
      sum += std::sqrt(std::max(0.0, squared));
    }
    return std::isfinite(sum) ? sum : std::numeric_limits<double>::infinity();
  }

  const Graph& graph_;
  Graph& trial_;
  Parts& parts_;
  const Parts::Join join_;
  std::vector<EdgePlace> edges_;
};

std::vector<std::vector<std::size_t>> edges_by_vertex(const Graph& graph, std::span<const EdgePlace> edges) {
  std::vector<std::vector<std::size_t>> result(graph.vertex_count());
  for (std::size_t i = 0; i < edges.size(); ++i)
    for (const VertexIndex v : graph.batch(edges[i].batch).vertices(edges[i].edge))
      result[at(v)].push_back(i);
  return result;
}

}  // namespace

std::vector<EdgePlace> joining_edges(const Graph& graph, std::span<const EdgePlace> edges,
                                     const Graph& kept) {
  Parts parts(kept);
  std::optional<Graph> trial;
  const auto join_by = [&](EdgePlace place) {
    const EdgeBatchBase& batch = graph.batch(place.batch);
    return parts.join_by(batch.vertices(place.edge), batch.error_dimension(place.edge));
  };
  std::vector<EdgePlace> result;
  std::vector<std::vector<std::size_t>> edges_of;  // of each vertex
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const std::optional<Parts::Join> join = join_by(edges[i]);
    if (!join) continue;
    if (!trial) {
      trial = kept;
      edges_of = edges_by_vertex(graph, edges);
    }
    std::vector<std::size_t> rival;
    for (const VertexIndex v : parts.fewer_members(*join))
      for (const std::size_t k : edges_of[at(v)])
        if (join_by(edges[k]) == join) rival.push_back(k);
    std::sort(rival.begin(), rival.end());
    Rivals rivals(graph, *trial, parts, *join);
    for (const std::size_t k : rival) rivals.add(edges[k]);
    const auto [best, motion] = rivals.best();
    if (motion)
      for (const VertexIndex v : parts.members(join->moved)) detail::move(*trial, v, *motion);
    parts.make_one(*join);
    result.push_back(best);
  }
  return result;
}

}  // namespace waymark
