#include <waymark/tools/drive/estimation/posterior_mode.hpp>

#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>

#include <nlopt.h>

#include <waymark/core/linear/dense_decompositions.hpp>

namespace waymark::drive {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kNear = 0.05;        // where the search ends
constexpr int kMostSearchSteps = 40;  // evaluations
constexpr int kMostNewtonSteps = 20;
constexpr double kSettled = 5e-5;        // gain of cost, a hundredth of a deviation; its step is still taken
constexpr double kOfDeviation = 0.15;    // of a deviation, the differences of the gradient
constexpr double kFine = 0.25;           // of them, for the covariance
constexpr double kTolerated = 1e-5;      // rise of cost in a step: rounding
constexpr double kLongestStep = 1.0;     // in deviations of the priors
constexpr double kLeastCurvature = 0.1;  // the prior alone has 1

/// The quadratic function about a point.
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

/// Moves the centre, and keeps the curvature.
void move_to(const VectorXd& at, const PosteriorCost& cost, Quadratic& fit) {
  fit.centre = at;
  fit.cost = cost.at(at, &fit.gradient);
}

/// Moves the centre, and lets the curvature follow (Broyden, Fletcher, Goldfarb, Shanno 1970): it becomes
/// that of the gradients along the step, and stays positive.
void follow_to(const Quadratic& next, Quadratic& fit) {
  const VectorXd step = next.centre - fit.centre;
  const VectorXd change = next.gradient - fit.gradient;
  const VectorXd expected = fit.curvature * step;
  const double found = step.dot(change);
  const double known = step.dot(expected);
  const MatrixXd before = fit.curvature;
  fit = next;
  fit.curvature = before;
  constexpr double kLeastShare = 0.2;  // less is the end of a ridge, or rounding
  if (known > 0 && found > kLeastShare * known)
    fit.curvature += change * change.transpose() / found - expected * expected.transpose() / known;
}

/// What SLSQP evaluates: the cost, with a curvature that follows its points.
struct Search {
  const PosteriorCost& cost;
  nlopt_opt slsqp = nullptr;
  double least = std::numeric_limits<double>::infinity();
  Quadratic followed{};
  std::exception_ptr thrown{};  // by the cost: it must not fly through code in C
};

void evaluate_here(Search& search, Quadratic& there, bool with_gradient) {
  there.cost = search.cost.at(there.centre, with_gradient ? &there.gradient : nullptr);
  // A first step may leap to the bounds, where the poses may have another minimum for good.
  if (search.cost.stay && there.cost < search.least) search.cost.stay();
  search.least = std::min(search.least, there.cost);
  if (!with_gradient) return;
  if (search.followed.centre.size() > 0) return follow_to(there, search.followed);
  search.followed = there;
  const Index size = there.centre.size();
  search.followed.curvature = MatrixXd::Identity(size, size);  // of the prior
}

/// The interface of NLopt in C. @param data a Search
double evaluate(unsigned size, const double* coordinates, double* gradient, void* data) {
  Search& search = *static_cast<Search*>(data);
  Quadratic there;
  there.centre = Eigen::Map<const VectorXd>(coordinates, size);
  if (!there.centre.allFinite()) {  // a derivative was no number; the best point so far stands
    nlopt_force_stop(search.slsqp);
    return std::numeric_limits<double>::max();
  }
  try {
    evaluate_here(search, there, gradient != nullptr);
  } catch (...) {
    search.thrown = std::current_exception();
    nlopt_force_stop(search.slsqp);
    return 0;
  }
  if (gradient != nullptr) Eigen::Map<VectorXd>(gradient, size) = there.gradient;
  return there.cost;
}

/// Returns steps that are a share of what each coordinate is known to alone. Far smaller ones see
/// rounding, far larger ones the derivatives of higher order.
VectorXd fitting_steps(const VectorXd& curvature) {
  return kOfDeviation * curvature.array().max(kLeastCurvature).rsqrt().min(1.0);
}

/// Returns the curvature at the centre, from the gradients beside it.
MatrixXd curvature_at(const Quadratic& fit, const PosteriorCost& cost, const VectorXd& steps,
                      const PosteriorBounds& bounds) {
  const Index n = fit.centre.size();
  MatrixXd curvature(n, n);
  VectorXd gradient(n);
  for (Index i = 0; i < n; ++i) {
    const double end = fit.centre[i] + steps[i];
    const double step = end >= bounds.low[i] && end <= bounds.high[i] ? steps[i] : -steps[i];
    VectorXd beside = fit.centre;
    beside[i] += step;
    (void)cost.at(beside, &gradient);
    curvature.col(i) = (gradient - fit.gradient) / step;
  }
  return 0.5 * (curvature + curvature.transpose());
}

/// Returns the curvature made positive where rounding or a saddle has left none, to a power.
MatrixXd positive(const MatrixXd& curvature, double power) {
  const auto [values, vectors] = symmetric_eigen(curvature);
  return vectors * values.cwiseAbs().cwiseMax(kLeastCurvature).array().pow(power).matrix().asDiagonal() *
         vectors.transpose();
}

MatrixXd covariance_of(const MatrixXd& curvature) {
  return positive(curvature, -1);
}

/// Returns the least point of the quadratic between the bounds: one coordinate after the other (Gauss-Seidel
/// with projection), which goes to the minimum where the curvature is positive.
VectorXd least_point(const Quadratic& fit, const PosteriorBounds& bounds) {
  constexpr int kMostSweeps = 10000;
  constexpr double kStill = 1e-9;  // in deviations of the priors
  VectorXd at = fit.centre;
  VectorXd slope = fit.gradient;
  for (int sweep = 0; sweep < kMostSweeps; ++sweep) {
    double most = 0;
    for (Index i = 0; i < at.size(); ++i) {
      const double to = std::clamp(at[i] - slope[i] / fit.curvature(i, i), bounds.low[i], bounds.high[i]);
      const double step = to - at[i];
      at[i] = to;
      slope += step * fit.curvature.col(i);
      most = std::max(most, std::abs(step));
    }
    if (most < kStill) break;
  }
  return at;
}

/// Takes a share of a step at which the cost does not rise: the step may leave the region where
/// the quadratic fits. @returns whether there is one. The cost is bent where weights of losses reach
/// their bounds, and a minimum there has a gradient.
bool descend(const PosteriorCost& cost, const VectorXd& step, Quadratic& fit) {
  constexpr double kLeastShare = 0.05;
  double share = std::min(1.0, kLongestStep / std::max(step.cwiseAbs().maxCoeff(), 1e-12));
  Quadratic trial = fit;
  for (; share > kLeastShare; share *= 0.4) {
    move_to(fit.centre + share * step, cost, trial);
    if (trial.cost > fit.cost + kTolerated) continue;
    follow_to(trial, fit);
    if (cost.stay) cost.stay();
    return true;
  }
  return false;
}

}  // namespace

