#include <waymark/tools/live/learning/noise_ahead.hpp>

#include <algorithm>
#include <cmath>

#include <waymark/core/linear/dense_decompositions.hpp>
#include <waymark/tools/drive/estimation/noise_objective.hpp>

namespace waymark::live {
namespace {

constexpr double kVariance = 1.5;  // from minute to minute, over that of the prior; MEASUREMENTS.md

/// Returns what the likelihood of a drive tells of the next minutes: information j becomes that of a mean over the
/// minutes, 1 / (1 / j + variance / minutes).
double information_ahead(double information, double length_s) {
  const double most = length_s / 60 / kVariance;
  return information * most / (information + most);
}

}  // namespace

// In coordinates of the priors (deviation 1), along each principal axis of what the drive tells. Noise that is
// larger than its prior expects is taken as it is: to take it for smaller would be no caution.
drive::NoiseEstimate noise_ahead(drive::NoiseEstimate noise, double length_s) {
  const auto size = static_cast<Eigen::Index>(noise.parameters.size());
  if (size == 0 || noise.curvature.rows() != size) return noise;
  const Eigen::MatrixXd told = noise.curvature - Eigen::MatrixXd::Identity(size, size);
  const SymmetricEigen axes = symmetric_eigen(0.5 * (told + told.transpose()));
  Eigen::VectorXd along = axes.vectors.transpose() * drive::coordinates_of(noise);
  for (Eigen::Index i = 0; i < size; ++i) {
    const double information = std::max(0.0, axes.values[i]);
    if (information == 0) continue;
    const double less = information_ahead(information, length_s);
    along[i] *= (1 + information) / (1 + less) * less / information;
  }
  const Eigen::VectorXd told_by_all = drive::coordinates_of(noise);
  Eigen::VectorXd at = axes.vectors * along;
  for (Eigen::Index i = 0; i < size; ++i)
    if (!noise.parameters[static_cast<std::size_t>(i)].prior.linear) at[i] = std::max(at[i], told_by_all[i]);
  drive::place_at(at, noise);
  return noise;
}

double deviation_ahead(double deviation, double of_prior, double length_s) {
  const double information = std::max(0.0, std::pow(of_prior / deviation, 2) - 1);
  return of_prior / std::sqrt(1 + information_ahead(information, length_s));
}

}  // namespace waymark::live
