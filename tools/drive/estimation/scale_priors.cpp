#include <waymark/tools/drive/estimation/scale_priors.hpp>

#include <cmath>
#include <optional>

#include <fmt/format.h>

#include <waymark/tools/drive/comparison/chords.hpp>

namespace waymark::drive {
namespace {

constexpr const char* kSpeedScale = "speed_scale";
constexpr const char* kYawScale = "yaw_scale";
constexpr const char* kYawPerSpeed = "yaw_per_speed";

bool is_one_of_several(const PlacedDrive& placed, const FusionSettings& decision) {
  return !placed.relative.empty() || decision.sources.contains(placed.odometry_name);
}

/// Returns the options of the model of the odometry, with its calibration.
Options odometry_options(const PlacedDrive& placed, const FusionSettings& decision,
                         const TypeRegistry& registry) {
  const FusionSettings own = for_relative(decision, placed.odometry_name);
  return with_calibration(own.odometry_options, own, registry.odometry_model(own.odometry_model).options);
}

/// An error of the odometry that the fixes show.
struct ShownError {
  const char* state;  ///< that calibrates it
  double size;        ///< in the unit of the state
  const char* what;   ///< differs by that
};

/// Returns that of a scale. @param factor of the distances or turns of the odometry
ShownError of_scale(const char* state, double factor, const char* what) {
  return {state, is_scale(factor) ? std::abs(1 / factor - 1) : 0, what};
}

/// Makes an error the sigma of its prior.
std::optional<std::string> widen_prior(const ShownError& error, const PlacedDrive& placed,
                                       const TypeRegistry& registry, FusionSettings& decision) {
  if (error.size == 0) return std::nullopt;
  const std::string prior = std::string(error.state) + "_sigma";
  const Options stated = odometry_options(placed, decision, registry);
  const auto state = stated.find(error.state);
  if (state == stated.end() || state->second == "off" || stated.contains(prior)) return std::nullopt;
  Options& options = is_one_of_several(placed, decision) ? decision.sources[placed.odometry_name].options
                                                         : decision.odometry_options;
  options[prior] = shortest(error.size);
  return fmt::format("{}{} is taken as {:.2g}, because the {} differ by that", of_several(placed), prior,
                     error.size, error.what);
}

/// @param state that is off by default
void calibrate(const std::string& state, const PlacedDrive& placed, const TypeRegistry& registry,
               FusionSettings& decision) {
  const std::string model = for_relative(decision, placed.odometry_name).odometry_model;
  if (!has_option(registry.odometry_model(model).options, state)) return;
  Options& calibration = is_one_of_several(placed, decision)
                             ? decision.sources[placed.odometry_name].calibration
                             : *decision.calibration;
  calibration.try_emplace(state, "constant");
}

}  // namespace

std::vector<std::string> adapt_to_scales(const PlacedDrive& placed, bool by_default,
                                         const TypeRegistry& registry, FusionSettings& decision) {
  std::vector<std::string> notes;
  const bool may_calibrate = by_default && !decision.calibration->empty();
  const auto widen = [&](const ShownError& error) {
    if (auto note = widen_prior(error, placed, registry, decision)) notes.push_back(*std::move(note));
  };
  widen(of_scale(kSpeedScale, placed.speed_factor.value_or(1), "distances"));
  if (placed.turn_factor) {
    if (may_calibrate) calibrate(kYawScale, placed, registry, decision);
    widen(of_scale(kYawScale, *placed.turn_factor, "turns"));
  }
  if (placed.yaw_bias && placed.yaw_bias->radpm != 0) {
    if (may_calibrate) calibrate(kYawPerSpeed, placed, registry, decision);
    widen({kYawPerSpeed, std::abs(placed.yaw_bias->radpm), "turns per metre"});
  }
  return notes;
}

}  // namespace waymark::drive
