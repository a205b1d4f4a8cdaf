#include <waymark/tools/drive/model/build.hpp>

#include <waymark/tools/drive/model/sensors.hpp>
#include <waymark/types_se2/vertex_se2.hpp>

namespace waymark::drive {
namespace {

/// Adds a pose for every node, with its stamp, at the initial guess.
std::vector<VertexIndex> add_poses(const PlacedDrive& placed, Graph& graph) {
  const Timeline& timeline = placed.timeline;
  std::vector<VertexIndex> poses;
  poses.reserve(timeline.stamps.size());
  for (std::size_t node = 0; node < timeline.stamps.size(); ++node) {
    const Eigen::Vector3d& pose = placed.start.poses[node];
    poses.push_back(graph.add_vertex<VertexSe2>(vertex_of(node), {pose[0], pose[1], pose[2]}));
    graph.set_stamp(poses.back(), timeline.stamps[node]);
  }
  return poses;
}

/// The fixes in the graph, and the motion of the odometry at them.
struct AcceptedFixes {
  std::vector<Fix> fixes;
  std::vector<Interval> motion;
};

AcceptedFixes accepted_fixes(const PlacedDrive& placed) {
  AcceptedFixes accepted;
  for (std::size_t i = 0; i < placed.fixes.size(); ++i) {
    if (placed.fixes[i].status != FixStatus::accepted) continue;
    accepted.fixes.push_back(placed.fixes[i]);
    accepted.motion.push_back(placed.motion[i]);
  }
  return accepted;
}

}  // namespace

BuiltGraph build_graph(const PlacedDrive& placed, std::span<const PreparedSensor> sensors,
                       const FusionSettings& settings, const TypeRegistry& registry) {
  BuiltGraph built;
  const std::vector<VertexIndex> poses = add_poses(placed, built.graph);
  const DriveNodes nodes{placed.timeline.stamps, poses, placed.timeline.intervals};
  make_odometry_model(settings, placed.gap_noise_factor, registry)->build(nodes, built.graph);
  const AcceptedFixes accepted = accepted_fixes(placed);
  built.warnings = add_sensors(sensors, nodes, accepted.fixes, placed.antenna_m, registry, built.graph);
  registry.make_gnss_modeling(settings.modeling, settings.modeling_options)
      ->build({accepted.fixes, accepted.motion, placed.antenna_m, loss_of_fixes(settings.loss, registry)},
              built.graph);
  return built;
}

}  // namespace waymark::drive
