#include <waymark/tools/drive/estimation/noise.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>

#include <waymark/core/base/error.hpp>
#include <waymark/core/registry/options.hpp>
#include <waymark/tools/drive/estimation/coarse.hpp>
#include <waymark/tools/drive/estimation/noise_objective.hpp>
#include <waymark/tools/drive/estimation/posterior_mode.hpp>
#include <waymark/tools/drive/model/build.hpp>

namespace waymark::drive {
namespace {

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
    place_at(0, parameter);
    parameters.push_back(std::move(parameter));
  }
}

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

/// @param begins_near whether the values of the noise are near the minimum @param between as for estimate_noise()
void minimize(NoiseObjective& objective, bool begins_near, const std::function<void()>& between,
              NoiseEstimate& noise) {
  const PosteriorBounds bounds = bounds_of(noise);
  const PosteriorCost cost{[&](const Eigen::VectorXd& at, Eigen::VectorXd* gradient) {
                             if (between) between();
                             place_at(at, noise);
                             return gradient == nullptr ? objective.at(noise)
                                                        : objective.with_gradient(noise, *gradient);
                           },
                           [&] { objective.stay(); }};
  const Eigen::VectorXd start = coordinates_of(noise).cwiseMax(bounds.low).cwiseMin(bounds.high);
  const Eigen::VectorXd near = begins_near ? start : search_posterior(cost, start, bounds);
  const PosteriorMode mode = find_posterior_mode(cost, near, bounds);
  place_at(mode.at, noise);
  for (Eigen::Index i = 0; i < mode.at.size(); ++i) {
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
                             const NoiseEstimate& near, const std::function<void()>& between) {
  const auto start = std::chrono::steady_clock::now();
  NoiseEstimate noise;
  FusionSettings known = settings;
  const CoarseDrive all = coarsen(placed, sensors);
  const std::size_t count = std::max<std::size_t>(placed.relative.size(), 1);
  for (std::size_t source = 0; source < count; ++source) {
    const CoarseDrive coarse = with_only(source, all);
    NoiseEstimate part = open_parameters(coarse, count, source == 0, known, registry);
    if (part.parameters.empty()) continue;
    NoiseObjective objective(coarse, known, registry);
    const bool begins_near = take_values(near, part);
    minimize(objective, begins_near, between, part);
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
