/// Decompositions of small dense matrices of any size, compiled once: Eigen's templates for them
/// take seconds in every source that instantiates them. Not for inner loops of a fixed size.
#pragma once

#include <optional>

#include <Eigen/Core>

#include <waymark/core/base/export.hpp>

namespace WAYMARK_EXPORT waymark {

/// A = V diag(values) V^T.
struct SymmetricEigen {
  Eigen::VectorXd values;   ///< n, in increasing order
  Eigen::MatrixXd vectors;  ///< n x n; column i is the unit eigenvector of values[i]
};

/// Decomposes a symmetric matrix, n x n with n >= 1. Reads the lower triangle only.
[[nodiscard]] SymmetricEigen symmetric_eigen(const Eigen::MatrixXd& matrix);

/// Returns the n eigenvalues of a symmetric matrix in increasing order, n >= 1. Reads the lower
/// triangle only.
[[nodiscard]] Eigen::VectorXd symmetric_eigenvalues(const Eigen::MatrixXd& matrix);

/// Tells whether the smallest eigenvalue is at least -1e-9 times the largest, n >= 1. Zeros are legal: in an
/// information matrix they mean no information on an axis.
[[nodiscard]] bool is_positive_semidefinite(const Eigen::MatrixXd& matrix);

/// A = U diag(values) V^T.
struct SingularValues {
  Eigen::VectorXd values;  ///< k = min(m, n), in decreasing order
  Eigen::MatrixXd left;    ///< m x k; column i is the unit vector u_i, unless values[i] is about 0
  Eigen::MatrixXd right;   ///< n x k; the same of v_i
};

/// Decomposes any matrix, m x n with m, n >= 1. A value is right to rounding of the largest one.
[[nodiscard]] SingularValues singular_values(const Eigen::MatrixXd& matrix);

/// Inverts a symmetric matrix by Cholesky's method. The inverse is exactly symmetric.
/// @return nothing if the matrix is not positive definite or its inverse is not finite
[[nodiscard]] std::optional<Eigen::MatrixXd> inverse_of_positive_definite(const Eigen::MatrixXd& matrix);

}  // namespace waymark
