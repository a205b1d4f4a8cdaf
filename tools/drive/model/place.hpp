/// The nodes of a drive in time, the verdicts of the gate and the initial guess: everything before
/// the first vertex.
///
/// Nodes and fixes are in order of time. This is the placing of a drive that is known as a whole:
/// the vertex of node i is i + 1, and gate and initial guess look at all fixes. A drive that grows
/// is placed by its caller, part by part (DrivePart in build.hpp).
#pragma once

#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <waymark/core/registry/registry.hpp>
#include <waymark/tools/drive/description/fusion_settings.hpp>
#include <waymark/tools/drive/logs/prepare.hpp>
#include <waymark/tools/drive/model/motion_runs.hpp>
#include <waymark/tools/drive/nodes/gate.hpp>
#include <waymark/tools/drive/nodes/start.hpp>
#include <waymark/tools/drive/nodes/timeline.hpp>

namespace waymark::drive {

class DriveSurroundings;  // surroundings.hpp

struct PlacedDrive {
  Timeline timeline;
  /// with verdicts of the gate, in the order of timeline.fix_node; Fix::vertex names the node
  std::vector<Fix> fixes;
  GateSummary gate;
  Start start;
  std::vector<std::string> receivers;  ///< names of the absolute sources
  /// how late the graph assumes the fixes of each absolute source to be: latency.hpp
  std::vector<double> time_offsets_s;
  /// time of the filter of each absolute source (ReceiverFilter), s; 0: it does not smooth
  std::vector<double> smoothings_s;
  std::string odometry_name;                 ///< the relative source that nodes come from
  std::vector<PreparedOdometry> relative{};  ///< as PreparedDrive::relative
  std::vector<MotionRun> runs{};             ///< what these measured; empty if there is one
  double standstill_mps = 0;                 ///< of the odometry model
  double gap_noise_factor = 1;               ///< for the odometry model, from PreparedDrive::timeline
  std::vector<std::string> warnings;         ///< of the preparation; suspicious units, signs, jumps
  std::set<std::string> left_out{};          ///< names of sources that others contradict
  std::optional<double> speed_factor{};      ///< of the odometry, far from 1 (Shape::speed_factor)
  std::optional<double> turn_factor{};       ///< the same of its turns (Shape::turn_factor)
  std::optional<YawBias> yaw_bias{};         ///< of its yaw rate, if it is large (Shape::yaw_bias)
  std::string misreading{};                  ///< also a warning; Fusion::model() refuses such a drive
  std::optional<FirstPose> first_pose{};     ///< as PreparedDrive::first_pose
  /// what plugins may know of the whole drive; null: nothing
  std::shared_ptr<const DriveSurroundings> surroundings{};
};

/// Returns the vertex of a node.
[[nodiscard]] inline VertexId vertex_of(std::size_t node) {
  return VertexId(node + 1);
}

/// Returns the name of an absolute source; "gnss" if none is known.
[[nodiscard]] std::string receiver_name(const PlacedDrive& placed, int source);

/// Returns what precedes a sentence about the odometry that gives the nodes: its name, if there are several.
[[nodiscard]] std::string of_several(const PlacedDrive& placed);

/// Returns Fix::smoothed_m for the fixes of a drive, in their order, at the time offsets that the graph assumes.
[[nodiscard]] std::vector<Eigen::Vector2d> smoothed_at_fixes(const PlacedDrive& placed);

/// Takes that for all fixes.
void take_smoothing(PlacedDrive& placed);

/// Runs the gate and computes the initial guess.
/// @param timeline of this drive
/// @param settings from decided()
/// A drive without receivers has no gate, and its initial guess is that of search_start().
/// @throws InputError if the gate leaves no fix; errors of the steps
[[nodiscard]] PlacedDrive place_drive(const PreparedDrive& drive, const Timeline& timeline,
                                      const FusionSettings& settings, const TypeRegistry& registry);

/// Returns the nodes of a drive in time. @throws what build_timeline throws
[[nodiscard]] Timeline timeline_of(const PreparedDrive& drive);

/// Returns the odometry model that the settings choose, with its options and calibration states.
/// @param settings from for_relative()
/// @param gap_noise_factor for a model with such an option, unless it is stated
/// @throws UsageError for an unknown model, option or value
[[nodiscard]] std::unique_ptr<OdometryModel> make_odometry_model(const FusionSettings& settings,
                                                                 double gap_noise_factor,
                                                                 const TypeRegistry& registry);

}  // namespace waymark::drive
