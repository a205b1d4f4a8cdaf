#include <waymark/tools/drive/estimation/noise_spread.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include <Eigen/Cholesky>

#include <waymark/core/linear/dense_decompositions.hpp>
#include <waymark/types_se2/se2.hpp>

namespace waymark::drive {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

Vector3d difference(const Vector3d& to, const Vector3d& from) {
  return {to.x() - from.x(), to.y() - from.y(), wrap_angle(to.z() - from.z())};
}

Eigen::VectorXd prior_deviations(const NoiseEstimate& noise) {
  Eigen::VectorXd deviations(static_cast<Eigen::Index>(noise.parameters.size()));
  std::transform(noise.parameters.begin(), noise.parameters.end(), deviations.begin(),
                 [](const NoiseParameter& of) { return of.prior.deviation; });
  return deviations;
}

/// Adds what the covariances of the poses would grow by at another noise, with a weight.
void add_growth(const std::vector<PoseBelief>& there, const std::vector<PoseBelief>& here, double weight,
                std::vector<PoseSpread>& spread) {
  if (there.size() != here.size()) return;
  for (std::size_t i = 0; i < here.size(); ++i) {
    const Vector3d moved = difference(there[i].pose, here[i].pose);
    spread[i].covariance += weight * (there[i].covariance + moved * moved.transpose() - here[i].covariance);
  }
}

/// Returns the spread at a time; that of the first or the last time beyond them.
Matrix3d spread_at(Stamp stamp, std::span<const PoseSpread> spread) {
  const auto next = std::lower_bound(spread.begin(), spread.end(), stamp,
                                     [](const PoseSpread& of, Stamp at) { return of.stamp < at; });
  if (next == spread.end()) return spread.back().covariance;
  if (next == spread.begin()) return next->covariance;
  const PoseSpread& before = *(next - 1);
  const double share = seconds_between(before.stamp, stamp) / seconds_between(before.stamp, next->stamp);
  return (1 - share) * before.covariance + share * next->covariance;
}

}  // namespace

std::vector<PoseSpread> spread_over_noise(NoiseObjective& objective, const NoiseEstimate& noise,
                                          const Eigen::MatrixXd& covariance) {
  constexpr double kPoint = std::numbers::sqrt3;
  constexpr double kWeight = 1.0 / 6;
  // Of logarithms. Sigmas that are known to this widen covariances by at most 2 %.
  constexpr double kKnown = 0.1;
  const std::vector<PoseBelief> here = objective.beliefs_at(noise);
  std::vector<PoseSpread> spread;
  spread.reserve(here.size());
  for (const PoseBelief& belief : here) spread.push_back({belief.stamp, Matrix3d::Zero()});
  const SymmetricEigen axes = symmetric_eigen(covariance);
  const Eigen::VectorXd at = coordinates_of(noise);
  const Eigen::VectorXd unit = prior_deviations(noise);
  NoiseEstimate moved = noise;
  for (Eigen::Index axis = 0; axis < at.size(); ++axis) {
    const Eigen::VectorXd deviation = std::sqrt(std::max(0.0, axes.values[axis])) * axes.vectors.col(axis);
    if (deviation.cwiseProduct(unit).norm() < kKnown) continue;
    for (const double side : {-kPoint, kPoint}) {
      place_at(at + side * deviation, moved);
      add_growth(objective.beliefs_at(moved), here, kWeight, spread);
    }
  }
  return spread;
}

void widen(std::vector<formats::VertexCovariance>& covariances, const Graph& graph,
           std::span<const PoseSpread> spread) {
  if (spread.empty()) return;
  for (formats::VertexCovariance& of : covariances) {
    const std::optional<Stamp> stamp = graph.stamp(of.vertex);
    if (!stamp || of.covariance.rows() != 3) continue;
    const Matrix3d widened = of.covariance + spread_at(*stamp, spread);
    if (Eigen::LLT<Matrix3d>(widened).info() == Eigen::Success) of.covariance = widened;
  }
}

}  // namespace waymark::drive
