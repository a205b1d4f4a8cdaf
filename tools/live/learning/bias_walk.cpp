#include <waymark/tools/live/learning/bias_walk.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include <waymark/core/registry/options.hpp>
#include <waymark/tools/drive/description/fusion_settings.hpp>
#include <waymark/tools/drive/estimation/noise.hpp>

namespace waymark::live {
namespace {

constexpr const char* kWalk = "gyro_bias_walk";

/// A walk, and the noise of the drive with it.
struct Candidate {
  double walk = 0;
  double cost = 0;
  drive::NoiseEstimate noise;
};

/// Returns the walk that settings state; empty if the model has no bias that walks.
std::optional<double> walk_of(const drive::FusionSettings& settings, const std::string& odometry,
                              const TypeRegistry& registry) {
  const drive::FusionSettings own = drive::for_relative(settings, odometry);
  const std::vector<OptionInfo>& known = registry.odometry_model(own.odometry_model).options;
  if (!has_option(known, kWalk)) return std::nullopt;
  const CheckedOptions options(own.odometry_model, drive::with_calibration(own.odometry_options, own, known),
                               known);
  if (options.word("gyro_bias") != "random_walk") return std::nullopt;
  return options.number(kWalk);
}

drive::FusionSettings with_walk(drive::FusionSettings settings, const std::string& odometry, double walk) {
  const auto own = settings.sources.find(odometry);
  Options& options = own != settings.sources.end() && own->second.options.contains(kWalk)
                         ? own->second.options
                         : settings.odometry_options;
  options[kWalk] = shortest(walk);
  return settings;
}

std::vector<Candidate> candidates(std::span<const drive::PreparedSensor> sensors, const std::string& odometry,
                                  double usual, const TypeRegistry& registry,
                                  const std::function<void()>& between, const drive::ModeledDrive& modeled) {
  constexpr double kDeviation = 1;  // of its logarithm, between gyros
  constexpr double kStep = 4;
  constexpr double kLargest = 2e-3;
  constexpr double kHopeless = 6;  // in logarithms of probability
  std::vector<Candidate> found;
  double least = std::numeric_limits<double>::infinity();
  for (double walk = usual; walk <= kLargest; walk *= kStep) {
    drive::NoiseEstimate noise =
        drive::estimate_noise(modeled.placed, sensors, with_walk(modeled.decision, odometry, walk), registry,
                              found.empty() ? modeled.noise : found.back().noise, between);
    const double cost = noise.cost + 0.5 * std::pow(std::log(walk / usual) / kDeviation, 2);
    least = std::min(least, cost);
    found.push_back({walk, cost, std::move(noise)});
    if (cost > least + kHopeless) break;
  }
  return found;
}

/// Returns the expected logarithm's walk. The expected square would be that of the largest walk that is not excluded:
/// after minutes of an outage nothing would be known of a sound gyro.
double expected_walk(const std::vector<Candidate>& of) {
  const double least = std::min_element(of.begin(), of.end(), [](const auto& a, const auto& b) {
                         return a.cost < b.cost;
                       })->cost;
  double sum = 0;
  double weights = 0;
  for (const Candidate& candidate : of) {
    const double weight = std::exp(least - candidate.cost);
    sum += weight * std::log(candidate.walk);
    weights += weight;
  }
  return std::exp(sum / weights);
}

}  // namespace

void take_bias_walk(std::span<const drive::PreparedSensor> sensors, const std::string& odometry,
                    const TypeRegistry& registry, const std::function<void()>& between,
                    drive::ModeledDrive& modeled) {
  const std::optional<double> usual = walk_of(modeled.decision, odometry, registry);
  if (!usual || !(*usual > 0) || modeled.noise.parameters.empty() || modeled.noise.is_poor_odometry(odometry))
    return;
  std::vector<Candidate> found = candidates(sensors, odometry, *usual, registry, between, modeled);
  if (found.empty()) return;
  const double walk = expected_walk(found);
  const auto nearest = std::min_element(found.begin(), found.end(), [&](const auto& a, const auto& b) {
    return std::abs(std::log(a.walk / walk)) < std::abs(std::log(b.walk / walk));
  });
  modeled.decision = with_walk(std::move(modeled.decision), odometry, walk);
  if (nearest != found.begin()) {
    modeled.noise = std::move(nearest->noise);
    drive::find_deviations(modeled.placed, sensors, modeled.decision, registry, modeled.noise, between);
  }
  modeled.settings = drive::with_noise(modeled.decision, modeled.noise);
}

}  // namespace waymark::live
