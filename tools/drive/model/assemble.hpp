/// The graph of a drive: nodes, odometry edges, the gate's verdicts, the start, a GNSS modeling.
#pragma once

#include <waymark/core/registry/registry.hpp>
#include <waymark/formats/graph/graph_document.hpp>
#include <waymark/tools/drive/description/config.hpp>
#include <waymark/tools/drive/logs/prepare.hpp>
#include <waymark/tools/drive/nodes/gate.hpp>
#include <waymark/tools/drive/nodes/start.hpp>
#include <waymark/tools/drive/nodes/timeline.hpp>

namespace waymark::drive {

/// A drive's nodes in time, the gate's verdicts and the start: what comes before any vertex.
struct PlacedDrive {
  Timeline timeline;
  std::vector<Fix> fixes;  ///< judged by the gate, in the order of timeline.fix_node
  GateSummary gate;
  Start start;
  std::vector<std::string> warnings;  ///< what looks wrong about units and signs of the logs
  double standstill_mps = 0;          ///< of the odometry model
};

/// Builds the timeline, runs the gate and makes the start.
/// @throws InputError where the gate leaves no fix; what the steps throw.
[[nodiscard]] PlacedDrive place_drive(const PreparedDrive& drive, const DriveConfig& config,
                                      const TypeRegistry& registry);

/// The odometry model that the drive.yaml names, with its options and calibration states.
/// @throws InputError with the place of what is wrong
[[nodiscard]] std::unique_ptr<OdometryModel> make_odometry_model(const DriveConfig& config,
                                                                 const TypeRegistry& registry);

/// Everything that is the same for all modelings of a drive.
struct DriveSkeleton {
  formats::GraphDocument
      document;  ///< poses with stamps, odometry edges, records of all fixes; no GNSS edges yet
  GateSummary gate;
  Start start;
  std::vector<Interval> motion_at_fixes;  ///< the odometry's motion at each fix of the document
  std::vector<std::string> warnings;      ///< what looks wrong about units and signs of the logs
  double distance_m = 0;                  ///< driven, by the odometry
};

/// Builds vertices, odometry edges and the further sensors' part. Pose ids are 1, 2, ... in order of time.
/// @param placed  of this drive and config
/// @throws what the odometry model and the sensors throw
[[nodiscard]] DriveSkeleton build_skeleton(const PlacedDrive& placed, const PreparedDrive& drive,
                                           const DriveConfig& config, const TypeRegistry& registry);
/// place_drive and the above.
[[nodiscard]] DriveSkeleton build_skeleton(const PreparedDrive& drive, const DriveConfig& config,
                                           const TypeRegistry& registry);

/// The options of the chosen odometry model or GNSS modeling with the calibration states that it knows.
/// @param known  the options that it has
[[nodiscard]] Options with_calibration(Options options, const DriveConfig& config,
                                       const std::vector<OptionInfo>& known);

/// @throws InputError with its place for a calibration state that neither the odometry model nor one of the
/// modelings knows
void check_calibration(const DriveConfig& config, const std::vector<std::string>& modelings,
                       const TypeRegistry& registry);

/// The skeleton's document with the modeling's vertices and edges for the accepted fixes.
/// @param loss  of the fixes; none: their errors are squared
/// @throws UsageError for an unknown modeling or option
[[nodiscard]] formats::GraphDocument add_modeling(const DriveSkeleton& skeleton, const std::string& modeling,
                                                  const Options& options, const TypeRegistry& registry,
                                                  const std::optional<Loss>& loss = std::nullopt);

/// The poses at the fixes, in their order. @throws InputError where a fix's vertex is no pose, or has no
/// stamp or another than the fix.
[[nodiscard]] std::vector<StampedPose> poses_at_fixes(const formats::GraphDocument& document);

/// The covariances of their positions, m^2, frame axes, in the order of the fixes; empty where the document
/// has none of a pose.
[[nodiscard]] std::vector<std::optional<Eigen::Matrix2d>> position_covariances_at_fixes(
    const formats::GraphDocument& document);

/// The poses when the fixes were really measured: at their stamps minus the estimated time offset, along the
/// constant twist between the nodes beside. Empty where the graph estimates none.
[[nodiscard]] std::vector<Eigen::Vector3d> poses_when_measured(const formats::GraphDocument& document);

}  // namespace waymark::drive
