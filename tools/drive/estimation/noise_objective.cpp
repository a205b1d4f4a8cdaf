#include <waymark/tools/drive/estimation/noise_objective.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include <waymark/core/base/error.hpp>
#include <waymark/core/covariance/marginals.hpp>
#include <waymark/core/optimize/optimizer.hpp>
#include <waymark/core/system/gauge.hpp>
#include <waymark/tools/drive/model/build.hpp>
#include <waymark/types_se2/vertex_se2.hpp>

namespace waymark::drive {
namespace {

/// Of the differences, in deviations of the priors. The cost is exact to 1e-11.
constexpr double kDifference = 1e-4;
/// Of the minimum, as OptimizerOptions::decrement_tolerance. What is left of its gradient counts in the
/// derivatives.
constexpr double kExact = 1e-10;
/// Newton's steps begin there, and each decrement is at most this share of the one before.
constexpr double kNearMinimum = 1e-5;
constexpr double kContraction = 0.5;
/// The step of the poses is corrected until the last correction is a small part of it. One step is
/// enough where H is the whole curvature.
constexpr double kCorrected = 0.02;
constexpr int kMostCorrections = 12;
/// Less is rounding: the parameter has no effect.
constexpr double kNoDecrement = 1e-16;
constexpr double kImpossible = 1e300;

double value_at(double coordinate, const NoisePrior& prior) {
  const double away = coordinate * prior.deviation;
  return prior.linear ? prior.mean + away : prior.mean * std::exp(away);
}

double negative_log_prior(const NoiseEstimate& noise) {
  return 0.5 * coordinates_of(noise).squaredNorm();
}

std::span<double> span_of(Eigen::VectorXd& x) {
  return {x.data(), static_cast<std::size_t>(x.size())};
}

}  // namespace

double coordinate_of(double value, const NoisePrior& prior) {
  const double away = prior.linear ? value - prior.mean : std::log(value / prior.mean);
  return away / prior.deviation;
}

Eigen::VectorXd coordinates_of(const NoiseEstimate& noise) {
  Eigen::VectorXd at(static_cast<Eigen::Index>(noise.parameters.size()));
  std::transform(noise.parameters.begin(), noise.parameters.end(), at.begin(),
                 [](const NoiseParameter& of) { return coordinate_of(of.value, of.prior); });
  return at;
}

void place_at(double coordinate, NoiseParameter& parameter) {
  // A value at the end of its range must not leave it by rounding.
  parameter.value =
      std::clamp(value_at(coordinate, parameter.prior), parameter.range.low, parameter.range.high);
}

void place_at(const Eigen::VectorXd& coordinates, NoiseEstimate& noise) {
  for (std::size_t i = 0; i < noise.parameters.size(); ++i)
    place_at(coordinates[static_cast<Eigen::Index>(i)], noise.parameters[i]);
}

NoiseObjective::NoiseObjective(const CoarseDrive& coarse, const FusionSettings& settings,
                               const TypeRegistry& registry, const std::function<void()>& between)
    : coarse_(coarse),
      settings_(settings),
      registry_(registry),
      between_(between),
      algorithm_(registry.make_algorithm("dogleg")) {}

void NoiseObjective::build(const NoiseEstimate& noise) {
  if (between_) between_();
  found_at_.reset();
  graph_ = build_graph(coarse_.drive, coarse_.sensors, with_noise(settings_, noise), registry_).graph;
  if (equations_) return;
  kept_.build(graph_, find_gauge(graph_).held);
  equations_ = std::make_unique<NormalEquations>(graph_, kept_.structure());
  evidence_ = std::make_unique<RepeatedEvidence>(graph_, kept_.structure());
}

bool NoiseObjective::polish(double tolerance) {
  constexpr int kMostSteps = 8;
  values_ = graph_.values();
  std::vector<double> next;
  double before = std::numeric_limits<double>::infinity();
  for (int i = 0; i < kMostSteps; ++i) {
    const double chi2 = equations_->linearize_with_concave_terms(values_);
    if (cholesky_.factorize(equations_->hessian()) != FactorStatus::ok) return false;
    Eigen::VectorXd move = -equations_->gradient();
    cholesky_.solve(span_of(move), span_of(move));
    const double decrement = -move.dot(equations_->gradient());
    if (!(decrement >= 0 && decrement < before)) return decrement <= tolerance * (1 + chi2);
    equations_->retract(values_, move, next);
    values_.swap(next);
    if (decrement <= tolerance * (1 + chi2)) return true;
    before = kContraction * decrement;
  }
  return false;
}

void NoiseObjective::find_poses(double tolerance) {
  if (!stays_at_.empty()) {
    graph_.set_values(stays_at_);
    if (polish(tolerance)) return;
    graph_.set_values(stays_at_);
  }
  OptimizerOptions options;
  options.decrement_tolerance = kNearMinimum;
  options.max_iterations = 200;
  if (between_) options.observer = [this](const IterationRecord&) { between_(); };
  optimize(graph_, kept_, *algorithm_, options);
  const std::vector<double> near = graph_.values();
  if (polish(tolerance)) return;
  graph_.set_values(near);
  options.decrement_tolerance = tolerance;
  optimize(graph_, kept_, *algorithm_, options);
  values_ = graph_.values();
}

double NoiseObjective::at(const NoiseEstimate& noise) {
  ++evaluations_;
  build(noise);
  find_poses(kExact);
  here_ = evidence_->at(values_);
  found_at_ = coordinates_of(noise);
  return cost_of(noise);
}

double NoiseObjective::cost_of(const NoiseEstimate& noise) const {
  const double cost = here_.negative_log() + negative_log_prior(noise);
  return std::isfinite(cost) ? cost : kImpossible;
}

bool NoiseObjective::factorize_curvature() {
  (void)equations_->linearize_with_concave_terms(values_);
  if (cholesky_.factorize(equations_->hessian()) == FactorStatus::ok) return true;
  (void)equations_->linearize(values_);
  return cholesky_.factorize(equations_->hessian()) == FactorStatus::ok;
}

double NoiseObjective::with_gradient(const NoiseEstimate& noise, Eigen::VectorXd& gradient) {
  gradient = coordinates_of(noise);  // of the prior
  // A search asks for the gradient where it has just asked for the cost.
  const double cost = found_at_ == gradient ? cost_of(noise) : at(noise);
  if (cost >= kImpossible || !factorize_curvature()) return cost;
  const Eigen::VectorXd residual = equations_->gradient();
  for (std::size_t i = 0; i < noise.parameters.size(); ++i)
    gradient[static_cast<Eigen::Index>(i)] += derivative(noise, i, residual);
  return cost;
}

std::vector<PoseBelief> NoiseObjective::beliefs_at(const NoiseEstimate& noise) {
  build(noise);
  find_poses(kNearMinimum);
  graph_.set_values(values_);
  std::vector<VertexIndex> poses;
  for (VertexIndex v = 0; v < static_cast<VertexIndex>(graph_.vertex_count()); ++v) {
    if (graph_.vertex_type(v).tag == VertexSe2::kTag && graph_.stamp(v) && !graph_.fixed(v))
      poses.push_back(v);
  }
  std::sort(poses.begin(), poses.end(),
            [&](VertexIndex a, VertexIndex b) { return graph_.stamp(a) < graph_.stamp(b); });
  std::vector<PoseBelief> beliefs;
  beliefs.reserve(poses.size());
  try {
    const CovarianceBlocks covariances = marginal_covariances(graph_, poses);
    for (std::size_t i = 0; i < poses.size(); ++i) {
      const Eigen::Vector3d pose(graph_.value(poses[i]).data());
      beliefs.push_back({*graph_.stamp(poses[i]), pose, covariances[i]});
    }
  } catch (const InputError&) {
    return {};  // the curvature is not positive definite
  }
  return beliefs;
}

std::vector<double> NoiseObjective::moved_poses(const Eigen::VectorXd& residual) {
  std::vector<double> values = values_;
  std::vector<double> next;
  double first = 0;
  for (int i = 0; i < kMostCorrections; ++i) {
    const Eigen::VectorXd left = residual - equations_->gradient();
    Eigen::VectorXd move = left;
    cholesky_.solve(span_of(move), span_of(move));
    const double decrement = move.dot(left);
    equations_->retract(values, move, next);
    values.swap(next);
    if (i == 0) first = decrement;
    if (!(decrement > std::max(kNoDecrement, kCorrected * kCorrected * first))) break;
    (void)equations_->linearize(values);
  }
  return values;
}

double NoiseObjective::derivative(const NoiseEstimate& noise, std::size_t parameter,
                                  const Eigen::VectorXd& residual) {
  NoiseEstimate moved = noise;
  NoiseParameter& changed = moved.parameters[parameter];
  const double from = coordinate_of(changed.value, changed.prior);
  const bool fits = value_at(from + kDifference, changed.prior) <= changed.range.high;
  const double step = fits ? kDifference : -kDifference;
  place_at(from + step, changed);
  build(moved);
  const double chi2 = equations_->linearize(values_);  // where the poses stand
  const auto derivative_at = [&](const std::vector<double>& values) {
    Evidence there = evidence_->at(values);
    there.chi2 = chi2;
    return (there.negative_log() - here_.negative_log()) / step;
  };
  const double derivative = derivative_at(moved_poses(residual));
  // Where heavy tails let the corrections run away, the poses stand: the determinants lose their part.
  return std::isfinite(derivative) ? derivative : derivative_at(values_);
}

}  // namespace waymark::drive
