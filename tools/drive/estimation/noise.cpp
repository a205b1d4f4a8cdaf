#include <waymark/tools/drive/estimation/noise.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>

#include <waymark/core/base/error.hpp>
#include <waymark/core/covariance/evidence.hpp>
#include <waymark/core/optimize/optimizer.hpp>
#include <waymark/core/registry/options.hpp>
#include <waymark/core/system/gauge.hpp>
#include <waymark/tools/drive/estimation/coarse.hpp>
#include <waymark/tools/drive/estimation/posterior_mode.hpp>
#include <waymark/tools/drive/model/build.hpp>

namespace waymark::drive {
namespace {

/// The distance of a value from the mean of its prior, in deviations of the prior.
double coordinate_of(double value, const NoisePrior& prior) {
  const double away = prior.linear ? value - prior.mean : std::log(value / prior.mean);
  return away / prior.deviation;
}
double value_at(double coordinate, const NoisePrior& prior) {
  const double away = coordinate * prior.deviation;
  return prior.linear ? prior.mean + away : prior.mean * std::exp(away);
}

void place(double coordinate, NoiseParameter& parameter) {
  // A value at the end of its range must not leave it by rounding.
  parameter.value =
      std::clamp(value_at(coordinate, parameter.prior), parameter.range.low, parameter.range.high);
}

/// The prior for receivers that claim an accuracy. @param accuracy_m median; 0: none is claimed
NoisePrior prior_for(const NoisePrior& general, double accuracy_m) {
  constexpr double kCoarse_m = 0.5;
  NoisePrior prior = general;
  if (prior.shrinks_with_claim && accuracy_m > 0) prior.mean *= std::min(1.0, accuracy_m / kCoarse_m);
  return prior;
}

/// Adds options with a prior that are not stated.
void add_parameters(const std::string& source, const std::string& owner, const std::vector<OptionInfo>& known,
                    const Options& given, const ClaimedAccuracies& claimed,
                    std::vector<NoiseParameter>& parameters) {
  for (const OptionInfo& option : known) {
    if (!option.prior || given.contains(option.name)) continue;
    if (option.prior->between_kinds && claimed.kinds() < 2) continue;
    NoiseParameter parameter;
    parameter.source = source;
    parameter.owner = owner;
    parameter.option = option.name;
    parameter.unit = option.unit;
    parameter.range = std::get<OptionRange>(option.allowed);
    parameter.prior = prior_for(*option.prior, claimed.reference_m());
    place(0, parameter);
    parameters.push_back(std::move(parameter));
  }
}

/// The function that the noise minimises: -log of prior times marginal likelihood.
class Objective {
 public:
  Objective(const CoarseDrive& coarse, const FusionSettings& settings, const TypeRegistry& registry)
      : coarse_(coarse),
        settings_(settings),
        registry_(registry),
        algorithm_(registry.make_algorithm("dogleg")) {}

  /// From now on every minimisation begins at the minimum of this noise and goes to its end. Before,
  /// it begins at the one before: heavy tails have several minima, so that the cost depends a little
  /// on where the search has been.
  double begin_at(const NoiseEstimate& noise) {
    stays_ = true;
    return cost_of(noise, 1e-12, true);
  }

  double operator()(const NoiseEstimate& noise) { return cost_of(noise, stays_ ? 1e-7 : 1e-6, !stays_); }
  [[nodiscard]] int evaluations() const { return evaluations_; }

 private:
  /// @param next whether the next minimisation begins at this minimum
  double cost_of(const NoiseEstimate& noise, double decrement_tolerance, bool next) {
    ++evaluations_;
    Graph graph = build_graph(coarse_.drive, coarse_.sensors, with_noise(settings_, noise), registry_).graph;
    prepare(graph);
    OptimizerOptions options;
    options.decrement_tolerance = decrement_tolerance;
    options.max_iterations = 200;
    const Summary summary = optimize(graph, kept_, *algorithm_, options);
    if (next && summary.converged()) values_ = graph.values();
    double cost = evidence(graph, kept_.structure(), cholesky_).negative_log();
    for (const NoiseParameter& parameter : noise.parameters)
      cost += 0.5 * std::pow(coordinate_of(parameter.value, parameter.prior), 2);
    return std::isfinite(cost) ? cost : 1e300;
  }

  /// Vertices and edges are the same every time. So structure and analysis are made once.
  void prepare(Graph& graph) {
    if (!values_.empty()) {
      graph.set_values(values_);
      return;
    }
    if (evaluations_ > 1) return;
    kept_.build(graph, find_gauge(graph).held);
  }

