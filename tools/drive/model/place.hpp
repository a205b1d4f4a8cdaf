/// A drive's nodes in time, the gate's verdicts and the initial guess: what comes
/// before any vertex.
///
/// Nodes and fixes stand in order of time, and the vertex of node i is i + 1 for good. So a drive
/// that grows appends: a new odometry sample is a new node with the interval that leads to it, a
/// new fix is judged with the fixes before it and named after its node, and the guess of a new node
/// is the pose before it moved along its interval. Nothing that stands before is renumbered.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <waymark/core/registry/registry.hpp>
#include <waymark/tools/drive/description/fusion_settings.hpp>
#include <waymark/tools/drive/logs/prepare.hpp>
#include <waymark/tools/drive/nodes/gate.hpp>
#include <waymark/tools/drive/nodes/start.hpp>
#include <waymark/tools/drive/nodes/timeline.hpp>

namespace waymark::drive {

struct PlacedDrive {
  Timeline timeline;
  std::vector<Fix>
      fixes;  ///< judged by the gate, in the order of timeline.fix_node; Fix::vertex: their nodes
  std::vector<Interval> motion;  ///< the odometry's at each fix
  GateSummary gate;
  Start start;
  Eigen::Vector2d antenna_m{0, 0};    ///< body frame
  double standstill_mps = 0;          ///< of the odometry model
  double gap_noise_factor = 1;        ///< for the odometry model, as PreparedDrive::timeline states it
  std::vector<std::string> warnings;  ///< suspicious units and signs of the logs
};

/// The vertex of a node.
[[nodiscard]] inline VertexId vertex_of(std::size_t node) {
  return static_cast<VertexId>(node) + 1;
}

/// Runs the gate and makes the initial guess.
/// @param timeline  of this drive
/// @param settings  decided
/// @throws InputError if the gate leaves no fix; what the steps throw.
[[nodiscard]] PlacedDrive place_drive(const PreparedDrive& drive, const Timeline& timeline,
                                      const FusionSettings& settings, const TypeRegistry& registry);

/// The nodes of a drive in time. @throws what build_timeline throws
[[nodiscard]] Timeline timeline_of(const PreparedDrive& drive);

/// The odometry model that the settings name, with its options and calibration states.
/// @param gap_noise_factor  for a model that has such an option and is not given one
/// @throws UsageError for an unknown model, option or value
[[nodiscard]] std::unique_ptr<OdometryModel> make_odometry_model(const FusionSettings& settings,
                                                                 double gap_noise_factor,
                                                                 const TypeRegistry& registry);

}  // namespace waymark::drive
