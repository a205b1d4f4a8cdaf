#include <algorithm>
#include <cmath>

#include <waymark/core/base/error.hpp>
#include <waymark/core/base/suggest.hpp>
#include <waymark/core/registry/options.hpp>
#include <waymark/tools/drive/model/assemble.hpp>
#include <waymark/tools/drive/model/sensors.hpp>
#include <waymark/tools/drive/nodes/plausibility.hpp>
#include <waymark/types_se2/edge_gnss.hpp>
#include <waymark/types_se2/stamped_pose.hpp>

namespace waymark::drive {
namespace {

std::string place_of(const DriveConfig& config, const std::string& key) {
  const auto place = config.places.find(key);
  return place == config.places.end() ? config.path + ": " : place->second;
}

/// Where an option of the odometry model stands.
std::string place_of_option(const DriveConfig& config, const std::string& option) {
  for (const char* section : {"odometry.options.", "calibration."}) {
    const auto place = config.places.find(section + option);
    if (place != config.places.end()) return place->second;
  }
  return place_of(config, "odometry.model");
}

std::vector<Fix> accepted_fixes(const std::vector<Fix>& fixes) {
  std::vector<Fix> accepted;
  for (const Fix& fix : fixes) {
    if (fix.status == FixStatus::accepted) accepted.push_back(fix);
  }
  return accepted;
}

std::optional<double> estimated_time_offset(const Graph& graph) {
  for (VertexIndex v = 0; v < static_cast<VertexIndex>(graph.vertex_count()); ++v) {
    if (graph.vertex_type(v).tag == VertexTimeOffset::kTag && !graph.fixed(v)) return graph.value(v)[0];
  }
  return std::nullopt;
}

/// All poses with a stamp, by time; one of each stamp.
std::vector<StampedPose> stamped_poses(const Graph& graph) {
  std::vector<StampedPose> poses;
  for (VertexIndex v = 0; v < static_cast<VertexIndex>(graph.vertex_count()); ++v) {
    if (const auto pose = stamped_pose(graph, v)) poses.push_back(*pose);
  }
  std::stable_sort(poses.begin(), poses.end(),
                   [](const auto& a, const auto& b) { return a.stamp < b.stamp; });
  const auto same = [](const auto& a, const auto& b) { return a.stamp == b.stamp; };
  poses.erase(std::unique(poses.begin(), poses.end(), same), poses.end());
  return poses;
}

Pose2<double> as_pose(const StampedPose& pose) {
  return {pose.pose[0], pose.pose[1], pose.pose[2]};
}

/// The pose `later_s` seconds after a stamp, on the twist between the two poses beside; beyond the ends that
/// of the last two goes on. @param nodes at least two
Eigen::Vector3d pose_at(const std::vector<StampedPose>& nodes, Stamp stamp, double later_s) {
  const Stamp moment{stamp.nanoseconds + std::llround(later_s * 1e9)};
  auto after = std::upper_bound(nodes.begin() + 1, nodes.end() - 1, moment,
                                [](Stamp time, const StampedPose& pose) { return time < pose.stamp; });
  const StampedPose& before = *(after - 1);
  const double part = seconds_between(before.stamp, moment) / seconds_between(before.stamp, after->stamp);
  const Vector3<double> twist = se2_log(between(as_pose(before), as_pose(*after)));
  return compose(as_pose(before), se2_exp<double>(part * twist)).vector();
}

}  // namespace

Options with_calibration(Options options, const DriveConfig& config, const std::vector<OptionInfo>& known) {
  for (const auto& [name, value] : config.calibration) {
    if (has_option(known, name)) options.try_emplace(name, value);
  }
  return options;
}

void check_calibration(const DriveConfig& config, const std::vector<std::string>& modelings,
                       const TypeRegistry& registry) {
  for (const auto& entry : config.calibration) {
    const std::string& name = entry.first;
    std::vector<std::string_view> known;
    const auto add = [&known](const std::vector<OptionInfo>& options) {
      for (const OptionInfo& option : options) known.push_back(option.name);
    };
    add(registry.odometry_model(config.odometry_model).options);
    for (const std::string& modeling : modelings) add(registry.gnss_modeling(modeling).options);
    if (std::find(known.begin(), known.end(), name) != known.end()) continue;
    const std::string hint = did_you_mean(name, known);
    throw InputError(place_of(config, "calibration." + name) + "calibration: neither odometry model '" +
                     config.odometry_model + "' nor the GNSS modeling knows '" + name + "'" +
                     (hint.empty() ? "; `waymark info` lists their options" : hint));
  }
}

std::unique_ptr<OdometryModel> make_odometry_model(const DriveConfig& config, const TypeRegistry& registry) {
  try {
    const OdometryModelType& type = registry.odometry_model(config.odometry_model);
    Options options = with_calibration(config.odometry_options, config, type.options);
    if (!type.gap_factor_option.empty())
      options.try_emplace(type.gap_factor_option, shortest(config.timeline.gap_noise_factor));
    return registry.make_odometry_model(config.odometry_model, options);
  } catch (const OptionError& error) {
    throw InputError(place_of_option(config, error.option()) + error.what());
  } catch (const UsageError& error) {
    throw InputError(place_of(config, "odometry.model") + error.what());
  }
}

PlacedDrive place_drive(const PreparedDrive& drive, const DriveConfig& config, const TypeRegistry& registry) {
  PlacedDrive placed;
  placed.standstill_mps = make_odometry_model(config, registry)->standstill_speed();
  placed.fixes = drive.fixes;
  placed.timeline = build_timeline(drive.odometry, placed.fixes, config.timeline);
  const std::vector<Eigen::Vector3d> reckoned =
      dead_reckon(placed.timeline, Eigen::Vector3d::Zero(), placed.standstill_mps);
  const std::vector<Eigen::Vector3d> antenna = antenna_at_fixes(placed.timeline, reckoned, drive.antenna_m);
  placed.warnings = compare_odometry_with_fixes(placed.fixes, antenna);
  placed.gate = apply_gate(placed.fixes, antenna, config.gate);
  require_accepted_fix(placed.gate);
  placed.start =
      make_start(placed.timeline, placed.fixes, drive.antenna_m, placed.standstill_mps, config.start);
  return placed;
}

DriveSkeleton build_skeleton(const PreparedDrive& drive, const DriveConfig& config,
                             const TypeRegistry& registry) {
  return build_skeleton(place_drive(drive, config, registry), drive, config, registry);
}

DriveSkeleton build_skeleton(const PlacedDrive& placed, const PreparedDrive& drive, const DriveConfig& config,
                             const TypeRegistry& registry) {
  DriveSkeleton skeleton;
  skeleton.gate = placed.gate;
  skeleton.start = placed.start;
  skeleton.warnings = placed.warnings;
  formats::GraphDocument& document = skeleton.document;
  document.frame = drive.frame;
  document.time_scale = drive.scale;
  document.antenna_m = drive.antenna_m;
  document.truth_reference_m = drive.truth_reference_m;
  document.fixes = placed.fixes;

  const Timeline& timeline = placed.timeline;
  std::vector<VertexIndex> poses;
  poses.reserve(timeline.stamps.size());
  for (std::size_t i = 0; i < timeline.stamps.size(); ++i) {
    const Eigen::Vector3d& pose = skeleton.start.poses[i];
    const auto id = static_cast<VertexId>(i) + 1;
    poses.push_back(document.graph.add_vertex<VertexSe2>(id, {pose[0], pose[1], pose[2]}));
    document.graph.set_stamp(poses.back(), timeline.stamps[i]);
  }
  const DriveNodes nodes{timeline.stamps, poses, timeline.intervals};
  make_odometry_model(config, registry)->build(nodes, document.graph);
  for (std::size_t i = 0; i < document.fixes.size(); ++i) {
    document.fixes[i].vertex = static_cast<VertexId>(timeline.fix_node[i]) + 1;
    skeleton.motion_at_fixes.push_back(motion_at(nodes, timeline.fix_node[i]));
  }
  for (std::string& warning :
       add_sensors(config, drive, nodes, accepted_fixes(document.fixes), registry, document.graph))
    skeleton.warnings.push_back(std::move(warning));
  for (const Interval& interval : timeline.intervals) {
    skeleton.distance_m += std::abs(interval.speed_mps) * interval.dt_s;
  }
  return skeleton;
}

formats::GraphDocument add_modeling(const DriveSkeleton& skeleton, const std::string& modeling,
                                    const Options& options, const TypeRegistry& registry,
                                    const std::optional<Loss>& loss) {
  formats::GraphDocument document = skeleton.document;
  std::vector<Fix> accepted;
  std::vector<Interval> motion;
  for (std::size_t i = 0; i < document.fixes.size(); ++i) {
    if (document.fixes[i].status != FixStatus::accepted) continue;
    accepted.push_back(document.fixes[i]);
    motion.push_back(skeleton.motion_at_fixes[i]);
  }
  registry.make_gnss_modeling(modeling, options)
      ->build({accepted, motion, document.antenna_m, loss}, document.graph);
  return document;
}

std::vector<Eigen::Vector3d> poses_when_measured(const formats::GraphDocument& document) {
  const std::optional<double> offset = estimated_time_offset(document.graph);
  if (!offset) return {};
  const std::vector<StampedPose> nodes = stamped_poses(document.graph);
  if (nodes.size() < 2)
    throw InputError("a time offset is estimated, but fewer than two poses have stamps of their own");
  std::vector<Eigen::Vector3d> poses;
  for (const Fix& fix : document.fixes) poses.push_back(pose_at(nodes, fix.stamp, -*offset));
  return poses;
}

std::vector<std::optional<Eigen::Matrix2d>> position_covariances_at_fixes(
    const formats::GraphDocument& document) {
  std::vector<const formats::VertexCovariance*> of_vertex(document.graph.vertex_count(), nullptr);
  for (const formats::VertexCovariance& block : document.covariances)
    of_vertex[static_cast<std::size_t>(block.vertex)] = &block;
  std::vector<std::optional<Eigen::Matrix2d>> covariances(document.fixes.size());
  for (std::size_t i = 0; i < document.fixes.size(); ++i) {
    const auto vertex = document.graph.find(document.fixes[i].vertex);
    const formats::VertexCovariance* block = vertex ? of_vertex[static_cast<std::size_t>(*vertex)] : nullptr;
    if (block != nullptr) covariances[i] = block->covariance.topLeftCorner<2, 2>();
  }
  return covariances;
}

std::vector<StampedPose> poses_at_fixes(const formats::GraphDocument& document) {
  std::vector<StampedPose> poses;
  poses.reserve(document.fixes.size());
  for (const Fix& fix : document.fixes) {
    const auto vertex = document.graph.find(fix.vertex);
    if (!vertex || document.graph.vertex_type(*vertex).tag != VertexSe2::kTag ||
        !document.graph.stamp(*vertex)) {
      throw InputError("fix of epoch " + std::to_string(fix.epoch) + ": its vertex " +
                       std::to_string(fix.vertex) + " is no pose with a stamp");
    }
    const Stamp stamp = *document.graph.stamp(*vertex);
    if (std::abs(seconds_between(fix.stamp, stamp)) > kLargestSnap) {
      throw InputError("fix of epoch " + std::to_string(fix.epoch) +
                       ": its stamp is not that of its vertex " + std::to_string(fix.vertex));
    }
    const auto value = document.graph.value(*vertex);
    poses.push_back({stamp, {value[0], value[1], value[2]}});
  }
  return poses;
}

}  // namespace waymark::drive
