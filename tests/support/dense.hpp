/// The normal equations of a graph as dense matrices, assembled edge by edge from errors and
/// Jacobians. Tests compare block patterns, scatter offsets and selected inverses with this
/// plain method.
#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

#include <waymark/core/graph/graph.hpp>
#include <waymark/core/system/normal_equations.hpp>

namespace waymark_test {

/// H and g with the unknowns in the order of the vertices. start[v] is -1 if vertex v
/// is no unknown.
struct DenseSystem {
  Eigen::MatrixXd hessian;
  Eigen::VectorXd gradient;
  std::vector<Eigen::Index> start;
};

[[nodiscard]] inline DenseSystem assemble_dense(const waymark::Graph& graph, std::span<const char> held) {
  using namespace waymark;
  DenseSystem system;
  std::vector<char> has_edge(graph.vertex_count(), 0);
  for (std::size_t b = 0; b < graph.batch_count(); ++b) {
    for (std::size_t e = 0; e < graph.batch(b).size(); ++e) {
      for (const VertexIndex v : graph.batch(b).vertices(e)) has_edge[static_cast<std::size_t>(v)] = 1;
    }
  }
  Eigen::Index size = 0;
  for (std::size_t v = 0; v < graph.vertex_count(); ++v) {
    const auto vertex = static_cast<VertexIndex>(v);
    const bool unknown = has_edge[v] != 0 && !graph.fixed(vertex) && held[v] == 0;
    system.start.push_back(unknown ? size : -1);
    if (unknown) size += graph.vertex_type(vertex).tangent_size;
  }
  system.hessian.setZero(size, size);
  system.gradient.setZero(size);
  Eigen::VectorXd error;
  std::vector<Eigen::MatrixXd> jacobians;
  for (std::size_t b = 0; b < graph.batch_count(); ++b) {
    const EdgeBatchBase& batch = graph.batch(b);
    for (std::size_t e = 0; e < batch.size(); ++e) {
      batch.linearize_edge(e, graph.view(), error, jacobians);
      Eigen::MatrixXd omega = batch.information(e);
      if (const Loss* loss = batch.loss(e)) {
        omega *= loss->evaluate(error.dot(omega * error), loss->scale).weight;
      }
      const auto vertices = batch.vertices(e);
      for (std::size_t k = 0; k < vertices.size(); ++k) {
        const Eigen::Index row = system.start[static_cast<std::size_t>(vertices[k])];
        if (row < 0) continue;
        system.gradient.segment(row, jacobians[k].cols()) += jacobians[k].transpose() * omega * error;
        for (std::size_t l = 0; l < vertices.size(); ++l) {
          const Eigen::Index column = system.start[static_cast<std::size_t>(vertices[l])];
          if (column < 0) continue;
          system.hessian.block(row, column, jacobians[k].cols(), jacobians[l].cols()) +=
              jacobians[k].transpose() * omega * jacobians[l];
        }
      }
    }
  }
  return system;
}

/// Expands the block-sparse normal equations and puts them in the order of the vertices.
[[nodiscard]] inline DenseSystem spread_out(const waymark::Graph& graph, const waymark::Structure& structure,
                                            const waymark::NormalEquations& equations) {
  using namespace waymark;
  DenseSystem system;
  Eigen::Index size = 0;
  std::vector<Eigen::Index> place(static_cast<std::size_t>(structure.pattern().dimension()));
  for (std::size_t v = 0; v < graph.vertex_count(); ++v) {
    const int column = structure.column_of(static_cast<VertexIndex>(v));
    system.start.push_back(column < 0 ? -1 : size);
    if (column < 0) continue;
    const auto first = structure.pattern().start[static_cast<std::size_t>(column)];
    const int tangent = graph.vertex_type(static_cast<VertexIndex>(v)).tangent_size;
    for (int i = 0; i < tangent; ++i) place[static_cast<std::size_t>(first + i)] = size + i;
    size += tangent;
  }
  system.hessian.setZero(size, size);
  system.gradient.setZero(size);
  const ScalarPattern<int> scalar = to_scalar<int>(structure.pattern());
  for (std::size_t j = 0; j + 1 < scalar.column.size(); ++j) {
    system.gradient[place[j]] = equations.gradient()[static_cast<Eigen::Index>(j)];
    for (int k = scalar.column[j]; k < scalar.column[j + 1]; ++k) {
      const auto i = static_cast<std::size_t>(scalar.row[static_cast<std::size_t>(k)]);
      const double value = equations.hessian()[static_cast<std::size_t>(k)];
      system.hessian(place[i], place[j]) = value;
      system.hessian(place[j], place[i]) = value;
    }
  }
  return system;
}

/// Returns the largest difference of entries, relative to the largest entry of the reference.
template <typename A, typename B>
[[nodiscard]] double relative_difference(const A& value, const B& reference) {
  if (value.rows() != reference.rows() || value.cols() != reference.cols()) return 1e300;
  if (value.size() == 0) return 0;
  return (value - reference).cwiseAbs().maxCoeff() / (1e-300 + reference.cwiseAbs().maxCoeff());
}

}  // namespace waymark_test
