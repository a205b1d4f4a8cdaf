#include <cmath>
#include <limits>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include <waymark/core/evidence.hpp>
#include <waymark/core/gauge.hpp>
#include <waymark/core/normal_equations.hpp>

namespace waymark {
namespace {

/// Below this share of the largest eigenvalue an axis carries no information.
constexpr double kNoInformation = 1e-12;

template <int N>
double log_determinant(const Eigen::MatrixXd& information) {
  using Matrix = Eigen::Matrix<double, N, N>;
  const Matrix fixed = information;
  const Eigen::LLT<Matrix> root(fixed);
  if (root.info() == Eigen::Success) {
    const auto diagonal = root.matrixLLT().diagonal().array();
    if (diagonal.square().minCoeff() > kNoInformation * fixed.diagonal().maxCoeff())
      return 2 * diagonal.log().sum();
  }
  const Eigen::SelfAdjointEigenSolver<Matrix> solver(fixed, Eigen::EigenvaluesOnly);
  const double largest = solver.eigenvalues().tail(1)[0];
  double sum = 0;
  for (const double eigenvalue : solver.eigenvalues()) {
    if (eigenvalue > kNoInformation * largest) sum += std::log(eigenvalue);
  }
  return sum;
}

double log_determinant_of(const Eigen::MatrixXd& information) {
  switch (information.rows()) {
    case 0:
      return 0;
    case 1:
      return log_determinant<1>(information);
    case 2:
      return log_determinant<2>(information);
    case 3:
      return log_determinant<3>(information);
    default:
      return log_determinant<Eigen::Dynamic>(information);
  }
}

double log_det_information(const Graph& graph) {
  double sum = 0;
  for (std::size_t b = 0; b < graph.batch_count(); ++b) {
    const EdgeBatchBase& batch = graph.batch(b);
    for (std::size_t i = 0; i < batch.size(); ++i) sum += log_determinant_of(batch.information(i));
  }
  return sum;
}

}  // namespace

Evidence evidence(const Graph& graph, const Structure& structure, BlockCholesky& cholesky) {
  NormalEquations equations(graph, structure);
  Evidence result;
  result.chi2 = equations.linearize(graph.values(), false);
  result.log_det_hessian = cholesky.factorize(equations.hessian()) == FactorStatus::ok
                               ? cholesky.log_determinant()
                               : std::numeric_limits<double>::infinity();
  result.log_det_information = log_det_information(graph);
  return result;
}

Evidence evidence(const Graph& graph) {
  Structure structure;
  structure.build(graph, find_gauge(graph).held);
  BlockCholesky cholesky;
  cholesky.analyze(structure.pattern());
  return evidence(graph, structure, cholesky);
}

}  // namespace waymark
