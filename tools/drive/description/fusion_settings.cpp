#include <waymark/tools/drive/description/fusion_settings.hpp>

#include <algorithm>
#include <charconv>
#include <utility>

#include <waymark/core/base/error.hpp>
#include <waymark/core/base/suggest.hpp>

namespace waymark::drive {

Options default_calibration() {
  return {{"gyro_bias", "random_walk"}, {"speed_scale", "random_walk"}, {"time_offset", "constant"}};
}

FusionSettings decided(FusionSettings settings, const TypeRegistry& registry) {
  const GnssModelingType& modeling = registry.gnss_modeling(settings.modeling);
  if (!settings.gate.enabled) settings.gate.enabled = !modeling.complete;
  if (!settings.calibration) settings.calibration = modeling.complete ? default_calibration() : Options();
  if (!settings.estimates_noise) settings.estimates_noise = modeling.complete;
  settings.modeling_options =
      with_calibration(std::move(settings.modeling_options), settings, modeling.options);
  return settings;
}

void adapt_to_yaw_rate(const YawRateAtRest& rest, bool by_default, FusionSettings& settings,
                       const TypeRegistry& registry) {
  if (!rest.is_known()) return;
  constexpr double kSilent = 1;  // rad^2/s: says nothing
  constexpr const char* kAtRest = "gyro_at_rest_variance_per_s";
  const std::vector<OptionInfo>& known = registry.odometry_model(settings.odometry_model).options;
  const double variance = rest.is_derived() ? kSilent : std::min(rest.variance_per_s, kSilent);
  if (has_option(known, kAtRest) &&
      variance > CheckedOptions(settings.odometry_model, {}, known).number(kAtRest))
    settings.odometry_options.try_emplace(kAtRest, shortest(variance));
  if (rest.is_derived() && by_default && !settings.calibration->empty() && has_option(known, "yaw_per_speed"))
    settings.calibration->try_emplace("yaw_per_speed", "constant");
}

Options with_calibration(Options options, const FusionSettings& settings,
                         const std::vector<OptionInfo>& known) {
  for (const auto& [name, value] : settings.calibration.value_or(Options())) {
    if (has_option(known, name)) options.try_emplace(name, value);
  }
  return options;
}

Loss named_loss(const std::string& text, const std::string& place, const TypeRegistry& registry) {
  const auto colon = text.find(':');
  const std::string name = text.substr(0, colon);
  const LossType* type = registry.find_loss(name);
  if (type == nullptr) {
    std::vector<std::string_view> names;
    for (const auto& [known, origin] : registry.losses()) names.push_back(known.name);
    throw UsageError(place + ": unknown loss '" + name + "'" + suggestion(name, names));
  }
  double scale = 0;
  const char* first = text.data() + (colon == std::string::npos ? text.size() : colon + 1);
  const char* last = text.data() + text.size();
  const auto [end, error] = std::from_chars(first, last, scale);
  if (error != std::errc() || end != last || !(scale > 0) || !(scale < 1e300)) {
    throw UsageError(place + ": expected [TAG=]NAME:SCALE with a scale above 0, got '" + text + "'");
  }
  return Loss{type->name, type->evaluate, scale};
}

std::optional<Loss> loss_of_fixes(const std::string& loss, const TypeRegistry& registry,
                                  const std::string& place) {
  if (loss.empty() || loss == "none") return std::nullopt;
  return named_loss(loss, place, registry);
}

}  // namespace waymark::drive