PosteriorMode search_posterior(const PosteriorCost& cost, const VectorXd& start,
                               const PosteriorBounds& bounds) {
  VectorXd at = start;
  nlopt_opt slsqp = nlopt_create(NLOPT_LD_SLSQP, static_cast<unsigned>(at.size()));
  Search search{cost, slsqp};
  nlopt_set_min_objective(slsqp, evaluate, &search);
  nlopt_set_lower_bounds(slsqp, bounds.low.data());
  nlopt_set_upper_bounds(slsqp, bounds.high.data());
  nlopt_set_xtol_abs1(slsqp, kNear);
  nlopt_set_maxeval(slsqp, kMostSearchSteps);
  double least = 0;
  nlopt_optimize(slsqp, at.data(), &least);  // its best values stand whatever ends it
  nlopt_destroy(slsqp);
  if (search.thrown) std::rethrow_exception(search.thrown);
  return {at.cwiseMax(bounds.low).cwiseMin(bounds.high), search.followed.curvature};
}

PosteriorMode find_posterior_mode(const PosteriorCost& cost, const PosteriorMode& near,
                                  const PosteriorBounds& bounds) {
  Quadratic fit;
  // That of a piece of the drive, made longer, need not be: its least point would then be a corner.
  fit.curvature = positive(near.curvature, 1);
  move_to(near.at, cost, fit);
  if (cost.stay) cost.stay();
  bool is_curvature_of_centre = false;
  const auto find_curvature = [&] {
    // Where it is not positive, a quadratic promises nothing, or everything, far away.
    fit.curvature = positive(curvature_at(fit, cost, fitting_steps(fit.curvature.diagonal()), bounds), 1);
    is_curvature_of_centre = true;
  };
  double gain_before = std::numeric_limits<double>::max();
  for (int i = 0; i < kMostNewtonSteps; ++i) {
    VectorXd least = least_point(fit, bounds);
    double gain = -fit.rise_to(least);
    if (gain > kSettled && gain > gain_before && !is_curvature_of_centre) {
      find_curvature();
      least = least_point(fit, bounds);
      gain = -fit.rise_to(least);
    }
    if (gain < kSettled) {
      fit.centre = least;
      break;
    }
    gain_before = gain;
    if (descend(cost, least - fit.centre, fit)) {
      is_curvature_of_centre = false;
      continue;
    }
    if (is_curvature_of_centre) break;
    find_curvature();
  }
  return {fit.centre, fit.curvature};
}

MatrixXd posterior_covariance(const PosteriorCost& cost, const PosteriorMode& mode,
                              const PosteriorBounds& bounds) {
  Quadratic fit;
  move_to(mode.at, cost, fit);
  if (cost.stay) cost.stay();
  return covariance_of(curvature_at(fit, cost, kFine * fitting_steps(mode.curvature.diagonal()), bounds));
}

}  // namespace waymark::drive
