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

namespace {

/// A source with a modeling of its own has the gate that fits this one, if none is stated.
void decide_gates(FusionSettings& settings, const TypeRegistry& registry) {
  for (auto& [name, source] : settings.sources) {
    if (source.model.empty() || (source.gate && source.gate->enabled)) continue;
    const auto& known = registry.gnss_modelings();
    const auto type = std::find_if(known.begin(), known.end(), [&, model = source.model](const auto& of) {
      return of.type.name == model;
    });
    if (type == known.end()) continue;  // an odometry model, or refused when it is made
    if (!source.gate) source.gate = settings.gate;
    source.gate->enabled = !type->type.complete;
  }
}

/// Resolves the files that options of the drive and of its sources name.
void place_files_of_options(FusionSettings& settings, const TypeRegistry& registry) {
  if (settings.folder.empty()) return;
  const std::string folder = std::exchange(settings.folder, {});
  const auto place = [&](Options& options, const std::vector<OptionInfo>& known) {
    options = with_files_below(folder, std::move(options), known);
  };
  const std::vector<OptionInfo>& modeling = registry.gnss_modeling(settings.modeling).options;
  const std::vector<OptionInfo>& odometry = registry.odometry_model(settings.odometry_model).options;
  place(settings.modeling_options, modeling);
  place(settings.odometry_options, odometry);
  for (auto& [name, source] : settings.sources) {
    for (const auto& entry : registry.gnss_modelings())
      if (entry.type.name == (source.model.empty() ? settings.modeling : source.model))
        place(source.options, entry.type.options);
    for (const auto& entry : registry.odometry_models())
      if (entry.type.name == (source.model.empty() ? settings.odometry_model : source.model))
        place(source.options, entry.type.options);
  }
}

Options merged(Options first, const Options& then) {
  for (const auto& [name, value] : then) first[name] = value;
  return first;
}

const SourceSettings& stated_for(const FusionSettings& settings, const std::string& source) {
  static const SourceSettings kNone;
  const auto found = settings.sources.find(source);
  return found == settings.sources.end() ? kNone : found->second;
}

}  // namespace

std::string group_of(const FusionSettings& settings, const std::string& source) {
  std::string name = source;
  for (std::size_t steps = 0; steps <= settings.sources.size(); ++steps) {
    const std::string& next = stated_for(settings, name).common;
    if (next.empty()) return name;
    name = next;
  }
  throw UsageError("sources: the groups of '" + source + "' name each other in a ring (common)");
}

FusionSettings for_absolute(const FusionSettings& settings, const std::string& source,
                            const TypeRegistry& registry) {
  const SourceSettings& own = stated_for(settings, group_of(settings, source));
  FusionSettings result = settings;
  if (!own.model.empty() && own.model != settings.modeling) {
    result.modeling = own.model;
    result.modeling_options.clear();
  }
  const std::vector<OptionInfo>& known = registry.gnss_modeling(result.modeling).options;
  for (const auto& [name, value] : own.calibration)
    if (has_option(known, name)) result.modeling_options[name] = value;
  result.modeling_options =
      with_calibration(merged(std::move(result.modeling_options), own.options), result, known);
  if (own.loss) result.loss = *own.loss;
  if (const auto& gate = stated_for(settings, source).gate) {
    result.gate = *gate;
    if (!result.gate.enabled) result.gate.enabled = settings.gate.enabled;
  }
  return result;
}

void require_common_errors(const FusionSettings& settings, const std::string& group,
                           const TypeRegistry& registry) {
  const std::string modeling = for_absolute(settings, group, registry).modeling;
  if (!registry.gnss_modeling(modeling).shares_errors)
    throw UsageError("source '" + group + "': the modeling '" + modeling +
                     "' has no errors that sources could have in common; leave out 'common'");
}

FusionSettings for_relative(const FusionSettings& settings, const std::string& source) {
  const SourceSettings& own = stated_for(settings, source);
  FusionSettings result = settings;
  if (!own.model.empty() && own.model != settings.odometry_model) {
    result.odometry_model = own.model;
    result.odometry_options.clear();
  }
  result.odometry_options = merged(std::move(result.odometry_options), own.options);
  if (result.calibration) result.calibration = merged(*std::move(result.calibration), own.calibration);
  return result;
}

FusionSettings decided(FusionSettings settings, const TypeRegistry& registry) {
  const GnssModelingType& modeling = registry.gnss_modeling(settings.modeling);
  place_files_of_options(settings, registry);
  if (!settings.gate.enabled) decide_gates(settings, registry);
  if (!settings.gate.enabled) settings.gate.enabled = !modeling.complete;
  if (!settings.calibration) settings.calibration = modeling.complete ? default_calibration() : Options();
  if (!settings.estimates_noise) settings.estimates_noise = modeling.complete;
  settings.modeling_options =
      with_calibration(std::move(settings.modeling_options), settings, modeling.options);
  return settings;
}

void adapt_to_yaw_rate(const YawRateAtRest& rest, bool by_default, FusionSettings& settings,
                       const TypeRegistry& registry) {
  if (!rest.is_known() && !rest.is_derived()) return;
  constexpr double kSilent = 1;  // rad^2/s: says nothing
  constexpr const char* kAtRest = "gyro_at_rest_variance_per_s";
  const std::vector<OptionInfo>& known = registry.odometry_model(settings.odometry_model).options;
  const double variance = rest.is_derived() ? kSilent : std::min(rest.variance_per_s, kSilent);
  if (has_option(known, kAtRest) &&
      variance > CheckedOptions(settings.odometry_model, settings.odometry_options, known).number(kAtRest))
    settings.odometry_options.try_emplace(kAtRest, shortest(variance));
  if (rest.is_derived() && by_default && !settings.calibration->empty() && has_option(known, "yaw_per_speed"))
    settings.calibration->try_emplace("yaw_per_speed", "constant");
}

void adapt_to_yaw_rate_of(const std::string& source, const YawRateAtRest& rest, bool by_default,
                          FusionSettings& settings, const TypeRegistry& registry) {
  FusionSettings own = for_relative(settings, source);
  adapt_to_yaw_rate(rest, by_default, own, registry);
  SourceSettings& kept = settings.sources[source];
  kept.options = own.odometry_options;
  kept.calibration = *own.calibration;
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

std::optional<Loss> loss_of_source(const FusionSettings& settings, const std::string& source,
                                   const TypeRegistry& registry, const std::string& unstated) {
  return loss_of_fixes(stated_for(settings, source).loss.value_or(unstated), registry, source + ": loss");
}

std::optional<Loss> loss_of_fixes(const std::string& loss, const TypeRegistry& registry,
                                  const std::string& place) {
  if (loss.empty() || loss == "none") return std::nullopt;
  return named_loss(loss, place, registry);
}

}  // namespace waymark::drive
