#include <waymark/tools/evaluation/numbers/consistency.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include <fmt/format.h>

#include <waymark/core/base/error.hpp>
#include <waymark/core/robust/chi_square.hpp>
#include <waymark/tools/evaluation/numbers/autocorrelation.hpp>
#include <waymark/tools/evaluation/numbers/innovation.hpp>

namespace waymark::evaluation {
namespace {

constexpr double kTail = 0.025;            // on each side of an interval
constexpr double kNormal = 1.95996398454;  // quantile of the normal distribution at 1 - kTail

/// The sum in chi_square_quantile has a term for every second degree of freedom. From about 600 on the cube root
/// of Wilson and Hilferty is right to six digits, at once.
double two_sided_chi_square(int freedom, bool upper) {
  if (freedom <= 600) return chi_square_quantile(upper ? 1 - kTail : kTail, freedom);
  const double spread = 2.0 / (9.0 * freedom);
  return freedom * std::pow(1 - spread + (upper ? kNormal : -kNormal) * std::sqrt(spread), 3);
}

/// Returns the smallest k with P(X <= k) >= probability, for a binomial X.
long binomial_quantile(double probability, long trials, double success) {
  double log_chance = static_cast<double>(trials) * std::log1p(-success);  // of k = 0
  double sum = std::exp(log_chance);
  long k = 0;
  while (sum < probability && k < trials) {
    ++k;
    log_chance += std::log(static_cast<double>(trials - k + 1) / static_cast<double>(k)) +
                  std::log(success / (1 - success));
    sum += std::exp(log_chance);
  }
  return k;
}

/// Returns the error in sigmas: L^-1 d with P = L L^T.
std::optional<Eigen::Vector2d> in_sigmas(const Eigen::Vector2d& offset, const Eigen::Matrix2d& covariance) {
  if (std::isnan(normalised_innovation_squared(offset, covariance))) return std::nullopt;
  const double l11 = std::sqrt(covariance(0, 0));
  const double l21 = 0.5 * (covariance(0, 1) + covariance(1, 0)) / l11;
  const double l22 = std::sqrt(covariance(1, 1) - l21 * l21);
  const double x = offset.x() / l11;
  return Eigen::Vector2d(x, (offset.y() - l21 * x) / l22);
}

}  // namespace

Interval95 consistent_nees_mean(double effective_samples) {
  const int freedom = static_cast<int>(std::lround(2 * effective_samples));
  const double samples = 0.5 * freedom;
  return {two_sided_chi_square(freedom, false) / samples, two_sided_chi_square(freedom, true) / samples};
}

Interval95 consistent_coverage(double effective_samples) {
  constexpr double kInside = ConsistencyStatistics::kExpectedCoverage;
  const long trials = std::lround(effective_samples);
  const auto share = [&](long k) { return static_cast<double>(k) / static_cast<double>(trials); };
  return {share(binomial_quantile(kTail, trials, kInside)),
          share(binomial_quantile(1 - kTail, trials, kInside))};
}

ConsistencyStatistics consistency_statistics(std::span<const Stamp> stamps,
                                             std::span<const Eigen::Vector2d> offsets,
                                             std::span<const Eigen::Matrix2d> covariances) {
  if (stamps.size() != offsets.size() || covariances.size() != offsets.size())
    throw UsageError(fmt::format("consistency: {} stamps, {} errors, {} covariances", stamps.size(),
                                 offsets.size(), covariances.size()));
  ConsistencyStatistics statistics;
  std::vector<Stamp> used;
  std::vector<Eigen::Vector2d> errors;
  std::vector<double> nees;
  std::size_t inside = 0;
  double sum = 0;
  for (std::size_t i = 0; i < offsets.size(); ++i) {
    const std::optional<Eigen::Vector2d> error = in_sigmas(offsets[i], covariances[i]);
    if (!error) continue;
    used.push_back(stamps[i]);
    errors.push_back(*error);
    nees.push_back(error->squaredNorm());
    sum += nees.back();
    if (nees.back() <= InnovationStatistics::kBound95) ++inside;
  }
  statistics.count = nees.size();
  statistics.undefined = offsets.size() - nees.size();
  if (nees.empty()) return statistics;
  const auto n = static_cast<double>(nees.size());
  statistics.nees_mean = sum / n;
  statistics.coverage = static_cast<double>(inside) / n;
  constexpr double kMedianNees = 2 * std::numbers::ln2;
  std::sort(nees.begin(), nees.end());
  statistics.median_error_ratio = std::sqrt(sorted_median(nees) / kMedianNees);
  statistics.effective_samples = effective_sample_size(used, errors);
  statistics.nees_mean_consistent = consistent_nees_mean(statistics.effective_samples);
  statistics.coverage_consistent = consistent_coverage(statistics.effective_samples);
  return statistics;
}

}  // namespace waymark::evaluation
