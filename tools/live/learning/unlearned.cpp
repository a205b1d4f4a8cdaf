#include <waymark/tools/live/learning/unlearned.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <variant>
#include <vector>

#include <waymark/tools/drive/logs/parts/odometry_parts.hpp>
#include <waymark/tools/live/learning/gyro_shown.hpp>

namespace waymark::live {
namespace {

/// Returns where the options of an odometry are stated: its own if it is one of several.
Options& own_options(drive::FusionSettings& settings, const drive::DriveDescription& description,
                     std::size_t odometry) {
  if (description.odometry.size() == 1) return settings.odometry_options;
  return settings.sources[description.odometry[odometry].name].options;
}

/// States options of one odometry that are not stated.
class Assumptions {
 public:
  /// @param odometry index in the description
  Assumptions(const drive::DriveDescription& description, std::size_t odometry,
              drive::FusionSettings& settings, const TypeRegistry& registry) {
    const drive::FusionSettings own = drive::for_relative(settings, description.odometry[odometry].name);
    known_ = &registry.odometry_model(own.odometry_model).options;
    given_ = own.odometry_options;
    options_ = &own_options(settings, description, odometry);
  }
  void state(const std::string& option, const std::string& value) {
    if (has_option(*known_, option) && !given_.contains(option)) options_->emplace(option, value);
  }
  [[nodiscard]] const std::vector<OptionInfo>& known() const { return *known_; }

 private:
  const std::vector<OptionInfo>* known_;
  Options given_;
  Options* options_;
};

bool is_gyro(const drive::OdometryConfig& odometry) {
  return !drive::is_from_wheels_or_steering(odometry.assembly.yaw_rate_from);
}

std::string expected(const OptionInfo& option) {
  const NoisePrior& prior = *option.prior;
  const double value =
      prior.linear ? prior.mean : prior.mean * std::exp(0.5 * prior.deviation * prior.deviation);
  const auto& range = std::get<OptionRange>(option.allowed);
  return shortest(std::clamp(value, range.low, range.high));
}

}  // namespace

drive::FusionSettings with_open_calibration(drive::FusionSettings stated,
                                            const drive::DriveDescription& description,
                                            const DriveSoFar& so_far, const TypeRegistry& registry) {
  const bool by_default = !stated.calibration || *stated.calibration == drive::default_calibration();
  const bool calibrates = by_default && !drive::decided(stated, registry).calibration->empty();
  for (std::size_t source = 0; source < description.odometry.size(); ++source) {
    Assumptions assume(description, source, stated, registry);
    if (is_gyro(description.odometry[source])) {
      assume.state("gyro_bias_sigma", "0.05");
      assume.state("gyro_bias_walk", shortest(bias_walk_of(so_far.odometry(source))));
    } else {
      if (calibrates) assume.state("yaw_scale", "constant");
      assume.state("yaw_per_speed_sigma", "0.005");
      assume.state("yaw_scale_sigma", "0.05");
    }
  }
  return stated;
}

bool walk_is_open(const drive::FusionSettings& stated, const drive::DriveDescription& description) {
  const drive::OdometryConfig& first = description.odometry.front();
  return is_gyro(first) &&
         !drive::for_relative(stated, first.name).odometry_options.contains("gyro_bias_walk");
}

drive::FusionSettings with_usual_noise(drive::FusionSettings settings,
                                       const drive::DriveDescription& description,
                                       const TypeRegistry& registry) {
  if (!settings.estimates_noise.value_or(false)) return settings;
  for (std::size_t source = 0; source < description.odometry.size(); ++source) {
    Assumptions assume(description, source, settings, registry);
    for (const OptionInfo& option : assume.known())
      if (option.prior) assume.state(option.name, expected(option));
  }
  return settings;
}

drive::FusionSettings with_noise_of_readings(drive::FusionSettings settings,
                                             const drive::FusionSettings& stated,
                                             const drive::DriveDescription& description,
                                             const DriveSoFar& so_far, const TypeRegistry& registry) {
  constexpr const char* kHeading = "heading_variance_per_s";
  if (!settings.estimates_noise.value_or(false)) return settings;
  for (std::size_t source = 0; source < description.odometry.size(); ++source) {
    const drive::OdometryConfig& odometry = description.odometry[source];
    const drive::FusionSettings own = drive::for_relative(settings, odometry.name);
    const std::vector<OptionInfo>& known = registry.odometry_model(own.odometry_model).options;
    const bool is_stated = drive::for_relative(stated, odometry.name).odometry_options.contains(kHeading);
    if (!is_gyro(odometry) || is_stated || !has_option(known, kHeading)) continue;
    const double shown = white_noise_of(so_far.odometry(source));
    if (shown <= CheckedOptions(own.odometry_model, own.odometry_options, known).number(kHeading)) continue;
    own_options(settings, description, source)[kHeading] = shortest(std::min(shown, 1.0));
  }
  return settings;
}

}  // namespace waymark::live
