#include <algorithm>
#include <cmath>
#include <random>

#include <waymark/core/base/detail/index.hpp>
#include <waymark/core/linear/dense_decompositions.hpp>
#include <waymark/core/linear/detail/information_root.hpp>
#include <waymark/core/system/detail/seen_motions.hpp>

namespace waymark::detail {
namespace {

/// Returns what is only rounding among eigenvalues.
double resolution(double largest, double unit) {
  // (J T) of a component without anchor cancels to about 1e-12, squared times Omega
  constexpr double kRounding = 1e-12;
  constexpr double kRelative = 1e-12;
  return std::max(kRounding * unit, kRelative * largest);
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

}  // namespace

int rank_of(const Eigen::Matrix3d& information, double unit) {
  if (!information.allFinite()) return 3;  // whoever uses the graph finds the edge that is not finite
  const Eigen::Vector3d eigenvalues = symmetric_eigenvalues(information);
  return static_cast<int>((eigenvalues.array() > resolution(eigenvalues[2], unit)).count());
}

Eigen::MatrixXd unseen_motions(const Eigen::Matrix3d& information, double unit) {
  const SymmetricEigen eigen = symmetric_eigen(information);  // in increasing order
  return eigen.vectors.leftCols(3 - rank_of(information, unit));
}

Eigen::Matrix3d seen_directions(const Graph& graph, const Components& components, std::int32_t component) {
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
      if (!moved.allFinite()) return Eigen::Matrix3d::Identity();  // as in rank_of
      const Eigen::MatrixXd rows = known_rows(batch.information(e), moved, terms);
      for (Eigen::Index row = 0; row < rows.rows(); ++row)
        if (rows.row(row).squaredNorm() > 0)
          directions += rows.row(row).normalized().transpose() * rows.row(row).normalized();
    }
  }
  return directions;
}

Eigen::Matrix3d seen_elsewhere(const Graph& graph, const Components& components, std::int32_t component) {
  std::mt19937 random(1);
  const auto draw = [&] { return 2.0 * static_cast<double>(random()) / std::mt19937::max() - 1; };
  const RigidMotionView::Place& place = components.places[at(component)];
  Graph elsewhere = graph;
  for (std::size_t v = 0; v < graph.vertex_count(); ++v) {
    if (components.of[v] != component) continue;
    const auto vertex = static_cast<VertexIndex>(v);
    const Eigen::Vector3d way(draw(), draw(), draw());
    const Eigen::VectorXd step = place.extent * (motion_of(graph, vertex, place) * way);
    std::vector<double> value(graph.value(vertex).begin(), graph.value(vertex).end());
    graph.vertex_type(vertex).retract(value.data(), step.data());
    elsewhere.set_value(vertex, value);
  }
  return seen_directions(elsewhere, components, component);
}

}  // namespace waymark::detail
