/// The square root of an information matrix that need not have full rank.
#pragma once

#include <Eigen/Core>

namespace waymark {

/// The share of what a matrix holds of an unknown at most (H_ii) below which a direction counts as unknown:
/// numbers of a product of two are only good to 1e-16, and a few additions.
inline constexpr double kInformationResolution = 1e-13;

/// A with A^T A = information: as many rows as the rank, zero of them for a zero matrix. Directions that hold
/// less than kInformationResolution, after all unknowns are brought to one scale, are rounding and left out.
/// @param information symmetric, positive semidefinite but for rounding
[[nodiscard]] Eigen::MatrixXd information_root(const Eigen::MatrixXd& information);

}  // namespace waymark
