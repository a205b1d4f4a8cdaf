#include <waymark/tools/drive/model/build.hpp>

#include <limits>
#include <utility>

#include <waymark/core/base/error.hpp>
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
  for (std::size_t i = 0; i < placed.fixes.size(); ++i) {
    if (placed.fixes[i].status != FixStatus::accepted) continue;
    accepted.fixes.push_back(placed.fixes[i]);
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

}  // namespace

GraphBuilder::GraphBuilder(const DriveFacts& facts, std::span<const PreparedSensor> sensors,
                           const FusionSettings& settings, const TypeRegistry& registry)
    : facts_(facts),
      loss_(loss_of_fixes(settings.loss, registry)),
      odometry_(make_odometry_model(settings, facts.gap_noise_factor, registry)),
      sensors_(sensors, registry),
      modeling_(registry.make_gnss_modeling(settings.modeling, settings.modeling_options)) {}

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

void GraphBuilder::extend(const DrivePart& part) {
  if (intervals_.empty() && part.intervals.empty() && !part.fixes.empty())
    throw UsageError("a drive that grows needs its first two nodes before its first fix");
  const std::size_t joint = poses_.empty() ? 0 : poses_.size() - 1;
  add_nodes(part);
  const DriveNodes all = nodes();
  odometry_->extend({all.stamps.subspan(joint), all.poses.subspan(joint), all.intervals.subspan(joint)},
                    graph_);
  std::vector<Fix> fixes(part.fixes.begin(), part.fixes.end());
  std::vector<FixMoment> moments(fixes.size());
  for (std::size_t i = 0; i < fixes.size(); ++i) {
    const Stamp stamp = stamps_[part.fix_nodes[i]];
    const NodeInTime near =
        *nearest_node(all, stamp.later(-facts_.time_offset_s), std::numeric_limits<double>::infinity());
    fixes[i].vertex = graph_.id(poses_[near.node]);
    moments[i] = moment_of_fix(all, near, facts_.antenna_m);
    moments[i].assumed_offset_s = facts_.time_offset_s;
  }
  sensors_.extend(part.sensors, all, fixes, facts_.antenna_m, grid_scale_, graph_);
  modeling_->extend({fixes, moments, facts_.antenna_m, loss_, facts_.median_accuracy_m}, graph_);
  if (!fixes.empty()) grid_scale_ = fixes.back().grid_scale;
}

BuiltGraph build_graph(const PlacedDrive& placed, std::span<const PreparedSensor> sensors,
                       const FusionSettings& settings, const TypeRegistry& registry) {
  const AcceptedFixes accepted = accepted_fixes(placed);
  const DriveFacts facts{placed.antenna_m, placed.time_offset_s, placed.gap_noise_factor,
                         median_accuracy(placed.fixes)};
  GraphBuilder builder(facts, sensors, settings, registry);
  builder.check_drive(accepted.fixes, sensors);
  builder.extend({placed.timeline.stamps, placed.start.poses, placed.timeline.intervals, accepted.fixes,
                  accepted.nodes, sensors});
  BuiltGraph built;
  built.warnings = warnings_of_sensors_apart(sensors, builder.nodes());
  built.modeling = builder.modeling();
  built.graph = std::move(builder.graph());
  return built;
}

}  // namespace waymark::drive
