#include <waymark/tools/drive/model/fuse.hpp>

#include <cmath>
#include <cstdio>

#include <waymark/tools/drive/estimation/latency.hpp>
#include <waymark/tools/drive/model/build.hpp>
#include <waymark/tools/drive/model/provenance.hpp>

namespace waymark::drive {
namespace {

double distance_of(const Timeline& timeline) {
  double distance_m = 0;
  for (const Interval& interval : timeline.intervals)
    distance_m += std::abs(interval.speed_mps) * interval.dt_s;
  return distance_m;
}

constexpr const char* kTimeOffset = "time_offset";

/// Takes the fixes as measured when their stamps say. An offset that is not needed costs RTK fixes at
/// 30 m/s a decimetre.
void leave_out(const TimeOffset& offset, FusionSettings& settings, ModeledDrive& modeled) {
  settings.modeling_options[kTimeOffset] = "off";
  (*settings.calibration)[kTimeOffset] = "off";
  modeled.placed.time_offset_s = 0;
  char text[200];
  std::snprintf(
      text, sizeof text,
      "the fixes are taken as not late: the drive says %.3f +- %.3f s, odds of %.3g to 1 for no delay",
      offset.value_s, offset.sigma_s, offset.odds_of_none());
  modeled.notes.emplace_back(text);
}

/// Finds the delay of the fixes, and the noise if it is estimated: each depends on the other.
/// @returns what the drive says about the delay; empty if the settings estimate none
std::optional<TimeOffset> estimate(const FusionSettings& settings, const TypeRegistry& registry,
                                   ModeledDrive& modeled) {
  modeled.settings = settings;
  const std::optional<TimeOffset> offset = assume_time_offset(modeled.placed, settings, registry);
  if (!*settings.estimates_noise) return offset;
  modeled.noise = estimate_noise(modeled.placed, settings, registry);
  modeled.settings = with_noise(settings, modeled.noise);
  return assume_time_offset(modeled.placed, modeled.settings, registry);
}

}  // namespace

std::vector<std::string> ModeledDrive::warnings() const {
  std::vector<std::string> all = placed.warnings;
  all.insert(all.end(), sensor_warnings.begin(), sensor_warnings.end());
  return all;
}

const PlacedDrive& Fusion::placed(const FusionSettings& settings) {
  const double standstill_mps =
      make_odometry_model(settings, drive_.timeline.gap_noise_factor, registry_)->standstill_speed();
  const Key key{settings.gate, settings.initial_guess, settings.lever_arm, standstill_mps};
  for (const auto& [known, placed] : placed_) {
    if (known == key) return placed;
  }
  if (!timeline_) timeline_ = timeline_of(drive_);
  return placed_.emplace_back(key, place_drive(drive_, *timeline_, settings, registry_)).second;
}

ModeledDrive Fusion::model(const FusionSettings& settings) {
  ModeledDrive modeled;
  FusionSettings decision = decided(settings, registry_);
  adapt_to_yaw_rate(drive_.yaw_rate_at_rest, !settings.calibration, decision, registry_);
  modeled.placed = placed(decision);
  const std::optional<TimeOffset> offset = estimate(decision, registry_, modeled);
  const bool is_stated = settings.calibration || settings.modeling_options.contains(kTimeOffset);
  if (offset && !is_stated && offset->odds_of_none() > 1) {
    leave_out(*offset, decision, modeled);
    (void)estimate(decision, registry_, modeled);
  }
  BuiltGraph built = build_graph(modeled.placed, drive_.sensors, modeled.settings, registry_);
  modeled.sensor_warnings = std::move(built.warnings);
  modeled.modeling = std::move(built.modeling);
  modeled.distance_m = distance_of(modeled.placed.timeline);
  formats::GraphDocument& document = modeled.document;
  document.graph = std::move(built.graph);
  document.frame = drive_.frame;
  document.time_scale = drive_.scale;
  document.antenna_m = modeled.placed.antenna_m;
  document.truth_reference_m = drive_.truth_reference_m;
  document.fixes = modeled.placed.fixes;
  document.provenance = provenance_of(drive_, modeled, registry_);
  return modeled;
}

FusedDrive minimized(ModeledDrive model, const TypeRegistry& registry, const MinimizationWatch& watch) {
  FusedDrive fused{std::move(model), {}};
  formats::GraphDocument& document = fused.model.document;
  const Minimization& how = fused.model.settings.minimization;
  fused.minimum = minimize(document.graph, how, registry, watch);
  if (fused.minimum.summary.converged()) add_covariances(document, how.covariances);
  return fused;
}

FusedDrive Fusion::fuse(const FusionSettings& settings, const MinimizationWatch& watch) {
  return minimized(model(settings), registry_, watch);
}

FusedDrive fuse(const PreparedDrive& drive, const FusionSettings& settings, const TypeRegistry& registry,
                const MinimizationWatch& watch) {
  return Fusion(drive, registry).fuse(settings, watch);
}

}  // namespace waymark::drive
