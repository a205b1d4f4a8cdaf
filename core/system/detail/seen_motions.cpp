#include <algorithm>
#include <cmath>
#include <cstdint>
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

std::vector<Eigen::Matrix3d> seen_directions(const Graph& graph, const Components& components,
                                             std::span<const char> asked) {
  std::vector<Eigen::Matrix3d> directions(components.first.size(), Eigen::Matrix3d::Zero());
  Eigen::VectorXd error;
  std::vector<Eigen::MatrixXd> jacobians;
  const auto component_of = [&](VertexIndex v) { return components.of[at(v)]; };
  for (std::size_t b = 0; b < graph.batch_count(); ++b) {
    const EdgeBatchBase& batch = graph.batch(b);
    for (std::size_t e = 0; e < batch.size(); ++e) {
      const std::span<const VertexIndex> vertices = batch.vertices(e);
      // The vertices of an edge that move are joined by it, so they are all of one component.
      const auto moving =
          std::find_if(vertices.begin(), vertices.end(), [&](VertexIndex v) { return component_of(v) >= 0; });
      if (moving == vertices.end() || asked[at(component_of(*moving))] == 0) continue;
      const std::size_t component = at(component_of(*moving));
      batch.linearize_edge(e, graph.view(), error, jacobians);
      Eigen::MatrixXd moved = Eigen::MatrixXd::Zero(error.size(), 3);
      Eigen::MatrixXd terms = moved;
      for (std::size_t k = 0; k < vertices.size(); ++k) {
        if (component_of(vertices[k]) < 0) continue;
        const Eigen::MatrixXd motion = motion_of(graph, vertices[k], components.places[component]);
        moved += jacobians[k] * motion;
        terms += jacobians[k].cwiseAbs() * motion.cwiseAbs();
      }
      // As in rank_of. What is added later is no less than that.
      if (!moved.allFinite()) {
        directions[component] += Eigen::Matrix3d::Identity();
        continue;
      }
      const Eigen::MatrixXd rows = known_rows(batch.information(e), moved, terms);
      for (Eigen::Index row = 0; row < rows.rows(); ++row)
        if (rows.row(row).squaredNorm() > 0)
          directions[component] += rows.row(row).normalized().transpose() * rows.row(row).normalized();
    }
  }
  return directions;
}

std::vector<Eigen::Matrix3d> seen_elsewhere(const Graph& graph, const Components& components,
                                            std::span<const char> asked) {
  std::mt19937 random(1);
  const auto draw = [&] { return 2.0 * static_cast<double>(random()) / std::mt19937::max() - 1; };
  Graph elsewhere = graph;
  for (std::size_t v = 0; v < graph.vertex_count(); ++v) {
    const std::int32_t component = components.of[v];
    if (component < 0 || asked[at(component)] == 0) continue;
    const RigidMotionView::Place& place = components.places[at(component)];
    const auto vertex = static_cast<VertexIndex>(v);
    const Eigen::Vector3d way(draw(), draw(), draw());
    const Eigen::VectorXd step = place.extent * (motion_of(graph, vertex, place) * way);
    std::vector<double> value(graph.value(vertex).begin(), graph.value(vertex).end());
    graph.vertex_type(vertex).retract(value.data(), step.data());
    elsewhere.set_value(vertex, value);
  }
  return seen_directions(elsewhere, components, asked);
}

}  // namespace waymark::detail
