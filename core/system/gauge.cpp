#include <algorithm>

#include <waymark/core/base/detail/index.hpp>
#include <waymark/core/base/error.hpp>
#include <waymark/core/system/detail/incidence.hpp>
#include <waymark/core/system/detail/information_unit.hpp>
#include <waymark/core/system/detail/seen_motions.hpp>
#include <waymark/core/system/foreign_poses.hpp>
#include <waymark/core/system/gauge.hpp>
#include <waymark/core/system/held_marks.hpp>

namespace waymark {
namespace {

using namespace detail;

/// One component, as the gauge judges it.
struct Judged {
  VertexIndex first = -1;
  VertexIndex holds = -1;  ///< what would be held
  bool has_pose = false;   ///< among its vertices
  int count = 0;           ///< vertices
  int motions = 3;         ///< rigid ones that change it
  int rank = 0;            ///< of those that the edges observe
  Eigen::MatrixXd unseen;  ///< the others, if the rank is neither 0 nor full: 3 x (3 - rank)
  /// the present places are special: elsewhere the edges observe more
  bool is_special = false;

  [[nodiscard]] bool is_anchored() const { return rank >= motions; }
  /// Tells whether it still turns with a vertex held: all are points.
  [[nodiscard]] bool would_turn() const { return motions == 3 && !has_pose && rank == 0; }
};

Judged judge(const Graph& graph, const Components& components, std::size_t c,
             const Eigen::Matrix3d& information, double unit) {
  Judged judged;
  judged.first = components.first[c];
  judged.has_pose = components.pose[c] >= 0;
  judged.holds = judged.has_pose ? components.pose[c] : judged.first;
  judged.count = components.count[c];
  if (!judged.has_pose && judged.count == 1) judged.motions = 2;
  judged.rank = rank_of(information, unit);
  if (judged.rank == 0 || judged.is_anchored()) return judged;
  const auto component = static_cast<std::int32_t>(c);
  const Eigen::Matrix3d seen = seen_directions(graph, components, component);
  judged.rank = rank_of(seen, 1);
  if (judged.is_anchored()) return judged;
  judged.unseen = unseen_motions(seen, 1);
  judged.is_special = rank_of(seen_elsewhere(graph, components, component), 1) > judged.rank;
  return judged;
}

std::string anchored_in_part(const Graph& graph, const Judged& judged) {
  return "vertex " + to_string(graph.id(judged.first)) +
         " and the vertices joined to it are anchored in only " + std::to_string(judged.rank) + " of " +
         std::to_string(judged.motions) + " rigid motions";
}

/// Holds the first vertex of each part of poses that are not of the plane, if only edges between vertices
/// join them: nothing else can be known about their gauge.
void hold_foreign_poses(const Graph& graph, Gauge& gauge) {
  if (find_joined_foreign_pose(graph) < 0) return;
  const std::vector<std::int32_t> root = find_components(graph);
  const std::vector<char> has_edge = vertices_with_edges(graph);
  std::vector<char> anchored(graph.vertex_count(),
                             0);  // by root: by a fixed vertex, or an edge on one vertex
  for (std::size_t b = 0; b < graph.batch_count(); ++b) {
    for_each_edge(graph.batch(b), [&](std::span<const VertexIndex> vertices) {
      const bool has_fixed =
          std::any_of(vertices.begin(), vertices.end(), [&](VertexIndex v) { return graph.fixed(v); });
      if (vertices.size() > 1 && !has_fixed) return;
      for (const VertexIndex v : vertices) anchored[at(root[at(v)])] = 1;
    });
  }
  for (std::size_t v = 0; v < graph.vertex_count(); ++v) {
    const auto vertex = static_cast<VertexIndex>(v);
    if (graph.fixed(vertex) || has_edge[v] == 0 || !is_foreign_pose(graph.vertex_type(vertex))) continue;
    char& is_anchored = anchored[at(root[v])];
    if (is_anchored == 0) {
      gauge.held[v] = 1;
      gauge.messages.push_back(graph.vertex_type(vertex).tag + " " + to_string(graph.id(vertex)) +
                               " is held at its present value: only edges between vertices are there");
    }
    is_anchored = 1;
  }
}

/// Returns the coordinates of a vertex whose keeping stops the unseen motions; 0 if there are none. A heading is
/// preferred: any turn changes it, and a place on a circle is no sure hold.
char coordinates_that_stop(const Graph& graph, const RigidMotionView::Place& place, const Judged& judged,
                           VertexIndex v) {
  constexpr double kPreference = 10;
  constexpr double kStops = 1e-3;
  const Eigen::VectorXd turn = own_turn(graph, v);
  Eigen::MatrixXd moved = motion_of(graph, v, place) * judged.unseen;  // metres and radians
  for (Eigen::Index row = 0; row < moved.rows(); ++row)
    if (turn[row] != 0) moved.row(row) *= kPreference * place.extent;
  char marks = 0;
  for (int held = 0; held < judged.motions - judged.rank; ++held) {
    Eigen::Index row = 0;
    if (!(moved.rowwise().norm().maxCoeff(&row) > kStops) || row >= kMarkedCoordinates) return 0;
    marks |= mark_of_coordinate(static_cast<int>(row));
    const Eigen::RowVectorXd stopped = moved.row(row).normalized();
    moved -= moved * stopped.transpose() * stopped;
  }
  return marks;
}

std::string words_for_coordinates(const Graph& graph, const Judged& judged, VertexIndex v, char marks) {
  const VertexType& type = graph.vertex_type(v);
  std::string names;
  int count = 0;
  for (int k = 0; k < type.tangent_size && k < kMarkedCoordinates; ++k) {
    if (!holds_coordinate(marks, k)) continue;
    names += count++ == 0 ? "" : " and ";
    names += type.value_size == type.tangent_size ? type.value_names[at(k)]
                                                  : "coordinate " + std::to_string(k) + " of the tangent";
  }
  return anchored_in_part(graph, judged) + " (typical: a single GNSS fix): " + names + " of vertex " +
         to_string(graph.id(v)) +
         (count == 1 ? " is held at its present value" : " are held at their present values");
}

/// Tells whether a component is a drive, whose heading is a result and no convention.
bool has_stamps(const Graph& graph, const Components& components, std::size_t c) {
  for (VertexIndex v = 0; v < static_cast<VertexIndex>(graph.vertex_count()); ++v)
    if (components.of[at(v)] == static_cast<std::int32_t>(c) && graph.stamp(v)) return true;
  return false;
}

/// Holds as many coordinates of one vertex as there are unseen motions.
/// @return false where no vertex has them
bool hold_coordinates(const Graph& graph, const Components& components, std::size_t c, const Judged& judged,
                      Gauge& gauge) {
  for (VertexIndex v = judged.holds; v < static_cast<VertexIndex>(graph.vertex_count()); ++v) {
    if (components.of[at(v)] != static_cast<std::int32_t>(c)) continue;
    const char marks = coordinates_that_stop(graph, components.places[c], judged, v);
    if (marks == 0) continue;
    gauge.held[at(v)] = marks;
    gauge.messages.push_back(words_for_coordinates(graph, judged, v, marks));
    return true;
  }
  return false;
}

/// @throws InputError for one whose solution is not determined whatever is held
[[noreturn]] void refuse(const Graph& graph, const Judged& judged) {
  if (judged.rank > 0)
    throw InputError(
        anchored_in_part(graph, judged) +
        ", so the solution is not determined (typical: a drive with a single fix or fixes at one place, a point seen in one "
        "direction); add fixes at another place or a heading, or FIX one vertex");
  throw InputError("nothing anchors vertex " + to_string(graph.id(judged.first)) + " and the " +
                   std::to_string(judged.count - 1) +
                   " vertices joined to it, which are all points: with one of them FIXed they still turn "
                   "about it; FIX two, or add measurements of where they are");
}

std::string words_for_vertex(const Graph& graph, const Judged& judged) {
  if (judged.rank > 0)
    return anchored_in_part(graph, judged) + ": it is held at its present value until more is measured";
  return "nothing anchors vertex " + to_string(graph.id(judged.holds)) + " and the " +
         std::to_string(judged.count - 1) + " vertices joined to it: it is held at its present value";
}

}  // namespace

Gauge find_gauge(const Graph& graph, PartlyAnchored partly) {
  const Components components = describe_components(graph);
  std::vector<Eigen::Matrix3d> information(components.first.size(), Eigen::Matrix3d::Zero());
  const RigidMotionView motion{components.of.data(), components.places.data(), information.data()};
  for (std::size_t b = 0; b < graph.batch_count(); ++b) {
    graph.batch(b).add_rigid_information(graph.view(), motion);
  }
  Gauge gauge;
  gauge.held.assign(graph.vertex_count(), 0);
  const double unit = information_unit(graph);
  for (std::size_t c = 0; c < components.first.size(); ++c) {
    const Judged judged = judge(graph, components, c, information[c], unit);
    if (judged.is_anchored()) continue;
    if (judged.rank > 0) gauge.partly.push_back({judged.holds, components.places[c], judged.unseen});
    if (partly == PartlyAnchored::hold_coordinates) {
      // Only motions that stay unseen wherever the vertices go are no part of the solution.
      const bool is_gauge = judged.motions == 3 && !judged.is_special && !has_stamps(graph, components, c);
      if (judged.rank > 0 && is_gauge && hold_coordinates(graph, components, c, judged, gauge)) continue;
      if (judged.rank > 0 || judged.would_turn()) refuse(graph, judged);
    }
    gauge.held[at(judged.holds)] = kWhollyHeld;
    gauge.messages.push_back(words_for_vertex(graph, judged));
  }
  hold_foreign_poses(graph, gauge);
  return gauge;
}

}  // namespace waymark
