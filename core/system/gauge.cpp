#include <algorithm>
#include <cmath>
#include <numeric>

#include <Eigen/Geometry>

#include <waymark/core/base/detail/index.hpp>
#include <waymark/core/base/error.hpp>
#include <waymark/core/linear/dense_decompositions.hpp>
#include <waymark/core/linear/detail/information_root.hpp>
#include <waymark/core/system/detail/incidence.hpp>
#include <waymark/core/system/detail/information_unit.hpp>
#include <waymark/core/system/foreign_poses.hpp>
#include <waymark/core/system/gauge.hpp>

namespace waymark {
namespace {

using detail::at;

/// Finds components of free vertices by union-find with path halving. The root is the first
/// vertex of each.
std::vector<std::int32_t> find_components(const Graph& graph) {
  std::vector<std::int32_t> parent(graph.vertex_count());
  std::iota(parent.begin(), parent.end(), 0);
  const auto root = [&](std::int32_t v) {
    while (parent[at(v)] != v) v = parent[at(v)] = parent[at(parent[at(v)])];
    return v;
  };
  for (std::size_t b = 0; b < graph.batch_count(); ++b) {
    for_each_edge(graph.batch(b), [&](std::span<const VertexIndex> vertices) {
      std::int32_t joined = -1;
      for (const VertexIndex v : vertices) {
        if (graph.fixed(v)) continue;
        const std::int32_t r = root(v);
        if (joined >= 0 && r != joined) {
          parent[at(std::max(r, joined))] = std::min(r, joined);
          joined = std::min(r, joined);
        } else {
          joined = r;
        }
      }
    });
  }
  for (std::size_t v = 0; v < parent.size(); ++v) parent[v] = root(static_cast<std::int32_t>(v));
  return parent;
}

/// Returns how a rigid motion about a centre moves a vertex: its tangent by x, y and the turn (at the extent).
Eigen::MatrixXd motion_of(const Graph& graph, VertexIndex v, const RigidMotionView::Place& place) {
  const VertexType& type = graph.vertex_type(v);
  Eigen::MatrixXd motion(type.tangent_size, 3);
  type.rigid_motion(graph.value(v).data(), place.centre, place.extent, motion.data());
  return motion;
}

/// Tells whether a turn about the place of a vertex changes it: a pose, but no point.
bool turns_about_itself(const Graph& graph, VertexIndex v) {
  const RigidMotionView::Place here{graph.vertex_type(v).position(graph.value(v).data()), 1.0};
  return !motion_of(graph, v, here).col(2).isZero(0);
}

/// The components of the vertices that a rigid motion moves.
struct Components {
  std::vector<std::int32_t> of;    // per vertex; -1: the vertex is fixed or does not move
  std::vector<VertexIndex> first;  // first vertex with edges
  std::vector<VertexIndex> pose;   // first vertex that a turn about itself changes; -1: all are points
  std::vector<int> count;          // vertices that move
  std::vector<RigidMotionView::Place> places;
};

Components describe_components(const Graph& graph) {
  const std::vector<std::int32_t> root = find_components(graph);
  const std::vector<char> has_edge = vertices_with_edges(graph);
  Components result;
  result.of.assign(graph.vertex_count(), -1);
  std::vector<std::int32_t> number(graph.vertex_count(), -1);  // of the component with that root
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
      boxes.emplace_back();
    }
    result.of[v] = component;
    ++result.count[at(component)];
    boxes[at(component)].extend(type.position(graph.value(vertex).data()));
    if (result.pose[at(component)] < 0 && turns_about_itself(graph, vertex))
      result.pose[at(component)] = vertex;
  }
  // The extent is at least a metre. In a smaller component a turn would only turn its poses.
  for (const Eigen::AlignedBox2d& box : boxes) {
    result.places.push_back({box.center(), std::max(1.0, 0.5 * box.diagonal().norm())});
  }
  return result;
}

/// Returns how many eigenvalues are above the noise of the largest. 0 if all of them are
/// only rounding.
/// @param unit of the information of the graph
int rank_of(const Eigen::Matrix3d& information, double unit) {
  if (!information.allFinite()) return 3;  // whoever uses the graph finds the edge that is not finite
  const Eigen::Vector3d eigenvalues = symmetric_eigenvalues(information);
  constexpr double kRounding =
      1e-12;  // (J T) of a component without anchor cancels to about 1e-12, squared times Omega
  constexpr double kRelative = 1e-12;
  int rank = 0;
  for (const double value : eigenvalues)
    rank += value > std::max(kRounding * unit, kRelative * eigenvalues[2]);
  return rank;
}

