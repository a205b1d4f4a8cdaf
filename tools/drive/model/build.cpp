#include <waymark/tools/drive/model/build.hpp>
#include <waymark/tools/drive/model/surroundings.hpp>

#include <algorithm>
#include <limits>
#include <utility>

#include <waymark/core/base/error.hpp>
#include <waymark/types_se2/edge_se2.hpp>
#include <waymark/types_se2/se2.hpp>
#include <waymark/types_se2/vertex_se2.hpp>

namespace waymark::drive {
namespace {

/// The fixes in the graph.
struct AcceptedFixes {
  std::vector<Fix> fixes;
  std::vector<std::size_t> nodes;
};

AcceptedFixes accepted_fixes(const PlacedDrive& placed) {
  AcceptedFixes accepted;
  const std::vector<Eigen::Vector2d> smoothed_m = smoothed_at_fixes(placed);
  for (std::size_t i = 0; i < placed.fixes.size(); ++i) {
    if (placed.fixes[i].status != FixStatus::accepted) continue;
    accepted.fixes.push_back(placed.fixes[i]);
    accepted.fixes.back().smoothed_m = smoothed_m[i];
    accepted.nodes.push_back(placed.timeline.fix_node[i]);
  }
  return accepted;
}

FixMoment moment_of_fix(const DriveNodes& nodes, const NodeInTime& moment, const Eigen::Vector2d& antenna) {
  const auto [way, twist] = motion_from_node(nodes, moment);
  const Pose2<double> moved = se2_exp<double>(way);
  const Eigen::Vector2d velocity(twist[0] - twist[2] * antenna[1], twist[2] * antenna[0]);
  return {moved.position + rotate(moved.heading, antenna), rotate(moved.heading, velocity)};
}

/// Adds edges to those of a source; they may continue its last ones of the type.
void add_share(const formats::EdgeShare& edges, std::vector<formats::EdgeShare>& known) {
  const auto last = std::find_if(known.rbegin(), known.rend(),
                                 [&](const formats::EdgeShare& share) { return share.tag == edges.tag; });
  if (last != known.rend() && last->last + 1 == edges.first) {
    last->last = edges.last;
  } else {
    known.push_back(edges);
  }
}

/// Returns the information of the ties between the track of a further source and the nodes.
std::optional<Eigen::Matrix3d> tie_of(const FusionSettings& settings, const TypeRegistry& registry) {
  const OdometryModelType& type = registry.odometry_model(settings.odometry_model);
  if (type.track_sigma_option.empty()) return std::nullopt;
  const CheckedOptions options(type.name, with_calibration(settings.odometry_options, settings, type.options),
                               type.options);
  const double sigma_m = options.number(type.track_sigma_option);
  const double sigma_rad = options.number(type.track_heading_option);
  return Eigen::Matrix3d(
      Eigen::Vector3d(1 / (sigma_m * sigma_m), 1 / (sigma_m * sigma_m), 1 / (sigma_rad * sigma_rad))
          .asDiagonal());
}

}  // namespace

std::vector<AbsoluteGroup> groups_of(const PlacedDrive& placed, const FusionSettings& settings) {
  std::vector<AbsoluteGroup> groups;
  for (std::size_t source = 0; source < placed.time_offsets_s.size(); ++source) {
    const std::string name = group_of(settings, receiver_name(placed, static_cast<int>(source)));
    auto group =
        std::find_if(groups.begin(), groups.end(), [&](const auto& known) { return known.name == name; });
    if (group == groups.end()) {
      group = groups.insert(groups.end(), AbsoluteGroup{.name = name, .sources = {}});
      group->time_offset_s = placed.time_offsets_s[source];
    }
    group->sources.push_back(static_cast<int>(source));
  }
  for (AbsoluteGroup& group : groups) {
    std::vector<Fix> fixes;
    for (const Fix& fix : placed.fixes)
      if (std::find(group.sources.begin(), group.sources.end(), fix.source) != group.sources.end())
        fixes.push_back(fix);
    group.claimed = claimed_accuracies(fixes);
  }
  return groups;
}

DriveFacts facts_of(const PlacedDrive& placed, const FusionSettings& settings) {
  DriveFacts facts{.absolute = groups_of(placed, settings), .relative = {}};
  for (const PreparedOdometry& source : placed.relative) facts.relative.push_back(source.name);
  if (facts.relative.empty()) facts.relative.push_back(placed.odometry_name);
  const auto first =
      std::find_if(placed.fixes.begin(), placed.fixes.end(), [](const Fix& fix) { return fix.source == 0; });
  if (first != placed.fixes.end()) facts.antenna_m = first->antenna_m;
  facts.gap_noise_factor = placed.gap_noise_factor;
  facts.first_pose = placed.first_pose;
  facts.surroundings = placed.surroundings;
  return facts;
}

GraphBuilder::GraphBuilder(DriveFacts facts, std::span<const PreparedSensor> sensors,
                           const FusionSettings& settings, const TypeRegistry& registry)
    : facts_(std::move(facts)), sensors_(sensors, settings, registry) {
  for (const std::string& name : facts_.relative)
    relative_.push_back(
        {name, make_odometry_model(for_relative(settings, name), facts_.gap_noise_factor, registry),
         tie_of(for_relative(settings, name), registry), loss_of_source(settings, name, registry)});
  for (const AbsoluteGroup& group : facts_.absolute) {
    const FusionSettings own = for_absolute(settings, group.name, registry);
    if (group.sources.size() > 1) require_common_errors(settings, group.name, registry);
    absolute_.push_back({group, loss_of_fixes(own.loss, registry),
                         registry.make_gnss_modeling(own.modeling, own.modeling_options)});
  }
}

std::vector<std::size_t> GraphBuilder::batch_sizes() const {
  std::vector<std::size_t> sizes;
  for (std::size_t b = 0; b < graph_.batch_count(); ++b) sizes.push_back(graph_.batch(b).size());
  return sizes;
}

void GraphBuilder::put_loss(const Loss& loss, std::size_t batch, std::size_t first) {
  for (std::size_t edge = first; edge < graph_.batch(batch).size(); ++edge) {
    const auto vertices = graph_.batch(batch).vertices(edge);
    const bool measures = std::any_of(vertices.begin(), vertices.end(), [&](VertexIndex v) {
      return graph_.vertex_type(v).tag == VertexSe2::kTag;
    });
    if (measures && graph_.batch(batch).loss(edge) == nullptr) graph_.set_loss({batch, edge}, loss);
  }
}

template <typename Step>
void GraphBuilder::add_for(const std::string& source, const std::optional<Loss>& loss, const Step& step) {
  const auto first = static_cast<VertexIndex>(graph_.vertex_count());
  const std::vector<std::size_t> before = batch_sizes();
  step();
  SourceShare& share = shares_[source];
  const auto end = static_cast<VertexIndex>(graph_.vertex_count());
  if (first < end) share.vertices.push_back({graph_.id(first), graph_.id(end - 1)});
  for (std::size_t b = 0; b < graph_.batch_count(); ++b) {
    const std::size_t known = b < before.size() ? before[b] : 0;
    if (graph_.batch(b).size() == known) continue;
    if (loss) put_loss(*loss, b, known);
    add_share({graph_.edge_type(b).tag, known, graph_.batch(b).size() - 1}, share.edges);
  }
}

std::vector<std::shared_ptr<const GnssModeling>> GraphBuilder::modelings() const {
  std::size_t sources = 0;
  for (const Absolute& absolute : absolute_) sources += absolute.group.sources.size();
  std::vector<std::shared_ptr<const GnssModeling>> models(sources);
  for (const Absolute& absolute : absolute_)
    for (const int source : absolute.group.sources) models[static_cast<std::size_t>(source)] = absolute.model;
  return models;
}

std::size_t GraphBuilder::absolute_of(int source) const {
  for (std::size_t i = 0; i < absolute_.size(); ++i) {
    const std::vector<int>& sources = absolute_[i].group.sources;
    if (std::find(sources.begin(), sources.end(), source) != sources.end()) return i;
  }
  throw UsageError("a fix names the source " + std::to_string(source) + ", which the drive does not have");
}

// Each pose gets the next free id: i + 1 for node i if the drive is one part.
void GraphBuilder::add_nodes(const DrivePart& part) {
  for (std::size_t i = 0; i < part.stamps.size(); ++i) {
    const Eigen::Vector3d& pose = part.poses[i];
    poses_.push_back(graph_.add_vertex<VertexSe2>(graph_.free_id(), {pose[0], pose[1], pose[2]}));
    graph_.set_stamp(poses_.back(), part.stamps[i]);
  }
  stamps_.insert(stamps_.end(), part.stamps.begin(), part.stamps.end());
  intervals_.insert(intervals_.end(), part.intervals.begin(), part.intervals.end());
}

void GraphBuilder::add_first_pose() {
  if (!facts_.first_pose) return;
  const FirstPose& stated = *facts_.first_pose;
  const auto inverse_square = [](double sigma) { return 1 / (sigma * sigma); };
  const double at = stated.position ? inverse_square(stated.sigma_m) : 0;
  const double turned = stated.heading_rad ? inverse_square(stated.sigma_rad) : 0;
  const Eigen::Vector2d position = stated.position.value_or(Eigen::Vector2d(0, 0));
  graph_.add_edge(EdgePriorSe2{{position[0], position[1], stated.heading_rad.value_or(0)}}, {poses_.front()},
                  Eigen::Matrix3d(Eigen::Vector3d(at, at, turned).asDiagonal()));
}

void GraphBuilder::add_motion(const DrivePart& part, std::size_t joint) {
  if (part.runs.empty()) {
    const DriveNodes all = nodes();
    const Relative& only = relative_.front();
    add_for(only.name, only.loss, [&] {
      only.model->extend({{all.stamps.subspan(joint), all.poses.subspan(joint), all.intervals.subspan(joint)},
                          only.name,
                          context_of(facts_.surroundings)},
                         graph_);
    });
    return;
  }
  for (const MotionRun& run : part.runs) {
    std::vector<Stamp> stamps;
    for (const std::size_t node : run.nodes) stamps.push_back(stamps_[node]);
    const Relative& source = relative_[run.source];
    add_for(source.name, source.loss, [&] {
      source.model->extend(
          {{stamps, track_of(run), run.intervals}, source.name, context_of(facts_.surroundings)}, graph_);
    });
  }
}

std::vector<VertexIndex> GraphBuilder::track_of(const MotionRun& run) {
  Relative& source = relative_[run.source];
  const std::optional<Eigen::Matrix3d>& tie = source.tie_information;
  std::vector<VertexIndex> track;
  for (std::size_t i = 0; i < run.nodes.size(); ++i) {
    const VertexIndex node = poses_[run.nodes[i]];
    if (i == 0 && source.end && source.end->first == stamps_[run.nodes[i]]) {
      if (const std::optional<VertexIndex> end = graph_.find(source.end->second)) {
        track.push_back(*end);
        continue;
      }
    }
    if (!tie || run.beside[i] == 0) {
      track.push_back(node);
      continue;
    }
    const auto pose = graph_.value(node);
    const VertexIndex beside = graph_.add_vertex<VertexSe2>(graph_.free_id(), {pose[0], pose[1], pose[2]});
    // The deviations are those of a mean over a second.
    const double share_s = std::min(1.0, run.intervals[std::min(i, run.intervals.size() - 1)].dt_s);
    graph_.add_edge(EdgeSe2{}, {node, beside}, share_s * *tie);
    track.push_back(beside);
  }
  source.end = {stamps_[run.nodes.back()], graph_.id(track.back())};
  return track;
}

void GraphBuilder::add_fixes(const std::vector<Fix>& fixes, const std::vector<FixMoment>& moments) {
  std::vector<std::vector<Fix>> own_fixes(absolute_.size());
  std::vector<std::vector<FixMoment>> own_moments(absolute_.size());
  for (std::size_t i = 0; i < fixes.size(); ++i) {
    const std::size_t of = absolute_of(fixes[i].source);
    own_fixes[of].push_back(fixes[i]);
    own_moments[of].push_back(moments[i]);
  }
  for (std::size_t i = 0; i < absolute_.size(); ++i) {
    const Absolute& source = absolute_[i];
    // A fix between two nodes has its antenna moved, for a modeling without a time offset too.
    const Eigen::Vector2d antenna = own_fixes[i].empty()       ? Eigen::Vector2d(0, 0)
                                    : own_fixes[i].size() == 1 ? own_moments[i].front().antenna
                                                               : own_fixes[i].front().antenna_m;
    add_for(source.group.name, std::nullopt, [&] {
      source.model->extend({own_fixes[i], own_moments[i], antenna, source.loss, source.group.claimed,
                            source.group.name, context_of(facts_.surroundings)},
                           graph_);
    });
  }
}

void GraphBuilder::dropped(const Removal& removal) {
  std::size_t gone = 0;
  while (gone < poses_.size() && removal.new_index[static_cast<std::size_t>(poses_[gone])] < 0) ++gone;
  const auto count = static_cast<std::ptrdiff_t>(gone);
  stamps_.erase(stamps_.begin(), stamps_.begin() + count);
  poses_.erase(poses_.begin(), poses_.begin() + count);
  intervals_.erase(intervals_.begin(),
                   intervals_.begin() + std::min<std::ptrdiff_t>(count, std::ssize(intervals_)));
  for (VertexIndex& pose : poses_) pose = removal.new_index[static_cast<std::size_t>(pose)];
  shares_.clear();
}

void GraphBuilder::set_claimed(int source, const ClaimedAccuracies& claimed) {
  absolute_[absolute_of(source)].group.claimed = claimed;
}

void GraphBuilder::extend(const DrivePart& part) {
  if (intervals_.empty() && part.intervals.empty() && !part.fixes.empty())
    throw UsageError("a drive that grows needs its first two nodes before its first fix");
  const std::size_t joint = poses_.empty() ? 0 : poses_.size() - 1;
  const bool begins = poses_.empty();
  add_nodes(part);
  if (begins && !poses_.empty()) add_first_pose();
  add_motion(part, joint);
  const DriveNodes all = nodes();
  std::vector<Fix> fixes(part.fixes.begin(), part.fixes.end());
  std::vector<FixMoment> moments(fixes.size());
  for (std::size_t i = 0; i < fixes.size(); ++i) {
    const double offset_s = absolute_[absolute_of(fixes[i].source)].group.time_offset_s;
    const Stamp stamp = part.fix_nodes.empty() ? fixes[i].stamp : stamps_[part.fix_nodes[i]];
    const NodeInTime near =
        *nearest_node(all, stamp.later(-offset_s), std::numeric_limits<double>::infinity());
    fixes[i].vertex = graph_.id(poses_[near.node]);
    moments[i] = moment_of_fix(all, near, fixes[i].antenna_seen_m());
    moments[i].assumed_offset_s = offset_s;
  }
  for (std::size_t i = 0; i < part.sensors.size(); ++i) {
    const PreparedSensor& sensor = part.sensors[i];
    add_for(sensor.source, sensors_.loss(i), [&] {
      sensors_.extend(i, sensor.place,
                      {all, fixes, facts_.antenna_m, sensor.readings, grid_scale_, sensor.source,
                       context_of(facts_.surroundings), part.groups.empty() ? nullptr : &part.groups[i]},
                      graph_);
    });
  }
  add_fixes(fixes, moments);
  if (!fixes.empty()) grid_scale_ = fixes.back().grid_scale;
}

BuiltGraph build_graph(const PlacedDrive& placed, std::span<const PreparedSensor> sensors,
                       const FusionSettings& settings, const TypeRegistry& registry) {
  const AcceptedFixes accepted = accepted_fixes(placed);
  GraphBuilder builder(facts_of(placed, settings), sensors, settings, registry);
  builder.check_drive(accepted.fixes, sensors);
  std::vector<MeasurementGroups> groups(sensors.size());
  builder.extend({placed.timeline.stamps, placed.start.poses, placed.timeline.intervals, accepted.fixes,
                  accepted.nodes, sensors, placed.runs, groups});
  BuiltGraph built;
  for (std::size_t i = 0; i < sensors.size(); ++i)
    if (!groups[i].members.empty()) built.groups.push_back({sensors[i].source, std::move(groups[i])});
  built.warnings = warnings_of_sensors_apart(sensors, builder.nodes());
  built.modelings = builder.modelings();
  built.shares = builder.shares();
  built.graph = std::move(builder.graph());
  return built;
}

}  // namespace waymark::drive
