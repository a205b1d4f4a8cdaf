#include <waymark/tools/live/learning/noise_ahead.hpp>

#include <algorithm>

#include <waymark/core/linear/dense_decompositions.hpp>
#include <waymark/tools/drive/estimation/noise_objective.hpp>

namespace waymark::live {

// In coordinates of the priors (deviation 1), along each principal axis of what the drive tells: information j
// of the likelihood becomes that of a mean over the minutes, 1 / (1 / j + variance / minutes). Noise that is
// larger than its prior expects is taken as it is: to take it for smaller would be no caution.
drive::NoiseEstimate noise_ahead(drive::NoiseEstimate noise, double length_s) {
  constexpr double kVariance = 1.5;  // from minute to minute; MEASUREMENTS.md
  const auto size = static_cast<Eigen::Index>(noise.parameters.size());
  if (size == 0 || noise.curvature.rows() != size) return noise;
  const double most = length_s / 60 / kVariance;
  const Eigen::MatrixXd told = noise.curvature - Eigen::MatrixXd::Identity(size, size);
  const SymmetricEigen axes = symmetric_eigen(0.5 * (told + told.transpose()));
  Eigen::VectorXd along = axes.vectors.transpose() * drive::coordinates_of(noise);
  for (Eigen::Index i = 0; i < size; ++i) {
    const double information = std::max(0.0, axes.values[i]);
    const double less = information * most / (information + most);
    along[i] *= (1 + information) / (1 + less) * most / (information + most);
  }
  const Eigen::VectorXd told_by_all = drive::coordinates_of(noise);
  Eigen::VectorXd at = axes.vectors * along;
  for (Eigen::Index i = 0; i < size; ++i)
    if (!noise.parameters[static_cast<std::size_t>(i)].prior.linear) at[i] = std::max(at[i], told_by_all[i]);
  drive::place_at(at, noise);
  return noise;
}

}  // namespace waymark::live
