// Stated against actual error: NEES, coverage, and how many independent samples they rest on.
#include <cmath>
#include <random>
#include <vector>

#include <Eigen/Cholesky>
#include <catch2/catch.hpp>

#include <waymark/core/base/error.hpp>
#include <waymark/tools/evaluation/evaluation.hpp>
#include <waymark/tools/evaluation/numbers/autocorrelation.hpp>
#include <waymark/tools/evaluation/numbers/consistency.hpp>

namespace evaluation_consistency_test {

using namespace waymark;
using namespace waymark::evaluation;

namespace {

using Errors = std::vector<Eigen::Vector2d>;

std::vector<Stamp> seconds(int n) {
  std::vector<Stamp> stamps;
  for (int i = 0; i < n; ++i) stamps.push_back(Stamp::from_seconds(i));
  return stamps;
}

/// Unit normal deviates, both axes; successive ones correlated by `rho`.
Errors autoregressive(int n, double rho, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  Errors errors;
  for (int i = 0; i < n; ++i) {
    const Eigen::Vector2d fresh(normal(random), normal(random));
    errors.push_back(i == 0 ? fresh
                            : Eigen::Vector2d(rho * errors.back() + std::sqrt(1 - rho * rho) * fresh));
  }
  return errors;
}

std::vector<Eigen::Matrix2d> same(std::size_t n, const Eigen::Matrix2d& covariance) {
  return std::vector<Eigen::Matrix2d>(n, covariance);
}

bool holds(const Interval95& interval, double value) {
  return interval.low <= value && value <= interval.high;
}

}  // namespace

TEST_CASE("consistency: white errors with their own covariance are consistent") {
  constexpr int kEpochs = 4000;
  Eigen::Matrix2d covariance;
  covariance << 4, 1.5, 1.5, 1;
  const Eigen::Matrix2d root = covariance.llt().matrixL();
  Errors errors = autoregressive(kEpochs, 0, 5);
  for (Eigen::Vector2d& error : errors) error = root * error;
  const ConsistencyStatistics s =
      consistency_statistics(seconds(kEpochs), errors, same(errors.size(), covariance));
  CHECK(s.count == kEpochs);
  CHECK(s.undefined == 0);
  CHECK(s.effective_samples > 0.9 * kEpochs);
  // The standard deviation of the mean of n chi2 variables with two degrees of freedom is 2 / sqrt(n).
  CHECK(std::abs(s.nees_mean - 2) < 4 * 2 / std::sqrt(kEpochs));
  CHECK(std::abs(s.coverage - 0.95) < 4 * std::sqrt(0.95 * 0.05 / kEpochs));
  CHECK(s.median_error_ratio == Approx(1).epsilon(0.05));
}

TEST_CASE("consistency: a covariance too small by four gives NEES 8 and half the stated sigma") {
  constexpr int kEpochs = 4000;
  const Errors errors = autoregressive(kEpochs, 0, 6);
  const ConsistencyStatistics s =
      consistency_statistics(seconds(kEpochs), errors, same(errors.size(), Eigen::Matrix2d::Identity() / 4));
  CHECK(s.nees_mean == Approx(8).epsilon(0.07));
  CHECK(s.median_error_ratio == Approx(2).epsilon(0.05));
  // P(4 chi2 <= -2 ln 0.05) = 1 - 0.05^(1/4)
  CHECK(s.coverage == Approx(1 - std::pow(0.05, 0.25)).margin(0.035));
  CHECK_FALSE(holds(s.nees_mean_consistent, s.nees_mean));
  CHECK_FALSE(holds(s.coverage_consistent, s.coverage));
}

TEST_CASE("consistency: a covariance too large by nine is no more consistent than one too small") {
  constexpr int kEpochs = 4000;
  const Errors errors = autoregressive(kEpochs, 0, 6);
  const ConsistencyStatistics s =
      consistency_statistics(seconds(kEpochs), errors, same(errors.size(), 9 * Eigen::Matrix2d::Identity()));
  CHECK(s.nees_mean == Approx(2.0 / 9).epsilon(0.07));
  CHECK(s.median_error_ratio == Approx(1.0 / 3).epsilon(0.05));
  CHECK(s.coverage == 1);  // P(chi2 / 9 > -2 ln 0.05) = 0.05^9
  CHECK_FALSE(holds(s.nees_mean_consistent, s.nees_mean));
  CHECK_FALSE(holds(s.coverage_consistent, s.coverage));
}

TEST_CASE("consistency: autoregressive errors are worth n (1 - rho) / (1 + rho) samples") {
  constexpr int kEpochs = 20000;
  for (const double rho : {0.5, 0.8, 0.95}) {
    const Errors errors = autoregressive(kEpochs, rho, 7);
    INFO("rho " << rho);
    CHECK(effective_sample_size(seconds(kEpochs), errors) ==
          Approx(kEpochs * (1 - rho) / (1 + rho)).epsilon(0.15));
  }
}

TEST_CASE("consistency: errors that alternate are worth no more than their number") {
  constexpr int kEpochs = 2000;
  CHECK(effective_sample_size(seconds(kEpochs), autoregressive(kEpochs, -0.5, 8)) == kEpochs);
}

TEST_CASE("consistency: a bias that lasts the whole drive is one sample") {
  const Errors errors(500, Eigen::Vector2d(2, -1));
  CHECK(effective_sample_size(seconds(500), errors) == Approx(1));
  // Also across a hole in the middle of the drive.
  std::vector<Stamp> stamps = seconds(500);
  for (std::size_t i = 250; i < stamps.size(); ++i) stamps[i].nanoseconds += 300'000'000'000;
  CHECK(effective_sample_size(stamps, errors) == Approx(1).margin(0.01));
}

TEST_CASE("consistency: fixes of several receivers at one epoch are no further samples") {
  constexpr int kEpochs = 2000;
  const Errors once = autoregressive(kEpochs, 0.8, 9);
  Errors errors;
  std::vector<Stamp> stamps;
  for (std::size_t i = 0; i < once.size(); ++i) {
    for (int receiver = 0; receiver < 2; ++receiver) {
      errors.push_back(once[i]);
      stamps.push_back(Stamp::from_seconds(static_cast<double>(i)));
    }
  }
  CHECK(effective_sample_size(stamps, errors) ==
        Approx(effective_sample_size(seconds(kEpochs), once)).epsilon(0.01));
  CHECK(effective_sample_size(std::vector<Stamp>(7), Errors(7, {1, 2})) == 1);
}

TEST_CASE("consistency: few or no errors have as many samples") {
  CHECK(effective_sample_size({}, {}) == 0);
  CHECK(effective_sample_size(seconds(1), Errors{{1, 1}}) == 1);
  CHECK(effective_sample_size(seconds(3), Errors(3, Eigen::Vector2d::Zero())) == 3);
}

TEST_CASE("consistency: autocorrelation of a Gauss-Markov error at uneven stamps is exp(-lag / tau)") {
  // Intervals of 0.7 to 1.3 s with holes; stamps are not in order.
  constexpr double kTau = 30;
  std::mt19937_64 random(10);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform(0.7, 1.3);
  std::vector<Stamp> stamps;
  Errors errors;
  Eigen::Vector2d error(normal(random), normal(random));
  double time = 0;
  for (int i = 0; i < 60000; ++i) {
    const double dt = uniform(random) + (i % 1000 == 999 ? 40 : 0);
    time += dt;
    const double rho = std::exp(-dt / kTau);
    error = rho * error + std::sqrt(1 - rho * rho) * Eigen::Vector2d(normal(random), normal(random));
    stamps.push_back(Stamp::from_seconds(time));
    errors.push_back(Eigen::Vector2d(5, -3) + 2 * error);  // the mean does not count
  }
  std::swap(stamps[10], stamps[20]);
  std::swap(errors[10], errors[20]);
  const std::vector<double> rho = error_autocorrelation(stamps, errors, kAutocorrelationLags);
  REQUIRE(rho.size() == 3);
  // About 60000 s / 2 tau = 1000 independent samples of each axis.
  CHECK(rho[0] == Approx(std::exp(-1 / kTau)).margin(0.01));
  CHECK(rho[1] == Approx(std::exp(-10 / kTau)).margin(0.04));
  CHECK(rho[2] == Approx(std::exp(-60 / kTau)).margin(0.09));
}

TEST_CASE("consistency: autocorrelation is undefined where there is no pair or no change") {
  const std::vector<double> lags{1, 100};
  const auto of_ten = error_autocorrelation(seconds(10), autoregressive(10, 0, 11), lags);
  CHECK(std::isfinite(of_ten[0]));
  CHECK(std::isnan(of_ten[1]));
  CHECK(std::isnan(error_autocorrelation(seconds(10), Errors(10, {3, 4}), lags)[0]));
  CHECK(std::isnan(error_autocorrelation({}, {}, lags)[0]));
}

TEST_CASE("consistency: intervals of a consistent covariance") {
  // chi2 with two degrees of freedom: quantile p is -2 ln(1 - p).
  CHECK(consistent_nees_mean(1).low == Approx(-2 * std::log(0.975)));
  CHECK(consistent_nees_mean(1).high == Approx(-2 * std::log(0.025)));
  // Published: chi2 with 20 degrees of freedom has 9.591 and 34.170.
  CHECK(consistent_nees_mean(10).low == Approx(0.9591).epsilon(1e-4));
  CHECK(consistent_nees_mean(10).high == Approx(3.4170).epsilon(1e-4));
  // Both sides of the change of method: the normal limit 2 +- 1.96 * 2 / sqrt(n), to its skewness.
  for (const double n : {299.0, 301.0, 10000.0}) {
    CHECK(consistent_nees_mean(n).low == Approx(2 - 1.96 * 2 / std::sqrt(n)).margin(4 / n));
    CHECK(consistent_nees_mean(n).high == Approx(2 + 1.96 * 2 / std::sqrt(n)).margin(4 / n));
  }
  CHECK(consistent_nees_mean(300).high == Approx(consistent_nees_mean(300.5).high).epsilon(2e-4));

  CHECK(consistent_coverage(1).low == 0);  // it misses once in twenty
  CHECK(consistent_coverage(1).high == 1);
  // Of five, 0.0226 lie at three or fewer: 0.95^5 = 0.7738, 5 0.05 0.95^4 = 0.2036.
  CHECK(consistent_coverage(5).low == Approx(0.8));
  CHECK(consistent_coverage(5).high == 1);
  CHECK(consistent_coverage(10000).low == Approx(0.95 - 1.96 * std::sqrt(0.95 * 0.05 / 10000)).margin(2e-4));
  CHECK(consistent_coverage(10000).high == Approx(0.95 + 1.96 * std::sqrt(0.95 * 0.05 / 10000)).margin(2e-4));
}

TEST_CASE(
    "consistency: the intervals hold for consistent covariances of correlated errors and drive biases") {
  // 15 minutes with tau = 30 s and a bias drawn for each drive; the covariance states both.
  constexpr int kDrives = 300;
  constexpr int kEpochs = 900;
  std::mt19937_64 random(12);
  std::normal_distribution<double> normal;
  for (const double bias_sigma : {0.0, 0.7, 3.0}) {
    int nees_inside = 0;
    int coverage_inside = 0;
    for (int drive = 0; drive < kDrives; ++drive) {
      Errors errors = autoregressive(kEpochs, std::exp(-1.0 / 30), 1000 + static_cast<std::uint64_t>(drive));
      const Eigen::Vector2d bias(bias_sigma * normal(random), bias_sigma * normal(random));
      for (Eigen::Vector2d& error : errors) error += bias;
      const Eigen::Matrix2d covariance = (1 + bias_sigma * bias_sigma) * Eigen::Matrix2d::Identity();
      const ConsistencyStatistics s =
          consistency_statistics(seconds(kEpochs), errors, same(errors.size(), covariance));
      nees_inside += holds(s.nees_mean_consistent, s.nees_mean) ? 1 : 0;
      coverage_inside += holds(s.coverage_consistent, s.coverage) ? 1 : 0;
    }
    INFO("bias " << bias_sigma);
    // The sample size is estimated from the drive itself. One whose bias happens to be small beside its prior
    // does not show that it is one sample: if biases dominate, the interval of the mean holds less often.
    const double share = bias_sigma > 1 ? 0.9 : 0.95;
    const double three_sigma = 3 * std::sqrt(0.95 * 0.05 / kDrives);
    CHECK(nees_inside > (share - three_sigma) * kDrives);
    CHECK(coverage_inside > (0.95 - three_sigma) * kDrives);
  }
}

TEST_CASE("consistency: epochs without a covariance are counted and left out") {
  const Errors errors{{1, 0}, {0, 1}, {1, 1}};
  std::vector<Eigen::Matrix2d> covariances = same(3, Eigen::Matrix2d::Identity());
  covariances[1].setZero();
  const ConsistencyStatistics s = consistency_statistics(seconds(3), errors, covariances);
  CHECK(s.count == 2);
  CHECK(s.undefined == 1);
  CHECK(s.nees_mean == Approx(1.5));
  const ConsistencyStatistics none =
      consistency_statistics(seconds(3), errors, same(3, Eigen::Matrix2d::Zero()));
  CHECK(none.count == 0);
  CHECK(std::isnan(none.nees_mean));
  CHECK_THROWS_AS(consistency_statistics(seconds(2), errors, covariances), UsageError);
}

TEST_CASE("consistency: evaluate compares stated and actual error where covariances are given") {
  EvaluationInput input;
  for (int i = 0; i < 3; ++i) {
    Fix fix;
    fix.stamp = Stamp::from_seconds(i);
    fix.position = {10.0 * i, 5};
    input.fixes.push_back(fix);
    input.fused.push_back({.stamp = fix.stamp, .pose = {10.0 * i, 3, 0}});
    input.truth.push_back({.stamp = fix.stamp, .position = {10.0 * i, 0}, .heading_rad = 0.0});
  }
  CHECK_FALSE(evaluate(input).truth->consistency);
  input.position_covariances.assign(3, Eigen::Vector2d(1, 4.5).asDiagonal());
  const Evaluation e = evaluate(input);
  REQUIRE(e.truth->consistency);
  CHECK(e.truth->consistency->nees_mean == Approx(2));  // 3^2 / 4.5
  CHECK(e.truth->consistency->effective_samples == Approx(1));
  CHECK(e.truth->gnss_autocorrelation.size() == kAutocorrelationLags.size());
}

}  // namespace evaluation_consistency_test
