/// The square root of an information matrix, which need not have full rank.
#pragma once

#include <Eigen/Core>

namespace waymark {

/// A direction counts as unknown if it holds less than this share of the largest information of an
/// unknown (H_ii). Sums of products are accurate only to 1e-16 and a few additions.
inline constexpr double kInformationResolution = 1e-13;

/// Returns A with A^T A = information. It has as many rows as the rank, so none for a zero matrix.
/// All unknowns are first brought to one scale. Directions with less than kInformationResolution
/// are then rounding, and are left out.
/// @param information symmetric, and positive semidefinite up to rounding
[[nodiscard]] Eigen::MatrixXd information_root(const Eigen::MatrixXd& information);

}  // namespace waymark
