#include <waymark/tools/drive/model/noise.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>

#include <nlopt.h>

#include <waymark/core/base/error.hpp>
#include <waymark/core/covariance/evidence.hpp>
#include <waymark/core/optimize/optimizer.hpp>
#include <waymark/core/registry/options.hpp>
#include <waymark/core/system/gauge.hpp>
#include <waymark/tools/drive/model/build.hpp>
#include <waymark/tools/drive/model/coarse.hpp>

namespace waymark::drive {
namespace {

/// Converts an estimated number for the search: its logarithm, or the number itself.
double to_search(const NoisePrior& prior, double value) {
  return prior.linear ? value : std::log(value);
}
double from_search(const NoisePrior& prior, double coordinate) {
  return prior.linear ? coordinate : std::exp(coordinate);
}

/// Adds options with a prior that are not stated.
void add_parameters(const std::string& owner, const std::vector<OptionInfo>& known, const Options& given,
                    std::vector<NoiseParameter>& parameters) {
  for (const OptionInfo& option : known) {
    if (!option.prior || given.contains(option.name)) continue;
    NoiseParameter parameter;
    parameter.owner = owner;
    parameter.option = option.name;
    parameter.unit = option.unit;
    parameter.prior = *option.prior;
    parameter.value = option.prior->mean;
    parameters.push_back(std::move(parameter));
  }
}

/// The function that the noise minimises: -log of prior times marginal likelihood.
class Objective {
 public:
  Objective(const PlacedDrive& placed, const FusionSettings& settings, const TypeRegistry& registry)
      : coarse_(coarsen(placed)),
        settings_(settings),
        registry_(registry),
        algorithm_(registry.make_algorithm("dogleg")) {}

  double operator()(const NoiseEstimate& noise) {
    ++evaluations_;
    Graph graph = build_graph(coarse_, {}, with_noise(settings_, noise), registry_).graph;
    prepare(graph);
    OptimizerOptions options;
    options.decrement_tolerance = 1e-7;
    options.max_iterations = 60;
    const Summary summary = optimize(graph, kept_, *algorithm_, options);
    const double found = evidence(graph, kept_.structure(), cholesky_).negative_log();
    if (summary.converged() && std::isfinite(found)) values_ = graph.values();
    double cost = found;
    for (const NoiseParameter& parameter : noise.parameters) {
      const double away =
          to_search(parameter.prior, parameter.value) - to_search(parameter.prior, parameter.prior.mean);
      cost += 0.5 * std::pow(away / parameter.prior.deviation, 2);
    }
    return std::isfinite(cost) ? cost : 1e300;
  }
  [[nodiscard]] int evaluations() const { return evaluations_; }

 private:
  /// Vertices and edges are the same every time. So structure and analysis are made once, and each
  /// minimisation begins at the last minimum.
  void prepare(Graph& graph) {
    if (!values_.empty()) {
      graph.set_values(values_);
      return;
    }
    if (evaluations_ > 1) return;
    kept_.build(graph, find_gauge(graph).held);
  }

  PlacedDrive coarse_;
  const FusionSettings& settings_;
  const TypeRegistry& registry_;
  std::unique_ptr<Algorithm> algorithm_;
  BlockCholesky cholesky_;
  StructuredSolver kept_{cholesky_};
  std::vector<double> values_;
  int evaluations_ = 0;
};

/// The search behind the C interface.
struct Search {
  Objective& objective;
  NoiseEstimate& noise;
};

double evaluate(unsigned size, const double* coordinates, double*, void* data) {
  const Search& search = *static_cast<Search*>(data);
  for (unsigned i = 0; i < size; ++i) {
    NoiseParameter& parameter = search.noise.parameters[i];
    parameter.value = from_search(parameter.prior, coordinates[i]);
  }
  return search.objective(search.noise);
}

/// BOBYQA (Powell 2009) needs no derivatives and respects bounds. A parameter may leave its prior
/// by kNoiseReach deviations.
void minimize(Objective& objective, NoiseEstimate& noise) {
  constexpr double kTolerance = 0.05;  // of a deviation of the prior
  const auto size = static_cast<unsigned>(noise.parameters.size());
  std::vector<double> at(size), low(size), high(size), step(size), tolerance(size);
  for (unsigned i = 0; i < size; ++i) {
    const NoisePrior& prior = noise.parameters[i].prior;
    at[i] = to_search(prior, prior.mean);
    low[i] = at[i] - kNoiseReach * prior.deviation;
    high[i] = at[i] + kNoiseReach * prior.deviation;
    if (prior.linear) {  // a share
      low[i] = std::max(low[i], 0.0);
      high[i] = std::min(high[i], 1.0);
    }
    step[i] = 0.5 * prior.deviation;
    tolerance[i] = kTolerance * prior.deviation;
  }
  Search search{objective, noise};
  nlopt_opt bobyqa = nlopt_create(NLOPT_LN_BOBYQA, size);
  nlopt_set_min_objective(bobyqa, evaluate, &search);
  nlopt_set_lower_bounds(bobyqa, low.data());
  nlopt_set_upper_bounds(bobyqa, high.data());
  nlopt_set_initial_step(bobyqa, step.data());
  nlopt_set_xtol_abs(bobyqa, tolerance.data());
  nlopt_set_maxeval(bobyqa, 30 * static_cast<int>(size));
  double least = 0;
  nlopt_optimize(bobyqa, at.data(), &least);
  nlopt_destroy(bobyqa);
  for (unsigned i = 0; i < size; ++i)
    noise.parameters[i].value = from_search(noise.parameters[i].prior, at[i]);
}

/// Computes standard deviations from second differences at the minimum.
void find_deviations(Objective& objective, NoiseEstimate& noise) {
  const double least = objective(noise);
  for (NoiseParameter& parameter : noise.parameters) {
    const double value = parameter.value;
    const double step = 0.25 * parameter.prior.deviation;
    const double centre = to_search(parameter.prior, value);
    double sum = 0;
    for (const double sign : {-1.0, 1.0}) {
      const double moved = from_search(parameter.prior, centre + sign * step);
      parameter.value = parameter.prior.linear ? std::clamp(moved, 0.0, 1.0) : moved;
      sum += objective(noise) - least;
    }
    parameter.value = value;
    const double curvature = sum / (step * step);
    parameter.deviation = curvature > 0 ? 1 / std::sqrt(curvature) : parameter.prior.deviation;
  }
}

}  // namespace

NoiseEstimate estimate_noise(const PlacedDrive& placed, const FusionSettings& settings,
                             const TypeRegistry& registry) {
  const auto start = std::chrono::steady_clock::now();
  NoiseEstimate noise;
  add_parameters(settings.odometry_model, registry.odometry_model(settings.odometry_model).options,
                 settings.odometry_options, noise.parameters);
  add_parameters(settings.modeling, registry.gnss_modeling(settings.modeling).options,
                 settings.modeling_options, noise.parameters);
  if (noise.parameters.empty()) return noise;
  Objective objective(placed, settings, registry);
  minimize(objective, noise);
  find_deviations(objective, noise);
  noise.evaluations = objective.evaluations();
  noise.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return noise;
}

FusionSettings with_noise(FusionSettings settings, const NoiseEstimate& noise) {
  for (const NoiseParameter& parameter : noise.parameters) {
    if (parameter.owner == settings.odometry_model)
      settings.odometry_options.try_emplace(parameter.option, shortest(parameter.value));
    if (parameter.owner == settings.modeling)
      settings.modeling_options.try_emplace(parameter.option, shortest(parameter.value));
  }
  return settings;
}

}  // namespace waymark::drive