/// A part of a motion that is smaller than this, beside the terms that it is the sum of, is rounding.
constexpr double kNoMotion = 1e-6;

/// Returns the rows of J T that an edge knows something about, and 0 for those that cancel.
/// @param moved J T, one row per error; @param terms the sum of the sizes of the products in it
Eigen::MatrixXd known_rows(const Eigen::MatrixXd& information, Eigen::MatrixXd moved,
                           const Eigen::MatrixXd& terms) {
  for (Eigen::Index row = 0; row < moved.rows(); ++row) {
    if (!(information(row, row) > 0)) moved.row(row).setZero();
    for (Eigen::Index c = 0; c < 3; ++c)
      if (!(std::abs(moved(row, c)) > kNoMotion * terms.row(row).maxCoeff())) moved(row, c) = 0;
  }
  const Eigen::MatrixXd root = information_root(information);
  // All errors are known: how well does not matter.
  if (root.rows() == (information.diagonal().array() > 0).count()) return moved;
  return root * moved;
}

/// Returns in how many directions the edges move an error by a rigid motion of the component, however faintly: metres of
/// 1e4 m beside radians of 1e-6 are as good as any. It takes its time, and is asked before a graph is refused.
int rank_of_directions(const Graph& graph, const Components& components, std::int32_t component) {
  Eigen::Matrix3d directions = Eigen::Matrix3d::Zero();
  Eigen::VectorXd error;
  std::vector<Eigen::MatrixXd> jacobians;
  const RigidMotionView::Place& place = components.places[at(component)];
  for (std::size_t b = 0; b < graph.batch_count(); ++b) {
    const EdgeBatchBase& batch = graph.batch(b);
    for (std::size_t e = 0; e < batch.size(); ++e) {
      const std::span<const VertexIndex> vertices = batch.vertices(e);
      const auto is_moved = [&](VertexIndex v) { return components.of[at(v)] == component; };
      if (std::none_of(vertices.begin(), vertices.end(), is_moved)) continue;
      batch.linearize_edge(e, graph.view(), error, jacobians);
      Eigen::MatrixXd moved = Eigen::MatrixXd::Zero(error.size(), 3);
      Eigen::MatrixXd terms = moved;
      for (std::size_t k = 0; k < vertices.size(); ++k) {
        if (!is_moved(vertices[k])) continue;
        const Eigen::MatrixXd motion = motion_of(graph, vertices[k], place);
        moved += jacobians[k] * motion;
        terms += jacobians[k].cwiseAbs() * motion.cwiseAbs();
      }
      if (!moved.allFinite()) return 3;  // as in rank_of
      const Eigen::MatrixXd rows = known_rows(batch.information(e), moved, terms);
      for (Eigen::Index row = 0; row < rows.rows(); ++row)
        if (rows.row(row).squaredNorm() > 0)
          directions += rows.row(row).normalized().transpose() * rows.row(row).normalized();
    }
  }
  return rank_of(directions, 1);
}

/// One component, as the gauge judges it.
struct Judged {
  VertexIndex first = -1;
  VertexIndex holds = -1;  ///< what would be held
  bool has_pose = false;   ///< among its vertices
  int count = 0;           ///< vertices
  int motions = 3;         ///< rigid ones that change it
  int rank = 0;            ///< of those that the edges observe

  [[nodiscard]] bool is_anchored() const { return rank >= motions; }
  /// Tells whether it still turns with a vertex held: all are points.
  [[nodiscard]] bool would_turn() const { return motions == 3 && !has_pose; }
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
  if (judged.rank != 0 && !judged.is_anchored())
    judged.rank = rank_of_directions(graph, components, static_cast<std::int32_t>(c));
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

/// @throws InputError for one whose solution is not determined whatever is held
void refuse(const Graph& graph, const Judged& judged) {
  if (judged.rank > 0)
    throw InputError(anchored_in_part(graph, judged) +
                     ", so the solution is not determined (typical: a single GNSS fix, or fixes "
                     "at one place); add fixes at another place or a heading, or FIX one vertex");
  if (judged.would_turn())
    throw InputError("nothing anchors vertex " + to_string(graph.id(judged.first)) + " and the " +
                     std::to_string(judged.count - 1) +
                     " vertices joined to it, which are all points: with one of them FIXed they still turn "
                     "about it; FIX two, or add measurements of where they are");
}

std::string words_for_holding(const Graph& graph, const Judged& judged) {
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
    if (partly == PartlyAnchored::refuse) refuse(graph, judged);
    gauge.held[at(judged.holds)] = 1;
    gauge.messages.push_back(words_for_holding(graph, judged));
  }
  hold_foreign_poses(graph, gauge);
  return gauge;
}

}  // namespace waymark
