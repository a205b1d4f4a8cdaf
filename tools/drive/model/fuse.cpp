#include <waymark/tools/drive/model/fuse.hpp>

#include <algorithm>
#include <cmath>

#include <waymark/core/base/error.hpp>
#include <waymark/tools/drive/estimation/noise_spread.hpp>
#include <waymark/tools/drive/estimation/scale_priors.hpp>
#include <waymark/tools/drive/model/build.hpp>
#include <waymark/tools/drive/model/delays.hpp>
#include <waymark/tools/drive/model/provenance.hpp>

namespace waymark::drive {
namespace {

double distance_of(const Timeline& timeline) {
  double distance_m = 0;
  for (const Interval& interval : timeline.intervals)
    distance_m += std::abs(interval.speed_mps) * interval.dt_s;
  return distance_m;
}

/// Returns the sources for the document; empty for one odometry and one receiver alone.
std::vector<formats::DocumentSource> document_sources(const PreparedDrive& drive, const PlacedDrive& placed,
                                                      const SourceShares& shares,
                                                      const FusionSettings& settings) {
  std::vector<formats::DocumentSource> sources;
  if (drive.relative.empty() && drive.receivers.size() < 2 && drive.sensors.empty()) return sources;
  const auto add = [&](const std::string& name, const std::string& kind, const Eigen::Vector2d& antenna_m) {
    // Members of a group have its states; its edges are counted once.
    const auto own = shares.find(group_of(settings, name));
    sources.push_back({name, kind, antenna_m, {}, {}});
    if (own == shares.end()) return;
    sources.back().vertices = own->second.vertices;
    if (own->first == name) sources.back().edges = own->second.edges;
  };
  if (drive.relative.empty()) add(drive.odometry_name, "odometry", {0, 0});
  for (const PreparedOdometry& source : drive.relative) add(source.name, "odometry", {0, 0});
  for (std::size_t i = 0; i < drive.receivers.size(); ++i) {
    const auto fix = std::find_if(placed.fixes.begin(), placed.fixes.end(),
                                  [&](const Fix& of) { return of.source == static_cast<int>(i); });
    add(drive.receivers[i].name, "gnss",
        fix == placed.fixes.end() ? drive.receivers[i].antenna_m : fix->antenna_m);
  }
  for (const PreparedSensor& sensor : drive.sensors) add(sensor.source, sensor.name, {0, 0});
  return sources;
}

/// @throws InputError if the drive was read wrong
void refuse_misreading(const PlacedDrive& placed) {
  if (placed.misreading.empty()) return;
  throw InputError(of_several(placed) + placed.misreading);
}

/// Adapts the settings to the yaw rate of each relative source.
void adapt(const PreparedDrive& drive, bool by_default, FusionSettings& decision,
           const TypeRegistry& registry) {
  if (drive.relative.empty()) adapt_to_yaw_rate(drive.yaw_rate_at_rest, by_default, decision, registry);
  for (const PreparedOdometry& source : drive.relative)
    adapt_to_yaw_rate_of(source.name, source.yaw_rate_at_rest, by_default, decision, registry);
}

std::string words_for_poor_odometry(const PlacedDrive& placed) {
  return of_several(placed) +
         "the odometry does not move as the fixes do (a gyro that is dead, wheels that slip, a wrong scale): it is "
         "given little weight, and the result follows the fixes";
}

}  // namespace

std::vector<std::string> ModeledDrive::warnings() const {
  std::vector<std::string> all = placed.warnings;
  all.insert(all.end(), sensor_warnings.begin(), sensor_warnings.end());
  return all;
}

const PlacedDrive& Fusion::placed(const FusionSettings& settings) {
  const double standstill_mps = make_odometry_model(for_relative(settings, drive_.odometry_name),
                                                    drive_.timeline.gap_noise_factor, registry_)
                                    ->standstill_speed();
  Key key{settings.gate, {}, settings.initial_guess, settings.lever_arm, standstill_mps};
  for (const auto& [name, source] : settings.sources) key.gates[name] = source.gate;
  for (const auto& [known, placed] : placed_) {
    if (known == key) return placed;
  }
  if (!timeline_) timeline_ = timeline_of(drive_);
  return placed_.emplace_back(key, place_drive(drive_, *timeline_, settings, registry_)).second;
}

FusionSettings Fusion::decision_on(const FusionSettings& settings) const {
  FusionSettings decision = decided(settings, registry_);
  adapt(drive_, !settings.calibration, decision, registry_);
  return decision;
}

ModeledDrive Fusion::estimated_from(PlacedDrive placed, const FusionSettings& settings) {
  ModeledDrive modeled;
  FusionSettings decision = decision_on(settings);
  modeled.placed = std::move(placed);
  const bool by_default = !settings.calibration || *settings.calibration == default_calibration();
  for (std::string& note : adapt_to_scales(modeled.placed, by_default, registry_, decision))
    modeled.notes.push_back(std::move(note));
  if (modeled.placed.start.follows_fixes) (void)leave_out_unseen(settings, decision, modeled);
  TimeOffsetSearch delays(modeled.placed, drive_.sensors, registry_, between_);
  auto offsets = estimate_noise_and_delays(decision, drive_.sensors, registry_, between_, delays, modeled);
  for (std::optional<TimeOffset>& offset : offsets)
    if (offset && drive_.report.moved_quantity)
      offset->sigma_s = std::hypot(offset->sigma_s, drive_.report.moved_quantity->sigma_s);
  const bool left_out = modeled.noise.is_poor_odometry(modeled.placed.odometry_name)
                            ? leave_out_unseen(settings, decision, modeled)
                            : leave_out_improbable(offsets, settings, decision, modeled);
  if (left_out)
    (void)estimate_noise_and_delays(decision, drive_.sensors, registry_, between_, delays, modeled);
  for (const std::optional<TimeOffset>& offset : offsets)
    if (offset && offset->slip.is_probable()) modeled.slip = offset->slip;
  modeled.decision = std::move(decision);
  return modeled;
}

std::optional<ModeledDrive> Fusion::along_fixes(const PlacedDrive& usual, const FusionSettings& settings,
                                                const ModeledDrive& modeled) {
  // Where both are nearly as probable, a result that follows the fixes costs little if the odometry was sound after all;
  // one that follows a poor odometry may be anywhere.
  constexpr double kEven = -2;
  constexpr double kNearly = -20;    // against a sound odometry it is hundreds
  constexpr double kOfAnother = 10;  // less is the same minimum without a delay
  if (usual.fixes.empty() || settings.initial_guess != StartOptions()) return std::nullopt;
  PlacedDrive along = usual;
  along.start = start_along_fixes(along.timeline, along.fixes, along.standstill_mps);
  if (!may_be_poor_odometry(along, drive_.sensors, modeled.decision, registry_, modeled.noise))
    return std::nullopt;
  ModeledDrive other = estimated_from(std::move(along), settings);
  const double gain = modeled.noise.cost - other.noise.cost;
  const bool is_poor = other.noise.is_poor_odometry(usual.odometry_name);
  // Few fixes of a dead odometry fit receivers that are tens of metres wrong as well; those are rarer.
  const bool spares_fixes = is_poor && modeled.noise.fixes_are_poor() && !other.noise.fixes_are_poor();
  const double least = spares_fixes ? kNearly : is_poor ? kEven : kOfAnother;
  if (!(gain > least)) return std::nullopt;
  return other;
}

ModeledDrive Fusion::searched(const FusionSettings& settings) {
  const PlacedDrive& usual = placed(decision_on(settings));
  ModeledDrive modeled = estimated_from(usual, settings);
  if (modeled.noise.parameters.empty()) return modeled;
  if (std::optional<ModeledDrive> other = along_fixes(usual, settings, modeled)) modeled = std::move(*other);
  if (modeled.noise.is_poor_odometry(modeled.placed.odometry_name))
    modeled.placed.warnings.push_back(words_for_poor_odometry(modeled.placed));
  return modeled;
}

void Fusion::add_deviations(ModeledDrive& modeled) const {
  if (modeled.noise.parameters.empty()) return;
  find_deviations(modeled.placed, drive_.sensors, modeled.decision, registry_, modeled.noise, between_);
}

ModeledDrive Fusion::estimated(const FusionSettings& settings) {
  ModeledDrive modeled = searched(settings);
  add_deviations(modeled);
  return modeled;
}

ModeledDrive Fusion::model(const FusionSettings& stated) {
  refuse_misreading(placed(decision_on(stated)));
  Freed freed{searched(stated)};
  const FusionSettings settings = with_common_errors(stated, freed);
  part_at_jumps(settings, freed);
  Freed slipping;
  if (drive_.relative.empty() && !freed.modeled.noise.parameters.empty()) {
    settle_moved_quantity(settings, freed);
    free_of_smoothing(settings, freed);
    slipping.drive = freed.drive;
    if (freed.modeled.slip.is_probable()) slipping = freed;
    free_of_slip(settings, freed);
  }
  // An antenna that is elsewhere looks like a clock that is wrong.
  const std::optional<AntennaPlace> antenna = antenna_beside_slip(settings, slipping, freed);
  if (antenna)
    freed.told.push_back(warning_of(*antenna, receiver_name(freed.modeled.placed, 0)));
  else
    free_of_drift(settings, freed);
  put_on_time(settings, antenna, freed);
  return completed(std::move(freed));
}

ModeledDrive Fusion::completed(Freed freed) const {
  ModeledDrive modeled = std::move(freed.modeled);
  std::vector<std::string>& warnings = modeled.placed.warnings;
  warnings.insert(warnings.end(), freed.told.begin(), freed.told.end());
  modeled.other_readings = freed.drive;
  const PreparedDrive& drive = freed.drive_or(drive_);
  add_deviations(modeled);
  BuiltGraph built = build_graph(modeled.placed, drive.sensors, modeled.settings, registry_);
  modeled.sensor_warnings = std::move(built.warnings);
  modeled.modelings = std::move(built.modelings);
  modeled.groups = std::move(built.groups);
  modeled.distance_m = distance_of(modeled.placed.timeline);
  formats::GraphDocument& document = modeled.document;
  document.graph = std::move(built.graph);
  document.frame = drive.frame;
  document.time_scale = drive.scale;
  document.sources = document_sources(drive, modeled.placed, built.shares, modeled.settings);
  if (document.sources.empty() && !modeled.placed.fixes.empty())
    document.antenna_m = modeled.placed.fixes.front().antenna_m;
  document.truth_reference_m = drive.truth_reference_m;
  take_smoothing(modeled.placed);
  document.fixes = modeled.placed.fixes;
  document.provenance = provenance_of(drive, modeled, registry_);
  return modeled;
}

void add_covariances(ModeledDrive& modeled, const std::string& which) {
  add_covariances(modeled.document, which);
  widen(modeled.document.covariances, modeled.document.graph, modeled.noise.spread);
}

FusedDrive minimized(ModeledDrive model, const TypeRegistry& registry, const MinimizationWatch& watch) {
  FusedDrive fused{std::move(model), {}};
  const Minimization& how = fused.model.settings.minimization;
  fused.minimum = minimize(fused.model.document.graph, how, registry, watch);
  if (fused.minimum.summary.converged()) add_covariances(fused.model, how.covariances);
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
