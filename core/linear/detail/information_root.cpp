#include <waymark/core/linear/dense_decompositions.hpp>
#include <waymark/core/linear/detail/information_root.hpp>

namespace waymark {

// With D the diagonal and D^-1/2 Omega D^-1/2 = V W V^T, A = W^1/2 V^T D^1/2. Metres, radians and
// scale factors are then not compared with each other.
Eigen::MatrixXd information_root(const Eigen::MatrixXd& information) {
  const Eigen::Index n = information.rows();
  const Eigen::VectorXd scale = information.diagonal().cwiseMax(0).cwiseSqrt();
  Eigen::MatrixXd scaled = Eigen::MatrixXd::Zero(n, n);
  for (Eigen::Index c = 0; c < n; ++c) {
    for (Eigen::Index r = 0; r < n; ++r) {
      if (scale[r] > 0 && scale[c] > 0) scaled(r, c) = information(r, c) / (scale[r] * scale[c]);
    }
  }
  const auto [eigenvalues, eigenvectors] = symmetric_eigen(scaled);
  Eigen::Index first = 0;
  while (first < n && !(eigenvalues[first] > kInformationResolution)) ++first;
  return eigenvalues.tail(n - first).cwiseSqrt().asDiagonal() *
         eigenvectors.rightCols(n - first).transpose() * scale.asDiagonal();
}

}  // namespace waymark
