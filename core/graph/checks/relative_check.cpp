#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include <waymark/core/graph/checks/relative_check.hpp>
#include <waymark/core/graph/detail/edge_name.hpp>

namespace waymark {
namespace {

constexpr int kMotions = 3;
constexpr double kNoChange = 1e-6;  // in the units of the error: rows that nothing changes hold rounding only

/// How an error changes if the vertices of its edge move together, and what they would change alone at most.
struct Change {
  Eigen::MatrixXd together;
  Eigen::MatrixXd alone;
};

bool all_move(const Graph& graph, std::span<const VertexIndex> vertices) {
  return !vertices.empty() && std::all_of(vertices.begin(), vertices.end(), [&](VertexIndex v) {
    return graph.vertex_type(v).rigid_motion != nullptr;
  });
}

/// Returns the change by each motion. The turn is about the first vertex, so that it stays small far from
/// the origin.
Change change_of(const Graph& graph, const EdgeBatchBase& batch, std::size_t edge) {
  Eigen::VectorXd error;
  std::vector<Eigen::MatrixXd> jacobians;
  batch.linearize_edge(edge, graph.view(), error, jacobians);
  const auto vertices = batch.vertices(edge);
  const Eigen::Vector2d centre = graph.vertex_type(vertices[0]).position(graph.value(vertices[0]).data());
  Change change{Eigen::MatrixXd::Zero(error.size(), kMotions), Eigen::MatrixXd::Zero(error.size(), kMotions)};
  for (std::size_t k = 0; k < vertices.size(); ++k) {
    const VertexType& type = graph.vertex_type(vertices[k]);
    Eigen::MatrixXd motion(type.tangent_size, kMotions);
    type.rigid_motion(graph.value(vertices[k]).data(), centre, 1, motion.data());
    change.together += jacobians[k] * motion;
    change.alone += jacobians[k].rowwise().norm() * motion.colwise().norm();
  }
  return change;
}

void keep_largest(const Change& change, std::size_t edge, RelativeCheck& result) {
  for (int row = 0; row < change.together.rows(); ++row) {
    for (int motion = 0; motion < kMotions; ++motion) {
      const double by = change.together(row, motion);
      const double share = std::abs(by) / (kNoChange + change.alone(row, motion));
      if (share > result.error) result = {result.edges, share, edge, row, motion, by};
    }
  }
}

}  // namespace

RelativeCheck check_relative(const Graph& graph, std::size_t b, std::size_t most) {
  RelativeCheck result;
  if (!graph.edge_type(b).relative) return result;
  const EdgeBatchBase& batch = graph.batch(b);
  const std::size_t stride = std::max<std::size_t>(1, batch.size() / std::max<std::size_t>(1, most));
  for (std::size_t edge = 0; edge < batch.size() && result.edges < most; edge += stride) {
    if (!all_move(graph, batch.vertices(edge))) continue;
    ++result.edges;
    keep_largest(change_of(graph, batch, edge), edge, result);
  }
  return result;
}

std::string describe(const RelativeCheck& check) {
  constexpr std::array kWays = {"m if all its vertices move along x", "m if all its vertices move along y",
                                "rad if all its vertices turn about the first one"};
  char change[40];
  std::snprintf(change, sizeof change, "%.4g", check.change);
  return "it says kRelative, but row " + std::to_string(check.row) + " of its error changes by " + change +
         " per " + kWays[static_cast<std::size_t>(check.motion)] +
         "; leave kRelative out, or mend the error or rigid_motion() of the vertices";
}

std::string describe(const Graph& graph, std::size_t batch, const RelativeCheck& check) {
  return detail::edge_name(graph, batch, check.edge) + ": " + describe(check);
}

}  // namespace waymark
