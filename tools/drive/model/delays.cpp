#include <waymark/tools/drive/model/delays.hpp>

#include <algorithm>
#include <cmath>
#include <string>

#include <fmt/format.h>

#include <waymark/core/base/detail/median.hpp>

namespace waymark::drive {
namespace {

constexpr const char* kTimeOffset = "time_offset";

/// How far the fixes of a group may be along the way, in units of their accuracy, by what is not known of
/// their delay.
struct LeftUnknown {
  double way_m = 0;
  double of_accuracy = 0;
};

LeftUnknown left_unknown(const TimeOffset& offset, const AbsoluteGroup& group, const PlacedDrive& placed) {
  std::vector<double> accuracies;
  for (const Fix& fix : placed.fixes)
    if (std::find(group.sources.begin(), group.sources.end(), fix.source) != group.sources.end())
      accuracies.push_back(fix.accuracy_m());
  double squared = 0;
  double duration_s = 0;
  for (const Interval& interval : placed.timeline.intervals) {
    squared += interval.speed_mps * interval.speed_mps * interval.dt_s;
    duration_s += interval.dt_s;
  }
  if (accuracies.empty() || !(duration_s > 0)) return {};
  const double way_m = offset.sigma_s * std::sqrt(squared / duration_s);
  return {way_m, way_m / upper_median(std::move(accuracies))};
}

/// Returns what follows the name of a source in a note, if there are several.
std::string of_several(const AbsoluteGroup& group, const ModeledDrive& modeled) {
  return modeled.placed.receivers.size() > 1 ? group.name + ": " : std::string();
}

/// Takes the fixes of a group as measured when their stamps say.
void leave_out(const AbsoluteGroup& group, FusionSettings& settings, ModeledDrive& modeled) {
  if (modeled.placed.receivers.size() > 1 || settings.sources.contains(group.name)) {
    settings.sources[group.name].options[kTimeOffset] = "off";
    modeled.without_delay.push_back(group.name);
  } else {
    settings.modeling_options[kTimeOffset] = "off";
    (*settings.calibration)[kTimeOffset] = "off";
    modeled.without_delay.emplace_back();
  }
  for (const int source : group.sources) modeled.placed.time_offsets_s[static_cast<std::size_t>(source)] = 0;
}

/// Says what the drive knows of a delay that is left out.
std::string note_of(const TimeOffset& offset, const AbsoluteGroup& group, const ModeledDrive& modeled) {
  const LeftUnknown unknown = left_unknown(offset, group, modeled.placed);
  return fmt::format(
      "{}the fixes are taken as not late: the drive says {:.3f} +- {:.3f} s, odds of {:.3g} to 1 for no delay{}",
      of_several(group, modeled), offset.value_s, offset.sigma_s, offset.odds_of_none(),
      unknown.of_accuracy <= 1
          ? std::string()
          : fmt::format(
                "; it hardly tells: if they may be late, '--calibrate on' adds the {:.2g} m along the way "
                "that this leaves open to the covariances",
                unknown.way_m));
}

}  // namespace

std::vector<std::optional<TimeOffset>> estimate_noise_and_delays(
    const FusionSettings& settings, std::span<const PreparedSensor> sensors, const TypeRegistry& registry,
    const std::function<void()>& between, TimeOffsetSearch& delays, ModeledDrive& modeled) {
  modeled.settings = settings;
  if (!*settings.estimates_noise) return delays.find(settings, modeled.placed);
  delays.move(settings, modeled.placed);
  modeled.noise = estimate_noise(modeled.placed, sensors, settings, registry, modeled.noise, between);
  modeled.settings = with_noise(settings, modeled.noise);
  return delays.find(modeled.settings, modeled.placed);
}

bool is_delay_open(const AbsoluteGroup& group, const FusionSettings& stated) {
  if (stated.calibration || stated.modeling_options.contains(kTimeOffset)) return false;
  const auto own = stated.sources.find(group.name);
  return own == stated.sources.end() ||
         (!own->second.options.contains(kTimeOffset) && !own->second.calibration.contains(kTimeOffset));
}

bool leave_out_improbable(const std::vector<std::optional<TimeOffset>>& offsets, const FusionSettings& stated,
                          FusionSettings& decision, ModeledDrive& modeled) {
  const std::vector<AbsoluteGroup> groups = groups_of(modeled.placed, decision);
  bool any = false;
  for (std::size_t g = 0; g < groups.size(); ++g) {
    if (!is_delay_open(groups[g], stated) || !offsets[g] || offsets[g]->odds_of_none() <= 1) continue;
    leave_out(groups[g], decision, modeled);
    modeled.notes.push_back(note_of(*offsets[g], groups[g], modeled));
    any = true;
  }
  return any;
}

bool leave_out_unseen(const FusionSettings& stated, FusionSettings& decision, ModeledDrive& modeled) {
  const std::vector<std::string> before = modeled.without_delay;
  bool any = false;
  for (const AbsoluteGroup& group : groups_of(modeled.placed, decision)) {
    const bool is_left_out = std::any_of(before.begin(), before.end(), [&](const std::string& name) {
      return name.empty() || name == group.name;
    });
    if (is_left_out || !is_delay_open(group, stated)) continue;
    leave_out(group, decision, modeled);
    modeled.notes.push_back(
        of_several(group, modeled) +
        "the fixes are taken as not late: an odometry that is worth so little cannot tell");
    any = true;
  }
  return any;
}

}  // namespace waymark::drive
