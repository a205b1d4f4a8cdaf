#include <waymark/tools/live/learning/claims_ahead.hpp>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include <waymark/core/registry/options.hpp>
#include <waymark/tools/live/learning/noise_ahead.hpp>

namespace waymark::live {
namespace {

constexpr const char* kExponent = "accuracy_exponent";
constexpr const char* kExponentSigma = "accuracy_exponent_sigma";
constexpr const char* kReference = "reference_accuracy";

/// Returns the deviation of the exponent in the time ahead. @param prior of the option
double exponent_sigma(const NoisePrior& prior, const std::string& group, const NoiseOfClaims& learned) {
  const auto& parameters = learned.noise.parameters;
  const auto told = std::find_if(parameters.begin(), parameters.end(), [&](const auto& of) {
    return of.option == kExponent && (of.source.empty() || of.source == group);
  });
  const bool known = told != parameters.end() && told->deviation > 0 && learned.length_s > 0;
  return known ? deviation_ahead(told->deviation, prior.deviation, learned.length_s) : prior.deviation;
}

/// Returns where the options of the modeling of a group of receivers are stated.
Options& options_of(const std::string& group, const drive::DriveDescription& description,
                    drive::FusionSettings& settings) {
  return description.gnss.size() == 1 ? settings.modeling_options : settings.sources[group].options;
}

/// Returns the median claim that the noise of a group of receivers is scaled by; 0: none.
double reference_m(const std::string& group, const drive::FusionSettings& settings,
                   const drive::DriveDescription& description, const NoiseOfClaims& learned) {
  for (const auto& [source, claimed] : learned.claimed)
    if (drive::group_of(settings, description.gnss[static_cast<std::size_t>(source)].name) == group)
      return claimed.reference_m();
  return 0;
}

}  // namespace

drive::FusionSettings with_claims_ahead(drive::FusionSettings settings, const drive::FusionSettings& stated,
                                        const drive::DriveDescription& description,
                                        const NoiseOfClaims& learned, const TypeRegistry& registry) {
  if (!settings.estimates_noise.value_or(false)) return settings;
  const drive::FusionSettings before = settings;
  for (const drive::GnssConfig& receiver : description.gnss) {
    const std::string group = drive::group_of(before, receiver.name);
    const drive::FusionSettings own = drive::for_absolute(before, group, registry);
    const Options given = drive::for_absolute(stated, group, registry).modeling_options;
    Options& options = options_of(group, description, settings);
    for (const OptionInfo& option : registry.gnss_modeling(own.modeling).options) {
      if (option.name == kExponent && option.prior && !given.contains(kExponent) &&
          !given.contains(kExponentSigma))
        options[kExponentSigma] = shortest(exponent_sigma(*option.prior, group, learned));
      if (option.name != kReference || given.contains(kReference)) continue;
      if (const double claim_m = reference_m(group, before, description, learned); claim_m > 0)
        options[kReference] = shortest(claim_m);
    }
  }
  return settings;
}

FusionSetup with_first_claims(FusionSetup setup, const drive::FusionSettings& stated,
                              const drive::DriveDescription& description, std::span<const Fix> fixes,
                              const TypeRegistry& registry) {
  // Without receivers the fixes are rough places by readings.
  if (!setup.settings.estimates_noise.value_or(false) || description.gnss.empty()) return setup;
  std::map<int, std::vector<Fix>> by_source;
  for (const Fix& fix : fixes) by_source[fix.source].push_back(fix);
  const drive::FusionSettings before = setup.settings;
  for (const auto& [source, own_fixes] : by_source) {
    const ClaimedAccuracies claimed = claimed_accuracies(own_fixes);
    const std::string group =
        drive::group_of(before, description.gnss[static_cast<std::size_t>(source)].name);
    const drive::FusionSettings own = drive::for_absolute(before, group, registry);
    const Options given = drive::for_absolute(stated, group, registry).modeling_options;
    Options& options = options_of(group, description, setup.settings);
    for (const OptionInfo& option : registry.gnss_modeling(own.modeling).options) {
      if (!option.prior || !option.prior->shrinks_with_claim || given.contains(option.name)) continue;
      const NoisePrior prior = drive::prior_for(*option.prior, claimed.reference_m());
      if (!(prior.mean < option.prior->mean)) continue;
      const double expected = prior.mean * std::exp(prior.deviation * prior.deviation);
      options[option.name] = shortest(std::min(expected, option.prior->mean));
      setup.claimed[source] = claimed;
    }
  }
  const drive::NoiseEstimate none;
  setup.settings =
      with_claims_ahead(std::move(setup.settings), stated, description, {none, 0, setup.claimed}, registry);
  return setup;
}

}  // namespace waymark::live