  const CoarseDrive& coarse_;
  const FusionSettings& settings_;
  const TypeRegistry& registry_;
  std::unique_ptr<Algorithm> algorithm_;
  BlockCholesky cholesky_;
  StructuredSolver kept_{cholesky_};
  std::vector<double> values_;
  int evaluations_ = 0;
  bool stays_ = false;  ///< where the next minimisation begins
};

/// A parameter may leave its prior by kNoiseReach deviations, but not what its option allows.
PosteriorBounds bounds_of(const NoiseEstimate& noise) {
  const auto size = static_cast<Eigen::Index>(noise.parameters.size());
  PosteriorBounds bounds{Eigen::VectorXd(size), Eigen::VectorXd(size)};
  Eigen::Index i = 0;
  for (const NoiseParameter& parameter : noise.parameters) {
    bounds.low[i] = std::max(-kNoiseReach, coordinate_of(parameter.range.low, parameter.prior));
    bounds.high[i] = std::min(kNoiseReach, coordinate_of(parameter.range.high, parameter.prior));
    ++i;
  }
  return bounds;
}

/// @param begins_near whether the values of the noise are near the minimum
void minimize(Objective& objective, bool begins_near, NoiseEstimate& noise) {
  const PosteriorBounds bounds = bounds_of(noise);
  const Eigen::Index size = bounds.low.size();
  const auto with = [&](const Eigen::VectorXd& coordinates) -> const NoiseEstimate& {
    for (Eigen::Index i = 0; i < size; ++i)
      place(coordinates[i], noise.parameters[static_cast<std::size_t>(i)]);
    return noise;
  };
  const PosteriorCost cost{[&](const Eigen::VectorXd& x) { return objective(with(x)); },
                           [&](const Eigen::VectorXd& x) { return objective.begin_at(with(x)); }};
  Eigen::VectorXd start(size);
  for (Eigen::Index i = 0; i < size; ++i) {
    const NoiseParameter& parameter = noise.parameters[static_cast<std::size_t>(i)];
    start[i] = coordinate_of(parameter.value, parameter.prior);
  }
  start = start.cwiseMax(bounds.low).cwiseMin(bounds.high);
  const Eigen::VectorXd near = begins_near ? start : search_posterior(cost, start, bounds);
  const PosteriorMode mode = find_posterior_mode(cost, near, bounds);
  with(mode.at);
  for (Eigen::Index i = 0; i < size; ++i) {
    NoiseParameter& parameter = noise.parameters[static_cast<std::size_t>(i)];
    parameter.deviation = std::sqrt(mode.covariance(i, i)) * parameter.prior.deviation;
  }
}

/// Takes the values of the same parameters. @returns whether all of them are known
bool take_values(const NoiseEstimate& known, NoiseEstimate& noise) {
  for (NoiseParameter& parameter : noise.parameters) {
    const auto same = std::find_if(known.parameters.begin(), known.parameters.end(), [&](const auto& other) {
      return other.owner == parameter.owner && other.name() == parameter.name();
    });
    if (same == known.parameters.end()) return false;
    parameter.value = same->value;
  }
  return true;
}

/// Returns a coarse drive with one of its relative sources. Where that is silent, the motion is bridged.
CoarseDrive with_only(std::size_t source, CoarseDrive coarse) {
  PlacedDrive& drive = coarse.drive;
  if (drive.relative.empty()) return coarse;
  drive.relative = {drive.relative[source]};
  drive.runs = motion_runs(drive.timeline, drive.relative, drive.fixes);
  return coarse;
}

/// Returns what is to be estimated with one relative source: its parameters, and those of the absolute
/// ones.
/// @param count of relative sources in the drive @param absolute whether those of absolute sources and of
/// further sensors are open
NoiseEstimate open_parameters(const CoarseDrive& coarse, std::size_t count, bool absolute,
                              const FusionSettings& settings, const TypeRegistry& registry) {
  NoiseEstimate noise;
  const DriveFacts facts = facts_of(coarse.drive, settings);
  // What is estimated for the only source of a kind is an option of the drive, unless it states its own.
  const auto label = [&](const std::string& source, std::size_t sources) {
    return sources > 1 || settings.sources.contains(source) ? source : std::string();
  };
  const std::string& relative = facts.relative.front();
  const FusionSettings own = for_relative(settings, relative);
  add_parameters(label(relative, count), own.odometry_model,
                 registry.odometry_model(own.odometry_model).options, own.odometry_options, {},
                 noise.parameters);
  if (!absolute) return noise;
  for (const AbsoluteGroup& group : facts.absolute) {
    const FusionSettings of = for_absolute(settings, group.name, registry);
    add_parameters(label(group.name, facts.absolute.size()), of.modeling,
                   registry.gnss_modeling(of.modeling).options, of.modeling_options, group.claimed,
                   noise.parameters);
  }
  for (const PreparedSensor& sensor : coarse.sensors)
    add_parameters(sensor.source, sensor.name, registry.sensor_model(sensor.name).options,
                   options_of(sensor, settings), {}, noise.parameters);
  return noise;
}

}  // namespace

NoiseEstimate estimate_noise(const PlacedDrive& placed, std::span<const PreparedSensor> sensors,
                             const FusionSettings& settings, const TypeRegistry& registry,
                             const NoiseEstimate& near) {
  const auto start = std::chrono::steady_clock::now();
  NoiseEstimate noise;
  FusionSettings known = settings;
  const CoarseDrive all = coarsen(placed, sensors);
  const std::size_t count = std::max<std::size_t>(placed.relative.size(), 1);
  for (std::size_t source = 0; source < count; ++source) {
    const CoarseDrive coarse = with_only(source, all);
    NoiseEstimate part = open_parameters(coarse, count, source == 0, known, registry);
    if (part.parameters.empty()) continue;
    Objective objective(coarse, known, registry);
    const bool begins_near = take_values(near, part);
    minimize(objective, begins_near, part);
    noise.evaluations += objective.evaluations();
    noise.parameters.insert(noise.parameters.end(), part.parameters.begin(), part.parameters.end());
    known = with_noise(std::move(known), part);
  }
  if (!noise.parameters.empty())
    noise.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return noise;
}

FusionSettings with_noise(FusionSettings settings, const NoiseEstimate& noise) {
  for (const NoiseParameter& parameter : noise.parameters) {
    const std::string value = shortest(parameter.value);
    if (!parameter.source.empty()) {
      settings.sources[parameter.source].options.try_emplace(parameter.option, value);
      continue;
    }
    if (parameter.owner == settings.odometry_model)
      settings.odometry_options.try_emplace(parameter.option, value);
    if (parameter.owner == settings.modeling) settings.modeling_options.try_emplace(parameter.option, value);
  }
  return settings;
}

}  // namespace waymark::drive
