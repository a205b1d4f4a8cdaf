#include <waymark/tools/drive/estimation/noise.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <optional>

#include <waymark/core/base/error.hpp>
#include <waymark/core/registry/options.hpp>
#include <waymark/tools/drive/estimation/coarse.hpp>
#include <waymark/tools/drive/estimation/noise_objective.hpp>
#include <waymark/tools/drive/estimation/noise_spread.hpp>
#include <waymark/tools/drive/estimation/posterior_mode.hpp>
#include <waymark/tools/drive/model/build.hpp>

namespace waymark::drive {
namespace {

/// Tells whether a noise parameter has an effect with these options.
bool takes_effect(const NoisePrior& prior, const std::vector<OptionInfo>& known, const Options& given) {
  if (prior.where_option.empty()) return true;
  if (const auto stated = given.find(prior.where_option); stated != given.end())
    return stated->second == prior.where_word;
  return std::any_of(known.begin(), known.end(), [&](const OptionInfo& option) {
    return option.name == prior.where_option && option.value == prior.where_word;
  });
}

/// Adds options with a prior that are not stated.
void add_parameters(const std::string& source, const std::string& owner, const std::vector<OptionInfo>& known,
                    const Options& given, const ClaimedAccuracies& claimed, double reach,
                    std::vector<NoiseParameter>& parameters) {
  for (const OptionInfo& option : known) {
    if (!option.prior || given.contains(option.name)) continue;
    if (option.prior->between_kinds && claimed.kinds() < 2) continue;
    if (!takes_effect(*option.prior, known, given)) continue;
    NoiseParameter parameter;
    parameter.source = source;
    parameter.owner = owner;
    parameter.option = option.name;
    parameter.unit = option.unit;
    parameter.range = std::get<OptionRange>(option.allowed);
    parameter.prior = prior_for(*option.prior, claimed.reference_m());
    parameter.reach = parameter.prior.linear ? kUsualNoise : reach;
    place_at(0, parameter);
    parameters.push_back(std::move(parameter));
  }
}

/// A parameter may leave its prior as far as its reach says, but not what its option allows.
PosteriorBounds bounds_of(const NoiseEstimate& noise) {
  const auto size = static_cast<Eigen::Index>(noise.parameters.size());
  PosteriorBounds bounds{Eigen::VectorXd(size), Eigen::VectorXd(size)};
  Eigen::Index i = 0;
  for (const NoiseParameter& parameter : noise.parameters) {
    bounds.low[i] = std::max(-kUsualNoise, coordinate_of(parameter.range.low, parameter.prior));
    bounds.high[i] = std::min(parameter.reach, coordinate_of(parameter.range.high, parameter.prior));
    ++i;
  }
  return bounds;
}

PosteriorCost cost_of(NoiseObjective& objective, NoiseEstimate& noise) {
  return {[&](const Eigen::VectorXd& at, Eigen::VectorXd* gradient) {
            place_at(at, noise);
            return gradient == nullptr ? objective.at(noise) : objective.with_gradient(noise, *gradient);
          },
          [&] { objective.stay(); }};
}

/// In deviations of a prior.
constexpr double kFar = 2.5;

/// Returns where to begin once more: where parameters have left their priors far behind, the others lost
/// their way with them, and begin again at their priors. Empty if none has.
std::optional<Eigen::VectorXd> second_start(const Eigen::VectorXd& found) {
  if (found.cwiseAbs().maxCoeff() < kFar) return {};
  return (found.array().abs() < kFar).select(0, found);
}

/// Finds the minimum. Where the curvature of the noise is known, its values are near it. Otherwise the search
/// may find two minima (a poor gyro with short or long errors of the fixes); the lower one counts.
void minimize(NoiseObjective& objective, NoiseEstimate& noise) {
  const PosteriorBounds bounds = bounds_of(noise);
  const PosteriorCost cost = cost_of(objective, noise);
  const Eigen::VectorXd start = coordinates_of(noise).cwiseMax(bounds.low).cwiseMin(bounds.high);
  const auto from = [&](const Eigen::VectorXd& at) {
    return find_posterior_mode(cost, search_posterior(cost, at, bounds), bounds);
  };
  const bool is_near = noise.curvature.size() > 0;
  PosteriorMode mode = is_near ? find_posterior_mode(cost, {start, noise.curvature}, bounds) : from(start);
  if (const auto again = is_near ? std::nullopt : second_start(mode.at)) {
    const double least = cost.at(mode.at, nullptr);
    const PosteriorMode other = from(*again);
    if (cost.at(other.at, nullptr) < least) mode = other;
  }
  place_at(mode.at, noise);
  noise.curvature = mode.curvature;
}

/// Begins with an odometry that is worth little: one of its parameters, or all, are far beyond their priors,
/// whichever costs least. @returns the cost
double begin_with_poor_odometry(NoiseObjective& objective, NoiseEstimate& noise) {
  constexpr double kPoor = 7;  // deviations
  std::vector<std::size_t> poor;
  for (std::size_t i = 0; i < noise.parameters.size(); ++i)
    if (noise.parameters[i].reach > kPoor) poor.push_back(i);
  std::vector<std::vector<std::size_t>> ways = {poor};
  if (poor.size() > 1)
    for (const std::size_t one : poor) ways.push_back({one});
  NoiseEstimate best = noise;
  double least = std::numeric_limits<double>::infinity();
  for (const std::vector<std::size_t>& way : ways) {
    NoiseEstimate there = noise;
    for (NoiseParameter& parameter : there.parameters) place_at(0, parameter);
    for (const std::size_t i : way) place_at(kPoor, there.parameters[i]);
    const double cost = objective.at(there);
    if (!(cost < least)) continue;
    least = cost;
    best = there;
  }
  noise = best;
  return least;
}

/// What is estimated together: the parameters of one relative source, with those of the absolute ones if
/// it is the first.
struct Part {
  CoarseDrive coarse;
  FusionSettings settings;  ///< with what the parts before it have estimated
  NoiseEstimate noise;
  bool has_absolute = true;  ///< its parameters have those of the absolute sources among them
};

/// Takes the values of the same parameters and their curvature, if all of them are known.
void take_known(const NoiseEstimate& known, NoiseEstimate& noise) {
  std::vector<Eigen::Index> places;
  for (const NoiseParameter& parameter : noise.parameters) {
    const auto same = std::find_if(known.parameters.begin(), known.parameters.end(), [&](const auto& other) {
      return other.owner == parameter.owner && other.name() == parameter.name();
    });
    if (same == known.parameters.end()) return;
    places.push_back(same - known.parameters.begin());
  }
  for (std::size_t i = 0; i < places.size(); ++i)
    noise.parameters[i].value = known.parameters[static_cast<std::size_t>(places[i])].value;
  noise.curvature = known.curvature(places, places);
}

double measured_s(const CoarseDrive& coarse) {
  double sum_s = 0;
  for (const Interval& interval : coarse.drive.timeline.intervals)
    sum_s += interval.bridged ? 0 : interval.dt_s;
  return sum_s;
}

/// Takes the minimum of a piece of a long drive, where an evaluation costs little, if it is nearer to the
/// minimum of the whole than what is known before. The curvature of the likelihood grows with the drive.
void begin_with_piece(const Part& part, const TypeRegistry& registry, const std::function<void()>& between,
                      NoiseObjective& whole, NoiseEstimate& noise) {
  constexpr double kPiece_s = 600;
  constexpr double kLongDrive = 3;  // pieces
  const double whole_s = measured_s(part.coarse);
  if (whole_s < kLongDrive * kPiece_s) return;
  const CoarseDrive piece = middle_of(part.coarse, kPiece_s);
  NoiseEstimate found = noise;
  try {
    NoiseObjective objective(piece, part.settings, registry, between);
    minimize(objective, found);
  } catch (const InputError&) {
    return;  // the vehicle stands there all the time: the piece determines no poses
  }
  if (!(whole.at(found) < whole.at(noise))) return;
  const auto prior = Eigen::MatrixXd::Identity(found.curvature.rows(), found.curvature.cols());
  found.curvature = prior + whole_s / measured_s(piece) * (found.curvature - prior);
  noise = found;
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
  const std::vector<OptionInfo>& known = registry.odometry_model(own.odometry_model).options;
  add_parameters(label(relative, count), own.odometry_model, known,
                 with_calibration(own.odometry_options, own, known), {}, kNoiseReach, noise.parameters);
  if (!absolute) return noise;
  for (const AbsoluteGroup& group : facts.absolute) {
    const FusionSettings of = for_absolute(settings, group.name, registry);
    add_parameters(label(group.name, facts.absolute.size()), of.modeling,
                   registry.gnss_modeling(of.modeling).options, of.modeling_options, group.claimed,
                   kUsualNoise, noise.parameters);
  }
  for (const PreparedSensor& sensor : coarse.sensors)
    add_parameters(sensor.source, sensor.name, registry.sensor_model(sensor.name).options,
                   options_of(sensor, settings), {}, kUsualNoise, noise.parameters);
  return noise;
}

/// Adds what was estimated apart from the rest.
void append(const NoiseEstimate& part, NoiseEstimate& noise) {
  if (!part.spread.empty()) noise.spread = part.spread;
  noise.parameters.insert(noise.parameters.end(), part.parameters.begin(), part.parameters.end());
  noise.evaluations += part.evaluations;
  noise.cost += part.cost;
  const Eigen::Index before = noise.curvature.rows();
  const auto size = static_cast<Eigen::Index>(noise.parameters.size());
  Eigen::MatrixXd curvature = Eigen::MatrixXd::Zero(size, size);
  curvature.topLeftCorner(before, before) = noise.curvature;
  if (part.curvature.size() > 0) curvature.bottomRightCorner(size - before, size - before) = part.curvature;
  noise.curvature = std::move(curvature);
}

/// Returns sensors as their types want them for this search.
std::vector<PreparedSensor> for_noise_search(std::span<const PreparedSensor> sensors,
                                             const TypeRegistry& registry) {
  std::vector<PreparedSensor> result;
  for (const PreparedSensor& sensor : sensors) {
    const SensorModelType::NoiseSearch& search = registry.sensor_model(sensor.name).noise_search;
    PreparedSensor& changed = result.emplace_back(thinned(sensor, search.period_s));
    for (const auto& [option, value] : search.options) changed.options[option] = value;
  }
  return result;
}

/// Visits the parts of a drive one after the other. A visit may change the noise of its part, for those
/// that follow. @returns all of the noise
template <typename Visit>
NoiseEstimate visit_parts(const PlacedDrive& placed, std::span<const PreparedSensor> sensors,
                          const FusionSettings& settings, const TypeRegistry& registry, const Visit& visit) {
  const auto start = std::chrono::steady_clock::now();
  NoiseEstimate noise;
  FusionSettings known = settings;
  const CoarseDrive all = sample_of(coarsen(placed, for_noise_search(sensors, registry)));
  const std::size_t count = std::max<std::size_t>(placed.relative.size(), 1);
  for (std::size_t source = 0; source < count; ++source) {
    Part part{with_only(source, all), known, {}, source == 0};
    part.noise = open_parameters(part.coarse, count, part.has_absolute, known, registry);
    if (part.noise.parameters.empty()) continue;
    visit(part);
    append(part.noise, noise);
    known = with_noise(std::move(known), part.noise);
  }
  if (!noise.parameters.empty())
    noise.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return noise;
}

/// Returns where the settings have a parameter: at its source, or at the models of that name.
std::vector<Options*> options_with(const NoiseParameter& parameter, FusionSettings& settings) {
  if (!parameter.source.empty()) return {&settings.sources[parameter.source].options};
  std::vector<Options*> found;
  if (parameter.owner == settings.odometry_model) found.push_back(&settings.odometry_options);
  if (parameter.owner == settings.modeling) found.push_back(&settings.modeling_options);
  return found;
}

}  // namespace

NoisePrior prior_for(const NoisePrior& general, double accuracy_m) {
  constexpr double kCoarse_m = 0.5;
  NoisePrior prior = general;
  if (prior.shrinks_with_claim && accuracy_m > 0) prior.mean *= std::min(1.0, accuracy_m / kCoarse_m);
  return prior;
}

bool NoiseEstimate::is_poor_odometry(const std::string& name) const {
  return std::any_of(parameters.begin(), parameters.end(), [&](const NoiseParameter& of) {
    return of.reach > kUsualNoise && (of.source.empty() || of.source == name) &&
           coordinate_of(of.value, of.prior) > kUsualNoise;
  });
}

bool NoiseEstimate::fixes_are_poor() const {
  return std::any_of(parameters.begin(), parameters.end(), [](const NoiseParameter& of) {
    return of.reach == kUsualNoise && !of.prior.linear && coordinate_of(of.value, of.prior) > kFar;
  });
}

NoiseEstimate estimate_noise(const PlacedDrive& placed, std::span<const PreparedSensor> sensors,
                             const FusionSettings& settings, const TypeRegistry& registry,
                             const NoiseEstimate& near, const std::function<void()>& between) {
  return visit_parts(placed, sensors, settings, registry, [&](Part& part) {
    NoiseObjective objective(part.coarse, part.settings, registry, between);
    take_known(near, part.noise);
    const bool is_new = part.noise.curvature.size() == 0;
    if (is_new && placed.start.follows_fixes && part.has_absolute)
      (void)begin_with_poor_odometry(objective, part.noise);
    else if (is_new)
      begin_with_piece(part, registry, between, objective, part.noise);
    minimize(objective, part.noise);
    if (part.has_absolute) part.noise.cost = objective.at(part.noise);
    part.noise.evaluations = objective.evaluations();
  });
}

bool may_be_poor_odometry(const PlacedDrive& along, std::span<const PreparedSensor> sensors,
                          const FusionSettings& settings, const TypeRegistry& registry,
                          const NoiseEstimate& noise) {
  constexpr double kOfEachFix = 2.5;
  const bool any_open = std::any_of(noise.parameters.begin(), noise.parameters.end(),
                                    [](const NoiseParameter& of) { return of.reach > kUsualNoise; });
  if (!any_open) return false;
  if (coordinates_of(noise).maxCoeff() > kFar) return true;
  double rise = -noise.cost;
  std::size_t fixes = 0;
  visit_parts(along, sensors, settings, registry, [&](Part& part) {
    if (!part.has_absolute) return;
    NoiseObjective objective(part.coarse, part.settings, registry, {});
    rise += begin_with_poor_odometry(objective, part.noise);
    fixes = part.coarse.drive.fixes.size();
  });
  return rise < kOfEachFix * static_cast<double>(fixes);
}

void find_deviations(const PlacedDrive& placed, std::span<const PreparedSensor> sensors,
                     const FusionSettings& settings, const TypeRegistry& registry, NoiseEstimate& noise,
                     const std::function<void()>& between) {
  NoiseEstimate known = visit_parts(placed, sensors, settings, registry, [&](Part& part) {
    NoiseObjective objective(part.coarse, part.settings, registry, between);
    take_known(noise, part.noise);
    const PosteriorMode mode{coordinates_of(part.noise), part.noise.curvature};
    NoiseEstimate moved = part.noise;
    const Eigen::MatrixXd covariance =
        posterior_covariance(cost_of(objective, moved), mode, bounds_of(part.noise));
    for (Eigen::Index i = 0; i < mode.at.size(); ++i) {
      NoiseParameter& parameter = part.noise.parameters[static_cast<std::size_t>(i)];
      parameter.deviation = std::sqrt(covariance(i, i)) * parameter.prior.deviation;
    }
    if (part.has_absolute) part.noise.spread = spread_over_noise(objective, part.noise, covariance);
    part.noise.evaluations = objective.evaluations();
  });
  known.evaluations += noise.evaluations;
  known.seconds += noise.seconds;
  noise = std::move(known);
}

FusionSettings with_noise(FusionSettings settings, const NoiseEstimate& noise) {
  for (const NoiseParameter& parameter : noise.parameters)
    for (Options* options : options_with(parameter, settings))
      options->try_emplace(parameter.option, shortest(parameter.value));
  return settings;
}

FusionSettings without_noise(FusionSettings settings, const NoiseEstimate& noise) {
  for (const NoiseParameter& parameter : noise.parameters)
    for (Options* options : options_with(parameter, settings)) options->erase(parameter.option);
  return settings;
}

}  // namespace waymark::drive
