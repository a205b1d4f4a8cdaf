#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include <waymark/core/covariance/evidence.hpp>
#include <waymark/core/linear/dense_decompositions.hpp>
#include <waymark/core/system/gauge.hpp>
#include <waymark/core/system/normal_equations.hpp>

namespace waymark {
namespace {

/// An axis below this share of the largest eigenvalue carries no information.
constexpr double kNoInformation = 1e-12;

/// Returns the logarithm of det Omega by Cholesky's method; nothing if an axis carries no
/// information. Almost all edges have one to three dimensions, and every step of a noise search
/// asks for each of them.
template <int N>
std::optional<double> log_determinant_by_root(const Eigen::MatrixXd& information) {
  Eigen::Matrix<double, N, N> root = information;
  double smallest = std::numeric_limits<double>::infinity();
  double sum = 0;
  for (int k = 0; k < N; ++k) {
    double squares = 0;
    for (int j = 0; j < k; ++j) squares += root(k, j) * root(k, j);
    const double pivot = root(k, k) - squares;
    if (!(pivot > 0)) return std::nullopt;
    smallest = std::min(smallest, pivot);
    root(k, k) = std::sqrt(pivot);
    sum += std::log(root(k, k));
    for (int i = k + 1; i < N; ++i) {
      for (int j = 0; j < k; ++j) root(i, k) -= root(i, j) * root(k, j);
      root(i, k) /= root(k, k);
    }
  }
  if (!(smallest > kNoInformation * information.diagonal().maxCoeff())) return std::nullopt;
  return 2 * sum;
}

/// Returns the logarithm of the product of the eigenvalues that carry information.
double log_determinant_by_axes(const Eigen::MatrixXd& information) {
  const Eigen::VectorXd eigenvalues = symmetric_eigenvalues(information);
  double sum = 0;
  for (const double eigenvalue : eigenvalues) {
    if (eigenvalue > kNoInformation * eigenvalues.tail(1)[0]) sum += std::log(eigenvalue);
  }
  return sum;
}

double log_determinant_of(const Eigen::MatrixXd& information) {
  if (information.rows() == 0) return 0;
  std::optional<double> by_root;
  if (information.rows() == 1) by_root = log_determinant_by_root<1>(information);
  if (information.rows() == 2) by_root = log_determinant_by_root<2>(information);
  if (information.rows() == 3) by_root = log_determinant_by_root<3>(information);
  return by_root ? *by_root : log_determinant_by_axes(information);
}

double log_det_information(const Graph& graph) {
  double sum = 0;
  for (std::size_t b = 0; b < graph.batch_count(); ++b) {
    const EdgeBatchBase& batch = graph.batch(b);
    for (std::size_t i = 0; i < batch.size(); ++i) sum += log_determinant_of(batch.information(i));
  }
  return sum;
}

/// Returns the weight of a robust edge at which Laplace's method gives the density exp(-rho / 2)
/// of its error its true mass. A heavy tail makes the peak narrower than a normal distribution of
/// the same mass.
double weight_of_mass(const Loss& loss, int dimension) {
  // standard deviations; further out a bounded loss has infinite mass
  constexpr double kReach = 20;
  constexpr int kSteps = 4'000;
  double heavy = 0;
  double normal = 0;
  for (int i = 0; i < kSteps; ++i) {
    const double r = kReach * (i + 0.5) / kSteps;
    const double shell = std::pow(r, dimension - 1);
    heavy += shell * std::exp(-0.5 * loss.at(r * r).rho);
    normal += shell * std::exp(-0.5 * r * r);
  }
  return std::pow(normal / heavy, 2.0 / dimension);
}

/// Returns for each batch the smallest weight of its losses, and 1 if it has none.
/// @param weight_of the weight of a loss on errors of a dimension
template <typename WeightOf>
std::vector<double> evidence_weights(const Graph& graph, const WeightOf& weight_of) {
  std::vector<double> weights(graph.batch_count(), 1.0);
  for (std::size_t b = 0; b < graph.batch_count(); ++b) {
    const EdgeBatchBase& batch = graph.batch(b);
    const Loss* last = nullptr;
    for (std::size_t i = 0; i < batch.size(); ++i) {
      const Loss* loss = batch.loss(i);
      if (loss == nullptr || loss == last) continue;
      weights[b] = std::min(weights[b], weight_of(*loss, batch.error_dimension(i)));
      last = loss;
    }
  }
  return weights;
}

Evidence evidence_at(const std::vector<double>& values, std::span<const double> weights, const Graph& graph,
                     NormalEquations& equations, BlockCholesky& cholesky) {
  Evidence result;
  result.chi2 = equations.linearize(values, weights);
  result.log_det_hessian = cholesky.factorize(equations.hessian()) == FactorStatus::ok
                               ? cholesky.log_determinant() - equations.log_of_held_information()
                               : std::numeric_limits<double>::infinity();
  result.log_det_information = log_det_information(graph);
  return result;
}

}  // namespace

Evidence evidence(const Graph& graph, const Structure& structure, BlockCholesky& cholesky) {
  NormalEquations equations(graph, structure);
  return evidence_at(graph.values(), evidence_weights(graph, weight_of_mass), graph, equations, cholesky);
}

RepeatedEvidence::RepeatedEvidence(const Graph& graph, const Structure& structure)
    : graph_(graph), equations_(graph, structure) {
  cholesky_.analyze(structure.pattern());
}

double RepeatedEvidence::weight_of(const Loss& loss, int dimension) {
  const auto known = std::find_if(known_.begin(), known_.end(), [&](const LossWeight& other) {
    return other.dimension == dimension && other.loss == loss;
  });
  if (known != known_.end()) return known->weight;
  return known_.emplace_back(LossWeight{loss, dimension, weight_of_mass(loss, dimension)}).weight;
}

std::vector<double> RepeatedEvidence::weights() {
  return evidence_weights(graph_,
                          [&](const Loss& loss, int dimension) { return weight_of(loss, dimension); });
}

Evidence RepeatedEvidence::at(const std::vector<double>& values) {
  return evidence_at(values, weights(), graph_, equations_, cholesky_);
}

Evidence evidence(const Graph& graph) {
  Structure structure;
  structure.build(graph, find_gauge(graph).held);
  BlockCholesky cholesky;
  cholesky.analyze(structure.pattern());
  return evidence(graph, structure, cholesky);
}

}  // namespace waymark
