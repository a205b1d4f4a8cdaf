#include <cmath>
#include <random>
#include <vector>

#include <catch2/catch.hpp>

#include <waymark/tools/evaluation/numbers/innovation.hpp>

namespace innovation_test {

using namespace waymark;
using namespace waymark::evaluation;

namespace {

Eigen::Matrix2d matrix(double xx, double xy, double yy) {
  Eigen::Matrix2d m;
  m << xx, xy, xy, yy;
  return m;
}

/// A draw from N(0, covariance).
Eigen::Vector2d draw(std::mt19937_64& random, const Eigen::Matrix2d& covariance) {
  std::normal_distribution<double> normal;
  const double a = normal(random);
  const double b = normal(random);
  const double l11 = std::sqrt(covariance(0, 0));
  const double l21 = covariance(0, 1) / l11;
  return {l11 * a, l21 * a + std::sqrt(covariance(1, 1) - l21 * l21) * b};
}

}  // namespace

TEST_CASE("innovation: nu of known residuals is as by hand") {
  CHECK(normalised_innovation_squared({3, 4}, Eigen::Matrix2d::Identity()) == Approx(25));
  CHECK(normalised_innovation_squared({2, 3}, matrix(4, 0, 9)) == Approx(2));
  // S = [2 1; 1 2], S^-1 = [2 -1; -1 2] / 3: (1, 1) -> 2/3, (1, -1) -> 2
  CHECK(normalised_innovation_squared({1, 1}, matrix(2, 1, 2)) == Approx(2.0 / 3.0));
  CHECK(normalised_innovation_squared({1, -1}, matrix(2, 1, 2)) == Approx(2));
}

TEST_CASE("innovation: nu is undefined for a covariance that is none") {
  CHECK(std::isnan(normalised_innovation_squared({1, 1}, Eigen::Matrix2d::Zero())));
  CHECK(std::isnan(normalised_innovation_squared({1, 1}, matrix(1, 1, 1))));  // singular
  CHECK(std::isnan(normalised_innovation_squared({1, 1}, matrix(1, 2, 1))));  // indefinite
  CHECK(std::isnan(normalised_innovation_squared({1, 1}, matrix(-1, 0, 1))));
  CHECK(std::isnan(normalised_innovation_squared({1, 1}, matrix(std::nan(""), 0, 1))));
  CHECK(std::isnan(normalised_innovation_squared({INFINITY, 1}, Eigen::Matrix2d::Identity())));
}

TEST_CASE("innovation: statistics count, average and leave out what is undefined") {
  const std::vector<double> nu{1, 5.99, 6.0, kUndefined, 11.01};
  const InnovationStatistics s = innovation_statistics(ResidualKind::gated, nu);
  CHECK(s.kind == ResidualKind::gated);
  CHECK(s.count == 4);
  CHECK(s.undefined == 1);
  CHECK(s.mean == Approx(6));
  CHECK(s.fraction_inside == 0.5);  // the bound is 5.991
  CHECK(s.max == 11.01);
  CHECK(s.expected_deviation == Approx(1));  // 2 / sqrt(4)
  const InnovationStatistics none = innovation_statistics(ResidualKind::prediction, {});
  CHECK(none.count == 0);
  CHECK(std::isnan(none.mean));
  CHECK(std::isnan(none.fraction_inside));
}

TEST_CASE("innovation: the bound is the 95 % quantile of chi2 with two degrees of freedom") {
  CHECK(1 - std::exp(-InnovationStatistics::kBound95 / 2) == Approx(0.95).epsilon(1e-12));
}

TEST_CASE("innovation: with true covariances the mean of nu is 2 and 95 % are inside") {
  std::mt19937_64 random(7);
  const Eigen::Matrix2d fix = matrix(4, 1.5, 1);
  const Eigen::Matrix2d pose = matrix(0.5, -0.2, 0.8);
  std::vector<double> nu;
  std::vector<double> pose_forgotten;
  for (int i = 0; i < 20000; ++i) {
    const Eigen::Vector2d residual = draw(random, fix) - draw(random, pose);
    nu.push_back(
        normalised_innovation_squared(residual, residual_covariance(ResidualKind::prediction, fix, &pose)));
    pose_forgotten.push_back(
        normalised_innovation_squared(residual, residual_covariance(ResidualKind::prediction, fix, nullptr)));
  }
  const InnovationStatistics s = innovation_statistics(ResidualKind::prediction, nu);
  CHECK(std::abs(s.mean - 2) < 4 * s.expected_deviation);
  CHECK(std::abs(s.fraction_inside - 0.95) < 4 * std::sqrt(0.95 * 0.05 / 20000));
  const InnovationStatistics without = innovation_statistics(ResidualKind::prediction, pose_forgotten);
  CHECK(without.mean > 2 + 10 * without.expected_deviation);
}

TEST_CASE("innovation: post-fit residuals are smaller than the noise: R - P makes them consistent") {
  // The best estimate of a constant from n readings is their mean, P = R / n.
  std::mt19937_64 random(11);
  const Eigen::Matrix2d fix = matrix(1, 0.3, 2);
  constexpr int kReadings = 4;
  const Eigen::Matrix2d pose = fix / kReadings;
  std::vector<double> with_pose;
  std::vector<double> without_pose;
  for (int run = 0; run < 20000; ++run) {
    Eigen::Vector2d first = Eigen::Vector2d::Zero();
    Eigen::Vector2d mean = Eigen::Vector2d::Zero();
    for (int i = 0; i < kReadings; ++i) {
      const Eigen::Vector2d reading = draw(random, fix);
      if (i == 0) first = reading;
      mean += reading / kReadings;
    }
    const Eigen::Vector2d residual = first - mean;
    with_pose.push_back(
        normalised_innovation_squared(residual, residual_covariance(ResidualKind::post_fit, fix, &pose)));
    without_pose.push_back(
        normalised_innovation_squared(residual, residual_covariance(ResidualKind::post_fit, fix, nullptr)));
  }
  const InnovationStatistics consistent = innovation_statistics(ResidualKind::post_fit, with_pose);
  CHECK(std::abs(consistent.mean - 2) < 4 * consistent.expected_deviation);
  const InnovationStatistics small = innovation_statistics(ResidualKind::post_fit, without_pose);
  CHECK(small.mean == Approx(2 * (1 - 1.0 / kReadings)).epsilon(0.03));
}

}  // namespace innovation_test
