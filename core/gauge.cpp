#include <algorithm>
#include <numeric>

#include <Eigen/Eigenvalues>

#include <waymark/core/error.hpp>
#include <waymark/core/gauge.hpp>
#include <waymark/core/incidence.hpp>

namespace waymark {
namespace {

std::size_t at(std::int64_t i) {
  return static_cast<std::size_t>(i);
}

/// Components of free vertices by union-find with path halving; the root is the first vertex of each.
std::vector<std::int32_t> find_components(const Graph& graph) {
  std::vector<std::int32_t> parent(graph.vertex_count());
  std::iota(parent.begin(), parent.end(), 0);
  const auto root = [&](std::int32_t v) {
    while (parent[at(v)] != v) v = parent[at(v)] = parent[at(parent[at(v)])];
    return v;
  };
  for (std::size_t b = 0; b < graph.batch_count(); ++b) {
    const EdgeBatchBase& batch = graph.batch(b);
    for (std::size_t e = 0; e < batch.size(); ++e) {
      std::int32_t joined = -1;
      for (const VertexIndex v : batch.vertices(e)) {
        if (graph.fixed(v)) continue;
        const std::int32_t r = root(v);
        if (joined >= 0 && r != joined) {
          parent[at(std::max(r, joined))] = std::min(r, joined);
          joined = std::min(r, joined);
        } else {
          joined = r;
        }
      }
    }
  }
  for (std::size_t v = 0; v < parent.size(); ++v) parent[v] = root(static_cast<std::int32_t>(v));
  return parent;
}

/// Centre and extent of each component's positions.
struct Place {
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();
  double extent = 1;
  int count = 0;
};

std::vector<Place> find_places(const Graph& graph, const std::vector<std::int32_t>& component) {
  std::vector<Place> places(graph.vertex_count());
  const auto for_each_place = [&](auto visit) {
    for (std::size_t v = 0; v < graph.vertex_count(); ++v) {
      const auto vertex = static_cast<VertexIndex>(v);
      const VertexType& type = graph.vertex_type(vertex);
      if (type.rigid_motion == nullptr || graph.fixed(vertex)) continue;
      visit(places[at(component[v])], type.position(graph.value(vertex).data()));
    }
  };
  for_each_place([](Place& place, const Eigen::Vector2d& position) {
    place.centre += position;
    ++place.count;
  });
  for (Place& place : places) {
    if (place.count > 0) place.centre /= place.count;
  }
  // At least a metre: below, a turn of the component means only turning its poses.
  for_each_place([](Place& place, const Eigen::Vector2d& position) {
    place.extent = std::max(place.extent, (position - place.centre).norm());
  });
  return places;
}

/// Number of eigenvalues above the noise of the largest; 0 where all of them are no more than rounding.
int rank_of(const Eigen::Matrix3d& information) {
  const Eigen::Vector3d eigenvalues =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(information).eigenvalues();
  constexpr double kRounding =
      1e-12;  // (J T) of an unanchored component cancels to about 1e-12, squared times Omega
  constexpr double kRelative = 1e-12;
  int rank = 0;
  for (const double value : eigenvalues) rank += value > std::max(kRounding, kRelative * eigenvalues[2]);
  return rank;
}

[[noreturn]] void refuse(const Graph& graph, VertexIndex v, int rank) {
  throw InputError(
      "vertex " + std::to_string(graph.id(v)) + " and what is joined to it are anchored in " +
      std::to_string(rank) +
      " of 3 rigid motions only, so the solution is not determined (typical: a single GNSS fix, or fixes "
      "at one place); add fixes at another place, a heading, or FIX one vertex");
}

}  // namespace

Gauge find_gauge(const Graph& graph) {
  const std::vector<std::int32_t> component = find_components(graph);
  const std::vector<Place> places = find_places(graph, component);
  std::vector<std::int64_t> offsets(graph.vertex_count(), -1);
  std::vector<double> columns;
  for (std::size_t v = 0; v < graph.vertex_count(); ++v) {
    const auto vertex = static_cast<VertexIndex>(v);
    const VertexType& type = graph.vertex_type(vertex);
    if (type.rigid_motion == nullptr || graph.fixed(vertex)) continue;
    offsets[v] = static_cast<std::int64_t>(columns.size());
    columns.resize(columns.size() + at(3 * type.tangent_size));
    const Place& place = places[at(component[v])];
    type.rigid_motion(graph.value(vertex).data(), place.centre, place.extent, columns.data() + offsets[v]);
  }
  std::vector<Eigen::Matrix3d> information(graph.vertex_count(), Eigen::Matrix3d::Zero());
  const RigidMotionView motion{columns.data(), offsets.data(), component.data(), information.data()};
  for (std::size_t b = 0; b < graph.batch_count(); ++b)
    graph.batch(b).add_rigid_information(graph.view(), motion);

  Gauge gauge;
  gauge.held.assign(graph.vertex_count(), 0);
  const std::vector<char> has_edge = vertices_with_edges(graph);
  std::vector<VertexIndex> judged(graph.vertex_count(), -1);  // first vertex with a place, per component
  for (std::size_t v = 0; v < graph.vertex_count(); ++v) {
    const auto c = at(component[v]);
    if (offsets[v] < 0 || !has_edge[v] || judged[c] >= 0) continue;
    const auto vertex = static_cast<VertexIndex>(v);
    judged[c] = vertex;
    const int rank = rank_of(information[c]);
    if (rank == 1 || rank == 2) refuse(graph, vertex, rank);
    if (rank == 0) {
      gauge.held[v] = 1;
      gauge.messages.push_back("nothing anchors vertex " + std::to_string(graph.id(vertex)) + " and the " +
                               std::to_string(places[c].count - 1) +
                               " vertices joined to it: it is held at its present value");
    }
  }
  return gauge;
}

}  // namespace waymark
