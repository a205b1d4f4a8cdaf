#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <numbers>

#include <waymark/core/graph/checks/gradient_check.hpp>

namespace waymark {
namespace {

/// Returns the difference of two errors. A jump of a component by a full turn comes from angle
/// wrapping and is removed.
Eigen::VectorXd difference(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  Eigen::VectorXd d = a - b;
  for (double& x : d) {
    if (std::abs(std::abs(x) - 2 * std::numbers::pi) < 0.1) x -= std::copysign(2 * std::numbers::pi, x);
  }
  return d;
}

/// The error of an edge as a function of one of its vertices.
class ErrorAlongVertex {
 public:
  ErrorAlongVertex(const Graph& graph, std::size_t b, std::size_t edge, VertexIndex v)
      : graph_(graph),
        batch_(graph.batch(b)),
        edge_(edge),
        type_(graph.vertex_type(v)),
        values_(graph.values()),
        original_(graph.value(v).begin(), graph.value(v).end()),
        place_(values_.data() + graph.offsets()[static_cast<std::size_t>(v)]) {}

  Eigen::VectorXd operator()(int column, double step) {
    std::copy(original_.begin(), original_.end(), place_);
    std::vector<double> delta(static_cast<std::size_t>(type_.tangent_size), 0.0);
    delta[static_cast<std::size_t>(column)] = step;
    type_.retract(place_, delta.data());
    Eigen::VectorXd error;
    batch_.linearize_edge(edge_, {values_.data(), graph_.offsets().data()}, error, unused_);
    return error;
  }

  /// Returns what rounding of the vertices may do to a difference of errors. Far from the origin, it is all there is.
  [[nodiscard]] double rounding() const {
    constexpr double kOperations = 8;
    double largest = 0;
    for (const VertexIndex v : batch_.vertices(edge_))
      for (const double number : graph_.value(v)) largest = std::max(largest, std::abs(number));
    return kOperations * std::numeric_limits<double>::epsilon() * largest;
  }

  /// Computes differences of fourth order.
  Eigen::MatrixXd differences(double step) {
    Eigen::MatrixXd jacobian(batch_.error_dimension(edge_), type_.tangent_size);
    for (int c = 0; c < type_.tangent_size; ++c) {
      const Eigen::VectorXd near = difference((*this)(c, step), (*this)(c, -step));
      const Eigen::VectorXd far = difference((*this)(c, 2 * step), (*this)(c, -2 * step));
      jacobian.col(c) = (8 * near - far) / (12 * step);
    }
    return jacobian;
  }

 private:
  const Graph& graph_;
  const EdgeBatchBase& batch_;
  std::size_t edge_;
  const VertexType& type_;
  std::vector<double> values_;
  std::vector<double> original_;
  double* place_;
  std::vector<Eigen::MatrixXd> unused_;
};

/// Keeps the largest disagreement of one Jacobian. Disagreements below the accuracy of the
/// differences are ignored.
void compare(const Eigen::MatrixXd& given, const NumericJacobian& numeric, std::size_t edge, std::size_t k,
             GradientCheck& result) {
  const Eigen::MatrixXd& reference = numeric.jacobian;
  for (Eigen::Index row = 0; row < reference.rows(); ++row) {
    for (Eigen::Index column = 0; column < reference.cols(); ++column) {
      const double expected = reference(row, column);
      const double size = 1 + std::abs(expected);
      double off = std::abs(given(row, column) - expected) / size;
      if (numeric.tolerance > kGradientTolerance * size && off * size <= numeric.tolerance) continue;
      if (std::isnan(off)) off = std::numeric_limits<double>::infinity();
      if (off <= result.error) continue;
      result = {
          result.edges,       result.judged, off, edge, k, static_cast<int>(row), static_cast<int>(column),
          given(row, column), expected};
    }
  }
}

}  // namespace

std::optional<NumericJacobian> numeric_jacobian(const Graph& graph, std::size_t b, std::size_t edge,
                                                std::size_t k) {
  constexpr double kLongest = 2e-3;
  ErrorAlongVertex error(graph, b, edge, graph.batch(b).vertices(edge)[k]);
  const double smooth = 1e-9 * kLongest * (1 + error(0, 0).cwiseAbs().maxCoeff());
  const double uncertain = smooth + error.rounding();
  for (double step = kLongest; step > 1e-12; step /= 10) {
    const double tolerance = uncertain / step;
    const Eigen::MatrixXd jacobian = error.differences(step / 2);
    if ((jacobian - error.differences(step)).cwiseAbs().maxCoeff() <= tolerance)
      return NumericJacobian{jacobian, tolerance};
  }
  return std::nullopt;
}

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
      const auto reference = numeric_jacobian(graph, b, edge, k);
      if (!reference) continue;
      ++result.judged;
      compare(jacobians[k], *reference, edge, k, result);
    }
  }
  return result;
}

std::string describe(const Graph& graph, std::size_t b, const GradientCheck& check) {
  const VertexIndex v = graph.batch(b).vertices(check.edge)[check.vertex];
  const VertexType& type = graph.vertex_type(v);
  const bool named = type.value_size == type.tangent_size;
  const std::string column =
      named ? " (" + type.value_names[static_cast<std::size_t>(check.column)] + ")" : std::string();
  char numbers[120];
  std::snprintf(numbers, sizeof numbers, "given %.10g, differences of the error give %.10g", check.given,
                check.reference);
  return graph.edge_type(b).tag + " number " + std::to_string(check.edge + 1) + ": Jacobian by vertex " +
         std::to_string(check.vertex + 1) + " (" + type.tag + " " + to_string(graph.id(v)) + "), row " +
         std::to_string(check.row) + ", column " + std::to_string(check.column) + column + ": " + numbers;
}

}  // namespace waymark
