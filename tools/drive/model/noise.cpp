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
#include <waymark/tools/drive/model/coarse.hpp>
#include <waymark/types_se2/vertex_se2.hpp>

namespace waymark::drive {
namespace {

/// One estimated number, as the search sees it: the logarithm, or the number itself.
double to_search(const NoisePrior& prior, double value) {
  return prior.linear ? value : std::log(value);
}
double from_search(const NoisePrior& prior, double coordinate) {
  return prior.linear ? coordinate : std::exp(coordinate);
}

/// Options with a prior that nobody stated.
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
  Objective(const PlacedDrive& placed, const DriveConfig& config, const std::string& modeling,
            const Options& modeling_options, const TypeRegistry& registry, const Eigen::Vector2d& antenna_m,
            const std::optional<Loss>& loss)
      : coarse_(coarsen(placed)),
        antenna_m_(antenna_m),
        config_(config),
        modeling_(modeling),
        modeling_options_(modeling_options),
        registry_(registry),
        loss_(loss),
        algorithm_(registry.make_algorithm("dogleg")) {}

  double operator()(const NoiseEstimate& noise) {
    ++evaluations_;
    Graph graph = build(noise);
    prepare(graph);
    OptimizerOptions options;
    options.decrement_tolerance = 1e-7;
    options.max_iterations = 60;
    const Summary summary = optimize(graph, structure_, *algorithm_, cholesky_, options);
    const double found = evidence(graph, structure_, cholesky_).negative_log();
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
  Graph build(const NoiseEstimate& noise) const {
    DriveConfig config = config_;
    config.odometry_options = with_noise(config.odometry_options, noise, config.odometry_model);
    Graph graph;
    std::vector<VertexIndex> poses;
    for (std::size_t i = 0; i < coarse_.stamps.size(); ++i) {
      const Eigen::Vector3d& pose = coarse_.poses[i];
      poses.push_back(graph.add_vertex<VertexSe2>(static_cast<VertexId>(i) + 1, {pose[0], pose[1], pose[2]}));
      graph.set_stamp(poses.back(), coarse_.stamps[i]);
    }
    make_odometry_model(config, registry_)->build({coarse_.stamps, poses, coarse_.intervals}, graph);
    registry_.make_gnss_modeling(modeling_, with_noise(modeling_options_, noise, modeling_))
        ->build({coarse_.fixes, coarse_.motion, antenna_m_, loss_}, graph);
    return graph;
  }

  /// The same vertices and edges every time: structure and analysis are made once, and the search goes on
  /// from where the last minimum was.
  void prepare(Graph& graph) {
    if (!values_.empty()) {
      graph.set_values(values_);
      return;
    }
    if (evaluations_ > 1) return;
    structure_.build(graph, find_gauge(graph).held);
    cholesky_.analyze(structure_.pattern());
  }

  CoarseDrive coarse_;
  Eigen::Vector2d antenna_m_;
  const DriveConfig& config_;
  const std::string& modeling_;
  const Options& modeling_options_;
  const TypeRegistry& registry_;
  const std::optional<Loss>& loss_;
  std::unique_ptr<Algorithm> algorithm_;
  Structure structure_;
  BlockCholesky cholesky_;
  std::vector<double> values_;
  int evaluations_ = 0;
};

/// The search behind a C interface.
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

/// BOBYQA (Powell 2009): no derivatives, within bounds. A parameter may leave its prior by four deviations.
void minimize(Objective& objective, NoiseEstimate& noise) {
  constexpr double kReach = 4;
  constexpr double kTolerance = 0.05;  // of a deviation of the prior
  const auto size = static_cast<unsigned>(noise.parameters.size());
  std::vector<double> at(size), low(size), high(size), step(size), tolerance(size);
  for (unsigned i = 0; i < size; ++i) {
    const NoisePrior& prior = noise.parameters[i].prior;
    at[i] = to_search(prior, prior.mean);
    low[i] = at[i] - kReach * prior.deviation;
    high[i] = at[i] + kReach * prior.deviation;
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

/// Standard deviations from second differences at the minimum.
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

NoiseEstimate estimate_noise(const PlacedDrive& placed, const DriveConfig& config,
                             const std::string& modeling, const Options& modeling_options,
                             const TypeRegistry& registry, const Eigen::Vector2d& antenna_m,
                             const std::optional<Loss>& loss) {
  const auto start = std::chrono::steady_clock::now();
  NoiseEstimate noise;
  add_parameters(config.odometry_model, registry.odometry_model(config.odometry_model).options,
                 config.odometry_options, noise.parameters);
  add_parameters(modeling, registry.gnss_modeling(modeling).options, modeling_options, noise.parameters);
  if (noise.parameters.empty()) return noise;
  Objective objective(placed, config, modeling, modeling_options, registry, antenna_m, loss);
  minimize(objective, noise);
  find_deviations(objective, noise);
  noise.evaluations = objective.evaluations();
  noise.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return noise;
}

Options with_noise(Options options, const NoiseEstimate& noise, const std::string& owner) {
  for (const NoiseParameter& parameter : noise.parameters) {
    if (parameter.owner == owner) options.try_emplace(parameter.option, shortest(parameter.value));
  }
  return options;
}

}  // namespace waymark::drive
