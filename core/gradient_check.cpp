#include <algorithm>
#include <cmath>
#include <numbers>

#include <waymark/core/gradient_check.hpp>

namespace waymark {
namespace {

/// Difference of two errors; a component that jumped by a turn did so only because angles wrap.
Eigen::VectorXd difference(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  Eigen::VectorXd d = a - b;
  for (double& x : d) {
    if (std::abs(std::abs(x) - 2 * std::numbers::pi) < 1e-3) x -= std::copysign(2 * std::numbers::pi, x);
  }
  return d;
}

Eigen::MatrixXd numeric_jacobian(const Graph& graph, std::size_t b, std::size_t edge, VertexIndex v) {
  const VertexType& type = graph.vertex_type(v);
  std::vector<double> values = graph.values();
  const std::vector<double> original(graph.value(v).begin(), graph.value(v).end());
  double* value = values.data() + graph.offsets()[static_cast<std::size_t>(v)];
  const ValueView view{values.data(), graph.offsets().data()};
  Eigen::VectorXd side[2];
  std::vector<Eigen::MatrixXd> unused;
  Eigen::MatrixXd jacobian(graph.batch(b).error_dimension(edge), type.tangent_size);
  for (int column = 0; column < type.tangent_size; ++column) {
    double size = 1;
    for (const double x : original) size = std::max(size, std::abs(x));
    const double step = 1e-6 * std::cbrt(size);
    for (int sign = 0; sign < 2; ++sign) {
      std::copy(original.begin(), original.end(), value);
      std::vector<double> delta(static_cast<std::size_t>(type.tangent_size), 0.0);
      delta[static_cast<std::size_t>(column)] = sign == 0 ? -step : step;
      type.retract(value, delta.data());
      graph.batch(b).linearize_edge(edge, view, side[sign], unused);
    }
    jacobian.col(column) = difference(side[1], side[0]) / (2 * step);
  }
  return jacobian;
}

}  // namespace

GradientCheck check_gradients(const Graph& graph, std::size_t b, std::size_t most) {
  GradientCheck result;
  const EdgeBatchBase& batch = graph.batch(b);
  const std::size_t stride = std::max<std::size_t>(1, batch.size() / std::max<std::size_t>(1, most));
  Eigen::VectorXd error;
  std::vector<Eigen::MatrixXd> jacobians;
  for (std::size_t edge = 0; edge < batch.size() && result.edges < most; edge += stride) {
    ++result.edges;
    batch.linearize_edge(edge, graph.view(), error, jacobians);
    for (std::size_t k = 0; k < jacobians.size(); ++k) {
      const Eigen::MatrixXd reference = numeric_jacobian(graph, b, edge, batch.vertices(edge)[k]);
      for (Eigen::Index row = 0; row < reference.rows(); ++row) {
        for (Eigen::Index column = 0; column < reference.cols(); ++column) {
          const double given = jacobians[k](row, column);
          const double expected = reference(row, column);
          const double off = std::abs(given - expected) / (1 + std::abs(expected));
          if (off <= result.error) continue;
          result.error = off;
          result.edge = edge;
          result.vertex = static_cast<int>(k);
          result.row = static_cast<int>(row);
          result.column = static_cast<int>(column);
          result.given = given;
          result.reference = expected;
        }
      }
    }
  }
  return result;
}

}  // namespace waymark
