#include <waymark/tools/drive/estimation/posterior_mode.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <nlopt.h>

#include <waymark/core/linear/dense_decompositions.hpp>

namespace waymark::drive {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kStep = 0.05;        // of the differences in the search
constexpr double kNear = 0.05;        // where the search ends
constexpr int kMostSearchSteps = 20;  // evaluations with derivatives
constexpr int kMostNewtonSteps = 20;
constexpr double kSettled = 5e-5;        // gain of cost, a hundredth of a deviation; its step is still taken
constexpr double kClose = 0.5;           // gain of cost, a deviation: the correlations are kept from there
constexpr double kFar = 2;               // gain of cost, two deviations: a rough curvature leads nearer
constexpr double kSearchShare = 0.5;     // of a deviation, the differences until then
constexpr double kEndShare = 0.1;        // and for the curvature at the end
constexpr double kFalling = 0.2;         // from step to step, or they are found anew
constexpr double kTolerated = 0.02;      // rise of cost in a step, a fifth of a deviation
constexpr double kFirstStep = 0.1;       // of the differences for the first of them
constexpr double kLongestStep = 1.0;     // in deviations of the priors
constexpr double kLeastCurvature = 0.1;  // the prior alone has 1

/// Cost and bounds of the search behind the C interface.
struct Search {
  const PosteriorCost& cost;
  const VectorXd& high;
};

VectorXd with_step(VectorXd at, Index i, double step) {
  at[i] += step;
  return at;
}

/// The cost for NLopt, with differences as its gradient: forward ones, or backward ones at the upper bound.
double evaluate(unsigned size, const double* coordinates, double* gradient, void* data) {
  const Search& search = *static_cast<Search*>(data);
  const VectorXd at = Eigen::Map<const VectorXd>(coordinates, size);
  const double cost = search.cost.at(at);
  if (gradient == nullptr) return cost;
  for (Index i = 0; i < at.size(); ++i) {
    const double step = at[i] + kStep <= search.high[i] ? kStep : -kStep;
    gradient[i] = (search.cost.at(with_step(at, i, step)) - cost) / step;
  }
  return cost;
}

/// The quadratic function through costs about a point within the bounds.
struct Quadratic {
  VectorXd centre;
  double cost = 0;
  VectorXd gradient;
  MatrixXd curvature;

  /// Returns how much higher than at the centre it is at a point.
  [[nodiscard]] double rise_to(const VectorXd& at) const {
    const VectorXd away = at - centre;
    return away.dot(gradient + 0.5 * curvature * away);
  }
};

/// Returns steps that are a share of what each coordinate is known to alone. Far smaller ones see
/// rounding, far larger ones the derivatives of higher order.
VectorXd fitting_steps(const VectorXd& curvature, double share) {
  return (share / curvature.array().max(kLeastCurvature).sqrt()).cwiseMin(share).cwiseMax(0.02);
}

/// How the terms between two coordinates are found.
enum class Mixed {
  known,    ///< from the correlations of a curvature nearby: no costs of their own
  forward,  ///< with one cost each
  central   ///< with two: exact to one order more
};

/// Returns the quadratic through the costs about a point, by central differences.
/// @param correlations for Mixed::known
Quadratic fit_quadratic(const PosteriorCost& cost, const VectorXd& at, const VectorXd& steps,
                        const PosteriorBounds& bounds, Mixed mixed, const MatrixXd& correlations) {
  const Index n = at.size();
  Quadratic fit{at.cwiseMax(bounds.low + steps).cwiseMin(bounds.high - steps), 0, VectorXd(n),
                MatrixXd(n, n)};
  fit.cost = cost.begin_at ? cost.begin_at(fit.centre) : cost.at(fit.centre);
  VectorXd ahead(n);
  VectorXd behind(n);
  for (Index i = 0; i < n; ++i) {
    ahead[i] = cost.at(with_step(fit.centre, i, steps[i])) - fit.cost;
    behind[i] = cost.at(with_step(fit.centre, i, -steps[i])) - fit.cost;
    fit.gradient[i] = (ahead[i] - behind[i]) / (2 * steps[i]);
    fit.curvature(i, i) = (ahead[i] + behind[i]) / (steps[i] * steps[i]);
  }
  if (mixed == Mixed::known) {
    const VectorXd scale = fit.curvature.diagonal().cwiseMax(kLeastCurvature).cwiseSqrt();
    fit.curvature = scale.asDiagonal() * correlations * scale.asDiagonal();
    return fit;
  }
  for (Index i = 0; i < n; ++i) {
    for (Index j = 0; j < i; ++j) {
      const auto along_both = [&](double share) {
        return cost.at(with_step(with_step(fit.centre, i, share * steps[i]), j, share * steps[j])) - fit.cost;
      };
      double product = along_both(1) - ahead[i] - ahead[j];
      if (mixed == Mixed::central) product = 0.5 * (product + along_both(-1) - behind[i] - behind[j]);
      fit.curvature(i, j) = product / (steps[i] * steps[j]);
      fit.curvature(j, i) = fit.curvature(i, j);
    }
  }
  return fit;
}

/// Returns a curvature scaled to ones on its diagonal.
MatrixXd correlations_of(const MatrixXd& curvature) {
  const VectorXd scale = curvature.diagonal().cwiseMax(kLeastCurvature).cwiseSqrt().cwiseInverse();
  return scale.asDiagonal() * curvature * scale.asDiagonal();
}

/// Returns the inverse, with the curvature made positive where rounding or a saddle has left none.
MatrixXd covariance_of(const MatrixXd& curvature) {
  const auto [values, vectors] = symmetric_eigen(curvature);
  return vectors * values.cwiseAbs().cwiseMax(kLeastCurvature).cwiseInverse().asDiagonal() *
         vectors.transpose();
}

/// Returns the least point of the quadratic between the bounds. Coordinates that it pushes over a
/// bound are held there one after the other.
VectorXd least_point(const Quadratic& fit, const PosteriorBounds& bounds) {
  const auto& [low, high] = bounds;
  std::vector<Index> free;
  for (Index i = 0; i < fit.centre.size(); ++i) free.push_back(i);
  VectorXd at = fit.centre;
  while (!free.empty()) {
    const VectorXd away = at - fit.centre;
    const VectorXd slope = fit.gradient + fit.curvature * away;
    const VectorXd step = -covariance_of(fit.curvature(free, free)) * slope(free);
    Index worst = -1;
    double most = 0;
    for (Index k = 0; k < step.size(); ++k) {
      const Index i = free[static_cast<std::size_t>(k)];
      const double over = std::max(at[i] + step[k] - high[i], low[i] - at[i] - step[k]);
      if (over > most) {
        most = over;
        worst = k;
      }
    }
    if (worst < 0) {
      for (Index k = 0; k < step.size(); ++k) at[free[static_cast<std::size_t>(k)]] += step[k];
      break;
    }
    const Index held = free[static_cast<std::size_t>(worst)];
    at[held] = at[held] + step[worst] > high[held] ? high[held] : low[held];
    free.erase(free.begin() + worst);
  }
  return at;
}

/// Returns the share of a step at which the cost does not rise: the step may leave the region
/// where the quadratic fits. Close to the mode a rise is the difference between the cost and its
/// quadratic over the width of the steps, and no reason to halt.
double descending(const PosteriorCost& cost, const Quadratic& fit, const VectorXd& step) {
  constexpr double kLeastShare = 0.05;
  double share = std::min(1.0, kLongestStep / std::max(step.cwiseAbs().maxCoeff(), 1e-12));
  while (share > kLeastShare && cost.at(fit.centre + share * step) > fit.cost + kTolerated) share *= 0.4;
  return share;
}

}  // namespace

