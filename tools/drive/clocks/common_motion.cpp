#include <waymark/tools/drive/clocks/common_motion.hpp>

#include <algorithm>
#include <cmath>

namespace waymark::drive {
namespace {

constexpr int kSteps = 4;          // to the line whose residuals are autoregressive
constexpr double kPerfect = 2e-6;  // the logarithm stays finite
constexpr double kMostLasting = 0.99;

// Covariances are of: odometry, gnss, and both of the pair before.

/// Returns the variance of what is new in the residuals of a line. @param r their autocorrelation
double innovation(const Eigen::Matrix4d& covariance, double slope, double r) {
  const Eigen::Vector4d weights(-slope, 1, r * slope, -r);
  return weights.dot(covariance * weights);
}

double autocorrelation(const Eigen::Matrix4d& covariance, double slope) {
  const Eigen::Vector4d residual(-slope, 1, 0, 0);
  const Eigen::Vector4d before(0, 0, -slope, 1);
  const double variance = before.dot(covariance * before);
  if (!(variance > 0)) return 0;
  return std::clamp(residual.dot(covariance * before) / variance, -kMostLasting, kMostLasting);
}

/// Returns the slope of least innovations.
double slope_at(const Eigen::Matrix4d& covariance, double r) {
  const Eigen::Vector4d odometry(1, 0, -r, 0);
  const Eigen::Vector4d gnss(0, 1, 0, -r);
  const double variance = odometry.dot(covariance * odometry);
  return variance > 0 ? odometry.dot(covariance * gnss) / variance : 0;
}

}  // namespace

template <int size>
void CommonMotion::Sums<size>::add(const Eigen::Matrix<double, size, 1>& values) {
  ++count;
  sum += values;
  products += values * values.transpose();
}

template <int size>
Eigen::Matrix<double, size, size> CommonMotion::Sums<size>::covariance() const {
  const double n = std::max(1.0, static_cast<double>(count));
  return products / n - sum * sum.transpose() / (n * n);
}

void CommonMotion::add(double odometry, double gnss, bool follows) {
  const Eigen::Vector2d pair(odometry, gnss);
  pairs_.add(pair);
  if (follows) next_.add({odometry, gnss, last_[0], last_[1]});
  last_ = pair;
}

double CommonMotion::correlation() const {
  const Eigen::Matrix2d covariance = pairs_.covariance();
  const double variances = covariance(0, 0) * covariance(1, 1);
  return variances > 0 ? covariance(0, 1) / std::sqrt(variances) : 0;
}

double CommonMotion::score() const {
  const Eigen::Matrix4d covariance = next_.covariance();
  const double alone = innovation(covariance, 0, autocorrelation(covariance, 0));
  double r = 0;
  double slope = slope_at(covariance, r);
  for (int i = 0; i < kSteps; ++i) {
    r = autocorrelation(covariance, slope);
    slope = slope_at(covariance, r);
  }
  if (!(slope > 0) || !(alone > 0)) return 0;
  const double share = std::max(innovation(covariance, slope, r) / alone, kPerfect);
  return std::max(0.0, -0.5 * static_cast<double>(next_.count) * std::log(share));
}

}  // namespace waymark::drive
