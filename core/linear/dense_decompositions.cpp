#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include <waymark/core/linear/dense_decompositions.hpp>

namespace waymark {
namespace {

/// Tells whether every diagonal number is at least the sum of the other magnitudes in its column.
/// This is the usual case.
bool is_diagonally_dominant(const Eigen::MatrixXd& matrix) {
  for (Eigen::Index column = 0; column < matrix.cols(); ++column) {
    double rest = matrix(column, column);
    for (Eigen::Index row = 0; row < matrix.rows(); ++row) {
      if (row != column) rest -= std::abs(matrix(row, column));
    }
    if (!(rest >= 0)) return false;
  }
  return true;
}

bool has_factor(const Eigen::MatrixXd& matrix) {
  return matrix.allFinite() && Eigen::LLT<Eigen::MatrixXd>(matrix).info() == Eigen::Success;
}

}  // namespace

SymmetricEigen symmetric_eigen(const Eigen::MatrixXd& matrix) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(matrix);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

Eigen::VectorXd symmetric_eigenvalues(const Eigen::MatrixXd& matrix) {
  return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(matrix, Eigen::EigenvaluesOnly).eigenvalues();
}

bool is_positive_semidefinite(const Eigen::MatrixXd& matrix) {
  if (is_diagonally_dominant(matrix)) return true;  // by Gershgorin
  if (has_factor(matrix)) return true;              // faster than the eigenvalues
  const Eigen::VectorXd eigenvalues = symmetric_eigenvalues(matrix);
  const double largest = std::max(std::abs(eigenvalues[0]), eigenvalues[eigenvalues.size() - 1]);
  return eigenvalues[0] >= -1e-9 * largest;
}

// [0 A; A^T 0] has the eigenvalues +-values with the eigenvectors (u, +-v) / sqrt(2). Nothing is squared,
// and the decomposition that exists is used again.
SingularValues singular_values(const Eigen::MatrixXd& matrix) {
  const Eigen::Index m = matrix.rows();
  const Eigen::Index n = matrix.cols();
  const Eigen::Index k = std::min(m, n);
  Eigen::MatrixXd both = Eigen::MatrixXd::Zero(m + n, m + n);
  both.topRightCorner(m, n) = matrix;
  both.bottomLeftCorner(n, m) = matrix.transpose();
  const auto [values, vectors] = symmetric_eigen(both);
  const Eigen::MatrixXd pairs = std::sqrt(2.0) * vectors.rightCols(k).rowwise().reverse();
  return {values.tail(k).reverse().cwiseMax(0), pairs.topRows(m), pairs.bottomRows(n)};
}

std::optional<Eigen::MatrixXd> inverse_of_positive_definite(const Eigen::MatrixXd& matrix) {
  const Eigen::LLT<Eigen::MatrixXd> factor(matrix);
  if (factor.info() != Eigen::Success) return std::nullopt;
  Eigen::MatrixXd inverse = factor.solve(Eigen::MatrixXd::Identity(matrix.rows(), matrix.cols()));
  inverse = (0.5 * inverse + 0.5 * inverse.transpose()).eval();  // their sum may be infinite
  if (!inverse.allFinite()) return std::nullopt;
  return inverse;
}

}  // namespace waymark
