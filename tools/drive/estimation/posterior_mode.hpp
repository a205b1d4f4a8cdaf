/// The most probable values of a few parameters, and how well they are known.
#pragma once

#include <functional>

#include <Eigen/Core>

namespace waymark::drive {

/// The cost of n coordinates, -log of prior times likelihood, each coordinate in units of its
/// prior's deviation. It must be a smooth function of them and of nothing else.
struct PosteriorCost {
  /// @param gradient receives the n derivatives; null: they are not wanted
  std::function<double(const Eigen::VectorXd& coordinates, Eigen::VectorXd* gradient)> at;
  /// From now on costs are asked for near the last ones, so that a cost which is a minimum itself can
  /// begin there. May be empty.
  std::function<void()> stay = {};
};

struct PosteriorMode {
  Eigen::VectorXd at;  ///< n
  /// n x n, as the search followed it: good enough for the next search from near
  Eigen::MatrixXd curvature;
};

/// The bounds of the coordinates, n each, low < high. A coordinate may end at them.
struct PosteriorBounds {
  Eigen::VectorXd low;
  Eigen::VectorXd high;
};

/// Comes near the least cost: a quasi-Newton search (SLSQP, Kraft 1988).
[[nodiscard]] PosteriorMode search_posterior(const PosteriorCost& cost, const Eigen::VectorXd& start,
                                             const PosteriorBounds& bounds);

/// Finds the least cost from a point near it. Newton's steps with the full curvature go on until they are
/// a small part of what the parameters are known to: parameters on a ridge move together, which no search
/// along axes does. The curvature follows the steps (BFGS). Where they do not lead on, it is found anew
/// from differences of the gradient.
/// @param near with a curvature that holds about there
[[nodiscard]] PosteriorMode find_posterior_mode(const PosteriorCost& cost, const PosteriorMode& near,
                                                const PosteriorBounds& bounds);

/// Returns the inverse of the curvature at a mode, n x n, from differences of the gradient over a small
/// part of what the parameters are known to.
[[nodiscard]] Eigen::MatrixXd posterior_covariance(const PosteriorCost& cost, const PosteriorMode& mode,
                                                   const PosteriorBounds& bounds);

}  // namespace waymark::drive
