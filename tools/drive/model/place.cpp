#include <waymark/tools/drive/model/place.hpp>
#include <waymark/tools/drive/model/surroundings.hpp>

#include <algorithm>
#include <limits>
#include <span>
#include <utility>

#include <fmt/format.h>

#include <waymark/tools/drive/comparison/agreement.hpp>
#include <waymark/tools/drive/comparison/constant_difference.hpp>
#include <waymark/tools/drive/comparison/misreading.hpp>
#include <waymark/tools/drive/comparison/plausibility.hpp>
#include <waymark/tools/drive/coordinates/projection.hpp>
#include <waymark/tools/drive/model/start_search.hpp>
#include <waymark/tools/drive/nodes/receiver_filter.hpp>

namespace waymark::drive {

std::unique_ptr<OdometryModel> make_odometry_model(const FusionSettings& settings, double gap_noise_factor,
                                                   const TypeRegistry& registry) {
  const OdometryModelType& type = registry.odometry_model(settings.odometry_model);
  Options options = with_calibration(settings.odometry_options, settings, type.options);
  if (!type.gap_factor_option.empty())
    options.try_emplace(type.gap_factor_option, shortest(gap_noise_factor));
  return registry.make_odometry_model(settings.odometry_model, options);
}

Timeline timeline_of(const PreparedDrive& drive) {
  return build_timeline(drive.odometry, drive.fixes, drive.timeline);
}

std::string receiver_name(const PlacedDrive& placed, int source) {
  const auto index = static_cast<std::size_t>(source);
  return index < placed.receivers.size() ? placed.receivers[index] : "gnss";
}

std::string of_several(const PlacedDrive& placed) {
  return placed.runs.empty() ? std::string() : placed.odometry_name + ": ";
}

namespace {

/// Takes the sources and the fixes.
PlacedDrive begun(const PreparedDrive& drive, const Timeline& timeline, const FusionSettings& settings,
                  const TypeRegistry& registry) {
  PlacedDrive placed;
  placed.timeline = timeline;
  placed.fixes = drive.fixes;
  if (!settings.lever_arm)
    for (Fix& fix : placed.fixes) fix.antenna_m.setZero();
  for (const PreparedReceiver& receiver : drive.receivers) placed.receivers.push_back(receiver.name);
  const bool unnamed = drive.receivers.empty() && !drive.fixes.empty();
  placed.time_offsets_s.assign(unnamed ? 1 : drive.receivers.size(), 0.0);
  placed.smoothings_s.assign(placed.time_offsets_s.size(), 0.0);
  for (std::size_t i = 0; i < drive.receivers.size(); ++i)
    placed.smoothings_s[i] = drive.receivers[i].smoothing_s.value_or(0);
  placed.first_pose = drive.first_pose;
  placed.odometry_name = drive.odometry_name;
  placed.left_out = drive.report.left_out;
  placed.relative = drive.relative;
  if (!placed.relative.empty()) placed.runs = motion_runs(timeline, placed.relative, placed.fixes);
  placed.gap_noise_factor = drive.timeline.gap_noise_factor;
  placed.standstill_mps =
      make_odometry_model(for_relative(settings, drive.odometry_name), placed.gap_noise_factor, registry)
          ->standstill_speed();
  return placed;
}

std::vector<GateOptions> gates_of(const PlacedDrive& placed, const FusionSettings& settings,
                                  const TypeRegistry& registry) {
  std::vector<GateOptions> gates;
  for (std::size_t source = 0; source < placed.time_offsets_s.size(); ++source)
    gates.push_back(for_absolute(settings, receiver_name(placed, static_cast<int>(source)), registry).gate);
  return gates;
}

std::vector<Eigen::Vector3d> poses_of_fixes(const PlacedDrive& placed) {
  std::vector<Eigen::Vector3d> poses;
  for (const std::size_t node : placed.timeline.fix_node) poses.push_back(placed.start.poses[node]);
  return poses;
}

void reject_all_of(int source, PlacedDrive& placed) {
  for (Fix& fix : placed.fixes) {
    if (fix.source != source || fix.status != FixStatus::accepted) continue;
    fix.status = FixStatus::rejected;
    fix.reason = "contradicts";
    --placed.gate.accepted;
    ++placed.gate.rejected;
    ++placed.gate.reasons[fix.reason];
  }
}

/// Names receivers that differ all drive long. Those that are outvoted are rejected. @returns whether one is
bool leave_out_outvoted(std::span<const std::size_t> voices, PlacedDrive& placed) {
  const ComparedReceivers compared = compare_receivers(placed.fixes, poses_of_fixes(placed));
  const std::vector<int> wrong = outvoted(compared, voices);
  for (const int source : wrong) {
    reject_all_of(source, placed);
    placed.left_out.insert(receiver_name(placed, source));
  }
  for (const ConstantDifference& difference : compared.differ) {
    std::string end = consequence_of(difference);
    for (const int source : {difference.first, difference.second}) {
      const auto is_wrong = std::find(wrong.begin(), wrong.end(), source);
      if (is_wrong != wrong.end())
        end = fmt::format(". {} is left out, because others agree", receiver_name(placed, source));
    }
    placed.warnings.push_back(warning_of(difference, placed.receivers) + end);
  }
  return !wrong.empty();
}

/// Rejects fixes of sources that contradict the others, and names these.
/// @param timeline with the turns as the vehicle made them
void let_sources_agree(const Timeline& timeline, const FusionSettings& settings, PlacedDrive& placed) {
  std::vector<std::string> names;
  std::vector<std::size_t> voices;
  for (std::size_t source = 0; source < placed.time_offsets_s.size(); ++source) {
    const std::string name = group_of(settings, receiver_name(placed, static_cast<int>(source)));
    const auto known = std::find(names.begin(), names.end(), name);
    voices.push_back(static_cast<std::size_t>(known - names.begin()));
    if (known == names.end()) names.push_back(name);
  }
  const std::vector<Disagreement> found = reject_contradictions(placed.fixes, poses_of_fixes(placed), voices);
  for (const Disagreement& disagreement : found) {
    placed.gate.accepted -= disagreement.readings;
    placed.gate.rejected += disagreement.readings;
    placed.gate.reasons["contradicts"] += disagreement.readings;
    placed.warnings.push_back(
        warning_of(disagreement, names[disagreement.source], placed.timeline.stamps.front()));
  }
  const bool any_outvoted = leave_out_outvoted(voices, placed);
  if (!found.empty() || any_outvoted)
    placed.start = make_start(timeline, placed.fixes, placed.standstill_mps, settings.initial_guess);
}

/// Returns the rough positions of the first sensor that has any within the drive.
std::vector<Fix> rough_fixes_of(const PreparedDrive& drive) {
  for (const PreparedSensor& sensor : drive.sensors) {
    std::vector<Fix> within;
    for (const Fix& fix : sensor.rough)
      if (fix.stamp >= drive.odometry.front().stamp && fix.stamp <= drive.odometry.back().stamp)
        within.push_back(fix);
    if (!within.empty()) return within;
  }
  return {};
}

std::size_t node_nearest(const Timeline& timeline, Stamp stamp) {
  const DriveNodes nodes{timeline.stamps, {}, timeline.intervals};
  return nearest_node(nodes, stamp, std::numeric_limits<double>::infinity())->node;
}

/// Returns where on the Earth the drive is.
std::optional<GeodeticPoint> place_of(const PreparedDrive& drive) {
  if (drive.frame.zone == 0) return std::nullopt;
  return Projection(drive.frame).to_geodetic(drive.fixes.front().position);
}

void take_misreading(const std::string& sentence, PlacedDrive& placed) {
  placed.misreading = sentence;
  placed.warnings.push_back(sentence);
}

/// Returns what was given for each fix, of those that a condition selects.
template <typename Value, typename Condition>
std::vector<Value> of_selected(std::span<const Fix> fixes, std::span<const Value> values,
                               Condition is_selected) {
  std::vector<Value> selected;
  for (std::size_t i = 0; i < fixes.size(); ++i)
    if (is_selected(fixes[i])) selected.push_back(values[i]);
  return selected;
}

/// Returns what all receivers say that can tell: one of them may be wrong itself.
std::optional<std::string> misreading_of(const PlacedDrive& placed,
                                         const std::optional<GeodeticPoint>& place) {
  constexpr std::size_t kFewestFixes = 30;
  std::optional<std::string> misreading;
  Timeline timeline = placed.timeline;
  for (int source = 0; source < std::ssize(placed.time_offsets_s); ++source) {
    const auto is_of_source = [&](const Fix& fix) {
      return fix.status != FixStatus::withheld && fix.source == source;
    };
    const std::vector<Fix> fixes = of_selected<Fix>(placed.fixes, placed.fixes, is_of_source);
    if (fixes.size() < kFewestFixes) continue;
    timeline.fix_node = of_selected<std::size_t>(placed.fixes, placed.timeline.fix_node, is_of_source);
    const std::optional<std::string> found = find_misreading(timeline, fixes, placed.standstill_mps, place);
    if (!found) return std::nullopt;
    if (!misreading) misreading = found;
  }
  return misreading;
}

/// Tells what is suspicious about the odometry beside the fixes. What is read wrong explains everything else.
void compare_with_fixes(const PreparedDrive& drive, std::span<const Eigen::Vector3d> antenna,
                        PlacedDrive& placed) {
  const std::optional<GeodeticPoint> place = place_of(drive);
  if (const std::optional<std::string> found = misreading_of(placed, place))
    return take_misreading(*found, placed);
  const auto& impossible = drive.report.impossible_turns;
  if (const auto turns = impossible.find(drive.odometry_name); turns != impossible.end())
    return take_misreading(turns->second, placed);
  const std::string of_several = drive.relative.empty() ? std::string() : drive.odometry_name;
  const auto is_used = [](const Fix& fix) { return fix.status != FixStatus::withheld; };
  ComparedWithFixes compared = compare_odometry_with_fixes(
      of_selected<Fix>(placed.fixes, placed.fixes, is_used),
      of_selected<Eigen::Vector3d>(placed.fixes, antenna, is_used), place, placed.receivers, of_several);
  placed.speed_factor = compared.speed_factor;
  placed.turn_factor = compared.turn_factor;
  placed.yaw_bias = compared.yaw_bias;
  for (std::string& warning : compared.warnings) placed.warnings.push_back(std::move(warning));
}

/// Returns what a quantity of the nodes is at a moment: linear between them, and as at the ends beyond them.
Eigen::Vector2d at_moment(Stamp moment, const std::vector<Stamp>& stamps,
                          const std::vector<Eigen::Vector2d>& at_nodes) {
  const auto after = std::lower_bound(stamps.begin(), stamps.end(), moment);
  if (after == stamps.begin()) return at_nodes.front();
  if (after == stamps.end()) return at_nodes.back();
  const auto i = static_cast<std::size_t>(after - stamps.begin());
  const double share = seconds_between(stamps[i - 1], moment) / seconds_between(stamps[i - 1], stamps[i]);
  return (1 - share) * at_nodes[i - 1] + share * at_nodes[i];
}

}  // namespace

std::vector<Eigen::Vector2d> smoothed_at_fixes(const PlacedDrive& placed) {
  const Timeline& timeline = placed.timeline;
  std::vector<Eigen::Vector2d> smoothed_m(placed.fixes.size(), Eigen::Vector2d::Zero());
  for (std::size_t source = 0; source < placed.smoothings_s.size(); ++source) {
    if (!(placed.smoothings_s[source] > 0)) continue;
    const std::vector<Eigen::Vector2d> beside_m =
        smoothed_beside(timeline.intervals, placed.smoothings_s[source], placed.standstill_mps);
    for (std::size_t i = 0; i < placed.fixes.size(); ++i) {
      if (placed.fixes[i].source != static_cast<int>(source)) continue;
      const Stamp measured = placed.fixes[i].stamp.later(-placed.time_offsets_s[source]);
      smoothed_m[i] = at_moment(measured, timeline.stamps, beside_m);
    }
  }
  return smoothed_m;
}

void take_smoothing(PlacedDrive& placed) {
  const std::vector<Eigen::Vector2d> smoothed_m = smoothed_at_fixes(placed);
  for (std::size_t i = 0; i < smoothed_m.size(); ++i) placed.fixes[i].smoothed_m = smoothed_m[i];
}

PlacedDrive place_drive(const PreparedDrive& drive, const Timeline& timeline, const FusionSettings& settings,
                        const TypeRegistry& registry) {
  PlacedDrive placed = begun(drive, timeline, settings, registry);
  if (drive.fixes.empty()) {
    placed.warnings = drive.report.warnings;
    placed.surroundings = std::make_shared<const DriveSurroundings>(drive, placed.fixes);
    const std::vector<Fix> rough = rough_fixes_of(drive);
    const bool is_stated = drive.first_pose && drive.first_pose->position;
    if (rough.empty() || is_stated) {
      search_start(drive.sensors, settings, registry, placed);
      return placed;
    }
    Timeline with_rough = timeline;
    for (const Fix& fix : rough) with_rough.fix_node.push_back(node_nearest(timeline, fix.stamp));
    placed.start = make_start(with_rough, rough, placed.standstill_mps, settings.initial_guess);
    placed.start.note = "no receiver: rough positions of a sensor are the start";
    return placed;
  }
  placed.warnings = drive.report.warnings;
  take_smoothing(placed);
  std::vector<Eigen::Vector3d> antenna = reckoned_antenna(timeline, placed.fixes, placed.standstill_mps);
  compare_with_fixes(drive, antenna, placed);
  std::optional<Timeline> mended;  // the turns that the vehicle made
  if (placed.turn_factor || placed.yaw_bias) {
    mended =
        without_error(timeline, placed.yaw_bias.value_or(YawBias()).with(placed.turn_factor.value_or(1)));
    antenna = reckoned_antenna(*mended, placed.fixes, placed.standstill_mps);
  }
  const Timeline& turned = mended ? *mended : timeline;
  placed.gate = apply_gate(placed.fixes, antenna, gates_of(placed, settings, registry));
  require_accepted_fix(placed.gate);
  if (std::string warning = warning_of(placed.gate); !warning.empty())
    placed.warnings.push_back(std::move(warning));
  placed.start = make_start(turned, placed.fixes, placed.standstill_mps, settings.initial_guess);
  let_sources_agree(turned, settings, placed);
  for (std::size_t i = 0; i < placed.fixes.size(); ++i)
    placed.fixes[i].vertex = vertex_of(timeline.fix_node[i]);
  placed.surroundings = std::make_shared<const DriveSurroundings>(drive, placed.fixes);
  return placed;
}

}  // namespace waymark::drive