VectorXd search_posterior(const PosteriorCost& cost, const VectorXd& start, const PosteriorBounds& bounds) {
  VectorXd at = start;
  Search search{cost, bounds.high};
  nlopt_opt slsqp = nlopt_create(NLOPT_LD_SLSQP, static_cast<unsigned>(at.size()));
  nlopt_set_min_objective(slsqp, evaluate, &search);
  nlopt_set_lower_bounds(slsqp, bounds.low.data());
  nlopt_set_upper_bounds(slsqp, bounds.high.data());
  nlopt_set_xtol_abs1(slsqp, kNear);
  nlopt_set_maxeval(slsqp, kMostSearchSteps);
  double least = 0;
  nlopt_optimize(slsqp, at.data(), &least);  // its best values stand whatever ends it
  nlopt_destroy(slsqp);
  return at.cwiseMax(bounds.low).cwiseMin(bounds.high);
}

PosteriorMode find_posterior_mode(const PosteriorCost& cost, const VectorXd& near,
                                  const PosteriorBounds& bounds) {
  const VectorXd longest = 0.25 * (bounds.high - bounds.low);
  VectorXd steps = longest.cwiseMin(kFirstStep);
  PosteriorMode mode{near, {}};
  MatrixXd correlations;
  double gain_before = std::numeric_limits<double>::max();
  for (int i = 0; i < kMostNewtonSteps; ++i) {
    Mixed mixed = gain_before > kFar ? Mixed::forward : Mixed::central;
    if (correlations.size() > 0) mixed = Mixed::known;
    const Quadratic fit = fit_quadratic(cost, mode.at, steps, bounds, mixed, correlations);
    const VectorXd least = least_point(fit, bounds);
    const double gain = fit.rise_to(mode.at) - fit.rise_to(least);
    if (gain < kSettled) {
      mode.at = least;
      break;
    }
    const VectorXd step = least - fit.centre;
    mode.at = fit.centre + descending(cost, fit, step) * step;
    steps = fitting_steps(fit.curvature.diagonal(), kSearchShare).cwiseMin(longest);
    const bool converging = gain < kClose && gain < kFalling * gain_before;
    correlations = converging ? correlations_of(fit.curvature) : MatrixXd();
    gain_before = gain;
  }
  const VectorXd fine = steps * (kEndShare / kSearchShare);
  mode.covariance = covariance_of(fit_quadratic(cost, mode.at, fine, bounds, Mixed::central, {}).curvature);
  return mode;
}

}  // namespace waymark::drive
