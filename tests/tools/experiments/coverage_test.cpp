// Are the stated covariances as large as the errors, neither smaller nor larger? Simulated drives give as
// many independent errors as the question needs: one of each drive, because the errors of one drive have its
// biases in common. A consistent covariance holds its error with the nominal probability p, so the number of
// drives that it holds is binomial with n trials and probability p. Counts beyond the quantiles 1e-4 and
// 1 - 1e-4 of that distribution fail. The ellipses of 68 % and of 95 % are counted: the smaller one finds
// covariances that are too large with few drives, because 95 % are bounded by 100 % too closely.
#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <string>
#include <vector>

#include <Eigen/Cholesky>
#include <catch2/catch.hpp>

#include <waymark/tools/drive/model/fuse.hpp>
#include <waymark/tools/drive/model/poses_at_fixes.hpp>
#include <waymark/tools/evaluation/evaluation.hpp>
#include <waymark/tools/simulation/simulation.hpp>

#include "support/registry.hpp"
#include "tools/experiments/simulated.hpp"

namespace coverage_test {

using namespace waymark;
using namespace waymark::drive;
using namespace waymark::simulation;

namespace {

constexpr double kTail = 1e-4;
constexpr double kShares[] = {0.68, 0.95};

/// The number of drives, of n, whose error a consistent ellipse of probability p holds.
struct Counts {
  int least = 0;
  int most = 0;
};

/// Exact binomial quantiles: P(count < least) <= kTail and P(count > most) <= kTail.
Counts consistent_counts(int n, double p) {
  std::vector<double> probability;
  for (int k = 0; k <= n; ++k)
    probability.push_back(std::exp(std::lgamma(n + 1.0) - std::lgamma(k + 1.0) - std::lgamma(n - k + 1.0) +
                                   k * std::log(p) + (n - k) * std::log1p(-p)));
  Counts counts{0, n};
  for (double tail = probability.front(); tail <= kTail; tail += probability[std::size_t(counts.least)])
    ++counts.least;
  for (double tail = probability.back(); tail <= kTail; tail += probability[std::size_t(counts.most)])
    --counts.most;
  return counts;
}

/// NEES = d^T P^-1 d of one error of each drive.
using NeesOfDrives = std::vector<double>;

/// P(NEES <= -2 ln(1 - p)) = p for two normal errors with their own covariance.
int inside(const NeesOfDrives& nees, double p) {
  return static_cast<int>(
      std::count_if(nees.begin(), nees.end(), [p](double of) { return of <= -2 * std::log1p(-p); }));
}

bool consistent(const NeesOfDrives& nees) {
  return std::all_of(std::begin(kShares), std::end(kShares), [&](double p) {
    const Counts counts = consistent_counts(static_cast<int>(nees.size()), p);
    const int held = inside(nees, p);
    return counts.least <= held && held <= counts.most;
  });
}

/// An error of a fused position with its stated covariance.
struct StatedError {
  Eigen::Vector2d offset_m;
  Eigen::Matrix2d covariance;
};

NeesOfDrives nees_of(const std::vector<StatedError>& errors, double covariance_factor) {
  NeesOfDrives nees;
  for (const StatedError& error : errors) {
    const Eigen::Matrix2d covariance = covariance_factor * error.covariance;
    nees.push_back(error.offset_m.dot(covariance.llt().solve(error.offset_m)));
  }
  return nees;
}

/// Fuses a drive and compares it with its exact truth, at the fix in the middle.
StatedError error_in_the_middle(const SimulatedDrive& simulated, const PreparedDrive& drive,
                                FusionSettings settings, const TypeRegistry& registry) {
  settings.minimization.covariances = "fixes";
  const FusedDrive fused = fuse(drive, settings, registry);
  REQUIRE(fused.minimum.summary.converged());
  const formats::GraphDocument& document = fused.model.document;
  evaluation::EvaluationInput input = waymark_test::against_truth(document, simulated);
  for (const auto& covariance : evaluated_covariances(document))
    input.position_covariances.push_back(covariance.value());
  const evaluation::Evaluation result = evaluation::evaluate(input);
  const evaluation::EpochResult& epoch = result.epochs[input.fixes.size() / 2];
  return {epoch.fused_offset_m.value(), epoch.position_covariance.value()};
}

/// Leaves out the first seconds, in which the vehicle stands and gathers speed: a variance per metre is true
/// at one speed only.
void leave_out_start(double seconds, PreparedDrive& drive) {
  const auto early = [begin = drive.odometry.front().stamp, seconds](const auto& sample) {
    return seconds_between(begin, sample.stamp) < seconds;
  };
  std::erase_if(drive.odometry, early);
  std::erase_if(drive.fixes, [&](const Fix& fix) { return fix.stamp < drive.odometry.front().stamp; });
}

/// Checks the errors, and that covariances that are too large or too small by these factors would fail.
void check_covariances(const std::vector<StatedError>& errors, std::initializer_list<double> wrong_factors) {
  const int n = static_cast<int>(errors.size());
  const NeesOfDrives nees = nees_of(errors, 1);
  for (const double p : kShares) {
    const Counts counts = consistent_counts(n, p);
    INFO(inside(nees, p) << " of " << n << " errors lie in their ellipse of " << 100 * p
                         << " %; consistent: " << counts.least << " to " << counts.most);
    CHECK(inside(nees, p) >= counts.least);
    CHECK(inside(nees, p) <= counts.most);
  }
  CHECK(consistent(nees));
  for (const double factor : wrong_factors) {
    INFO("factor " << factor);
    CHECK_FALSE(consistent(nees_of(errors, factor)));
    CHECK_FALSE(consistent(nees_of(errors, 1 / factor)));
  }
}

}  // namespace

TEST_CASE("coverage: the bounds are the quantiles of the binomial distribution") {
  // Its normal limit: n p +- 3.72 sqrt(n p (1 - p)), to the skewness.
  for (const double p : kShares) {
    const Counts counts = consistent_counts(10000, p);
    const double deviation = std::sqrt(10000 * p * (1 - p));
    CHECK(std::abs(counts.least - (10000 * p - 3.719 * deviation)) < 4);
    CHECK(std::abs(counts.most - (10000 * p + 3.719 * deviation)) < 4);
  }
  // 0.68^20 = 4.5e-4, so 20 of 20 may be consistent; 0.68^24 = 9.6e-5, so 24 of 24 may not.
  CHECK(consistent_counts(20, 0.68).most == 20);
  CHECK(consistent_counts(24, 0.68).most == 23);
  CHECK(consistent_counts(40, 0.95).most == 40);
}

TEST_CASE("coverage: with the noise stated truly, covariances are neither too small nor too large") {
  // Readings of 25 Hz with white noise of sigma s sum up to a variance of s^2 / 25 per second. At 20 m/s the
  // variance of the distance is a twentieth of that per metre. The rest of the model's noise is next to none.
  constexpr double kSpeedNoise_mps = 0.5;
  constexpr double kYawNoise_radps = 0.02;
  constexpr double kFixSigma_m = 1.5;
  constexpr std::uint64_t kDrives = 1000;
  SimulationRecipe recipe{.duration_s = 60, .roads = {waymark_test::straight_road()}};
  recipe.odometry = {.speed_noise_mps = kSpeedNoise_mps,
                     .speed_step_mps = 0,
                     .gyro_bias_walk_radps_sqrts = 0,
                     .yaw_rate_noise_radps = kYawNoise_radps,
                     .yaw_rate_step_radps = 0};
  recipe.gnss = {.fast_sigma_m = 0, .jitter_m = kFixSigma_m, .bursts_per_minute = 0};
  FusionSettings settings;
  settings.modeling = "g1";
  settings.gate.enabled = false;
  settings.odometry_options = {
      {"longitudinal_variance_per_m", std::to_string(kSpeedNoise_mps * kSpeedNoise_mps / 25 / 20)},
      {"lateral_variance_per_m", "1e-8"},
      {"position_variance_per_s", "1e-8"},
      {"heading_variance_per_m", "0"},
      {"heading_variance_per_s", std::to_string(kYawNoise_radps * kYawNoise_radps / 25)}};
  const TypeRegistry registry = waymark_test::full_registry();
  std::vector<StatedError> errors;
  for (std::uint64_t seed = 1; seed <= kDrives; ++seed) {
    const SimulatedDrive simulated = simulate(recipe, seed);
    PreparedDrive drive = waymark_test::prepared(simulated);
    leave_out_start(20, drive);
    for (Fix& fix : drive.fixes) fix.covariance = kFixSigma_m * kFixSigma_m * Eigen::Matrix2d::Identity();
    errors.push_back(error_in_the_middle(simulated, drive, settings, registry));
  }
  check_covariances(errors, {1.5, 9});
}

TEST_CASE("coverage: the default model is consistent on simulated drives with biases of its prior") {
  const TypeRegistry registry = waymark_test::full_registry();
  const char* presets[] = {"highway", "urban", "rural", "mixed"};
  std::vector<StatedError> errors;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    const SimulationRecipe recipe = with_duration(simulation_preset(presets[seed % 4]).recipe, 120);
    const SimulatedDrive simulated = simulate(recipe, 2000 + seed);
    errors.push_back(
        error_in_the_middle(simulated, waymark_test::prepared(simulated), FusionSettings(), registry));
  }
  check_covariances(errors, {9});
}

}  // namespace coverage_test
