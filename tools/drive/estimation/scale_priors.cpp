#include <waymark/tools/drive/estimation/scale_priors.hpp>

#include <cmath>
#include <optional>

#include <fmt/format.h>

#include <waymark/tools/drive/comparison/chords.hpp>

namespace waymark::drive {
namespace {

constexpr const char* kSpeedScale = "speed_scale";
constexpr const char* kYawScale = "yaw_scale";

bool is_one_of_several(const PlacedDrive& placed, const FusionSettings& decision) {
  return !placed.relative.empty() || decision.sources.contains(placed.odometry_name);
}

/// Returns the options of the model of the odometry, with its calibration.
Options odometry_options(const PlacedDrive& placed, const FusionSettings& decision,
                         const TypeRegistry& registry) {
  const FusionSettings own = for_relative(decision, placed.odometry_name);
  return with_calibration(own.odometry_options, own, registry.odometry_model(own.odometry_model).options);
}

/// @param factor of the distances or turns of the odometry @param name of the state
std::optional<std::string> widen_prior(double factor, const std::string& name, const char* what,
                                       const PlacedDrive& placed, const TypeRegistry& registry,
                                       FusionSettings& decision) {
  if (factor == 1 || !is_scale(factor)) return std::nullopt;
  const std::string prior = name + "_sigma";
  const Options stated = odometry_options(placed, decision, registry);
  const auto state = stated.find(name);
  if (state == stated.end() || state->second == "off" || stated.contains(prior)) return std::nullopt;
  Options& options = is_one_of_several(placed, decision) ? decision.sources[placed.odometry_name].options
                                                         : decision.odometry_options;
  const double sigma = std::abs(1 / factor - 1);
  options[prior] = shortest(sigma);
  return fmt::format("{}{} is taken as {:.2g}, because the {} differ by that", of_several(placed), prior,
                     sigma, what);
}

void calibrate_yaw_scale(const PlacedDrive& placed, const TypeRegistry& registry, FusionSettings& decision) {
  const std::string model = for_relative(decision, placed.odometry_name).odometry_model;
  if (!has_option(registry.odometry_model(model).options, kYawScale)) return;
  Options& calibration = is_one_of_several(placed, decision)
                             ? decision.sources[placed.odometry_name].calibration
                             : *decision.calibration;
  calibration.try_emplace(kYawScale, "constant");
}

}  // namespace

std::vector<std::string> adapt_to_scales(const PlacedDrive& placed, bool by_default,
                                         const TypeRegistry& registry, FusionSettings& decision) {
  std::vector<std::string> notes;
  const auto widen = [&](double factor, const char* name, const char* what) {
    if (auto note = widen_prior(factor, name, what, placed, registry, decision))
      notes.push_back(*std::move(note));
  };
  widen(placed.speed_factor.value_or(1), kSpeedScale, "distances");
  if (!placed.turn_factor) return notes;
  if (by_default && !decision.calibration->empty()) calibrate_yaw_scale(placed, registry, decision);
  widen(*placed.turn_factor, kYawScale, "turns");
  return notes;
}

}  // namespace waymark::drive
