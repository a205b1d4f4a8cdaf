/// What the search for the noise of a drive minimises, with its derivatives:
///   L(noise) = -log of prior times marginal likelihood of the fixes (core/covariance/evidence.hpp).
///
/// L is a minimum over the poses x itself, of chi2. So dL has two parts. The parameters change chi2 and
/// the determinants where x stands, and they move x, which changes log det H (chi2 is stationary there):
///   dL/dtheta = dF/dtheta + 1/2 d(log det H)/dx dx/dtheta,   dx/dtheta = -H^-1 dg/dtheta.
/// Both are one difference of F, from the minimum x at theta to x + h dx/dtheta at theta + h: no
/// minimisation, and no noise of one, so that h can be small.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include <waymark/core/covariance/evidence.hpp>
#include <waymark/core/optimize/algorithm.hpp>
#include <waymark/core/registry/registry.hpp>
#include <waymark/core/system/structured_solver.hpp>
#include <waymark/tools/drive/estimation/coarse.hpp>
#include <waymark/tools/drive/estimation/noise.hpp>

namespace waymark::drive {

/// Returns the distance of a value from the mean of its prior, in deviations of the prior.
[[nodiscard]] double coordinate_of(double value, const NoisePrior& prior);
[[nodiscard]] Eigen::VectorXd coordinates_of(const NoiseEstimate& noise);
/// Sets the value of a parameter, within its range.
void place_at(double coordinate, NoiseParameter& parameter);
void place_at(const Eigen::VectorXd& coordinates, NoiseEstimate& noise);

/// A pose of the coarse drive at some noise.
struct PoseBelief {
  Stamp stamp;
  Eigen::Vector3d pose;        ///< x, y in frame axes, m; heading, rad
  Eigen::Matrix3d covariance;  ///< in the same axes
};

class NoiseObjective {
 public:
  /// All of them must outlive this object. @param settings state none of the parameters
  /// @param between as for estimate_noise()
  NoiseObjective(const CoarseDrive& coarse, const FusionSettings& settings, const TypeRegistry& registry,
                 const std::function<void()>& between = {});

  /// Returns L. The search for its poses begins where the objective stays: heavy tails have several
  /// minima, and L is a function of the noise alone if all searches begin at the same poses.
  /// @throws what the odometry model and the modeling throw
  [[nodiscard]] double at(const NoiseEstimate& noise);
  /// Returns the same. @param gradient receives the derivatives by the coordinates
  [[nodiscard]] double with_gradient(const NoiseEstimate& noise, Eigen::VectorXd& gradient);
  /// Returns the poses at a noise, in order of time, to a small part of what they are known to. The search for
  /// them begins as in at(). Empty if their covariances are not defined there.
  [[nodiscard]] std::vector<PoseBelief> beliefs_at(const NoiseEstimate& noise);
  /// Stays at the poses of the last call. Before the first call it is at the initial guess.
  void stay() { stays_at_ = values_; }
  /// Returns how many times the poses of a noise were found.
  [[nodiscard]] int evaluations() const { return evaluations_; }

 private:
  /// Builds the graph of a noise. Vertices and edges are the same every time.
  void build(const NoiseEstimate& noise);
  /// Takes Newton's steps with the whole curvature from the poses of the graph. @returns whether they
  /// reached a minimum, to a tolerance as OptimizerOptions::decrement_tolerance
  [[nodiscard]] bool polish(double tolerance);
  /// Factorises the curvature at the poses, and keeps the gradient. @returns whether it has a factor
  [[nodiscard]] bool factorize_curvature();
  /// Minimises chi2 over the poses, and keeps them.
  void find_poses(double tolerance);
  [[nodiscard]] double cost_of(const NoiseEstimate& noise) const;
  /// Returns where the minimum moves if the gradient becomes that of equations_, with the factor of the
  /// minimum. @param residual the gradient that is left there
  [[nodiscard]] std::vector<double> moved_poses(const Eigen::VectorXd& residual);
  [[nodiscard]] double derivative(const NoiseEstimate& noise, std::size_t parameter,
                                  const Eigen::VectorXd& residual);

  const CoarseDrive& coarse_;
  const FusionSettings& settings_;
  const TypeRegistry& registry_;
  std::function<void()> between_;
  std::unique_ptr<Algorithm> algorithm_;
  Graph graph_;
  BlockCholesky cholesky_;
  StructuredSolver kept_{cholesky_};
  std::unique_ptr<NormalEquations> equations_;
  std::unique_ptr<RepeatedEvidence> evidence_;
  std::vector<double> stays_at_;  ///< empty: the initial guess
  std::vector<double> values_;    ///< of the last minimum
  Evidence here_;                 ///< there
  /// coordinates of the noise of the graph, if the last minimum is its own
  std::optional<Eigen::VectorXd> found_at_;
  int evaluations_ = 0;
};

}  // namespace waymark::drive
