#include <waymark/tools/drive/estimation/posterior_mode.hpp>

#include <algorithm>
#include <cmath>
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
constexpr double kSettled = 0.002;       // gain of cost, a sixteenth of a deviation; its step is still taken
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
  const double cost = search.cost(at);
  if (gradient == nullptr) return cost;
  for (Index i = 0; i < at.size(); ++i) {
    const double step = at[i] + kStep <= search.high[i] ? kStep : -kStep;
    gradient[i] = (search.cost(with_step(at, i, step)) - cost) / step;
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

/// Returns steps that are about half of what each coordinate is known to alone. Far smaller ones
/// see rounding, far larger ones the third derivative.
VectorXd fitting_steps(const VectorXd& curvature) {
  return (0.5 / curvature.array().max(kLeastCurvature).sqrt()).cwiseMin(0.5).cwiseMax(0.02);
}

Quadratic fit_quadratic(const PosteriorCost& cost, const VectorXd& at, const VectorXd& steps,
                        const PosteriorBounds& bounds) {
  const Index n = at.size();
  Quadratic fit{at.cwiseMax(bounds.low + steps).cwiseMin(bounds.high - steps), 0, VectorXd(n),
                MatrixXd(n, n)};
  fit.cost = cost(fit.centre);
  VectorXd ahead(n);
  for (Index i = 0; i < n; ++i) {
    ahead[i] = cost(with_step(fit.centre, i, steps[i]));
    const double behind = cost(with_step(fit.centre, i, -steps[i]));
    fit.gradient[i] = (ahead[i] - behind) / (2 * steps[i]);
    fit.curvature(i, i) = (ahead[i] + behind - 2 * fit.cost) / (steps[i] * steps[i]);
  }
  for (Index i = 0; i < n; ++i) {
    for (Index j = 0; j < i; ++j) {
      const double both = cost(with_step(with_step(fit.centre, i, steps[i]), j, steps[j]));
      fit.curvature(i, j) = (both - ahead[i] - ahead[j] + fit.cost) / (steps[i] * steps[j]);
      fit.curvature(j, i) = fit.curvature(i, j);
    }
  }
  return fit;
}

/// Returns the inverse, with the curvature made positive where rounding or a saddle has left none.
MatrixXd covariance_of(const MatrixXd& curvature) {
  const auto [values, vectors] = symmetric_eigen(curvature);
  return vectors * values.cwiseMax(kLeastCurvature).cwiseInverse().asDiagonal() * vectors.transpose();
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
/// where the quadratic fits.
double descending(const PosteriorCost& cost, const Quadratic& fit, const VectorXd& step) {
  constexpr double kLeastShare = 0.05;
  double share = std::min(1.0, kLongestStep / std::max(step.cwiseAbs().maxCoeff(), 1e-12));
  while (share > kLeastShare && cost(fit.centre + share * step) > fit.cost) share *= 0.4;
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
  for (int i = 0; i < kMostNewtonSteps; ++i) {
    const Quadratic fit = fit_quadratic(cost, mode.at, steps, bounds);
    mode.covariance = covariance_of(fit.curvature);
    const VectorXd least = least_point(fit, bounds);
    if (fit.rise_to(mode.at) - fit.rise_to(least) < kSettled) {
      mode.at = least;
      break;
    }
    const VectorXd step = least - fit.centre;
    mode.at = fit.centre + descending(cost, fit, step) * step;
    steps = fitting_steps(fit.curvature.diagonal()).cwiseMin(longest);
  }
  return mode;
}

}  // namespace waymark::drive
