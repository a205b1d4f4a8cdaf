/// Builds the graph of a placed drive: poses, odometry edges, further sensors, and the connection
/// to the fixes.
///
/// The graph grows: each part of a drive adds its nodes, and each plugin adds its share of the
/// part. A drive that is known as a whole is one part. The graph of several parts has the same
/// vertices and edges as that of one, in another order (tests/tools/drive/growing_drive_test.cpp).
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <waymark/core/registry/registry.hpp>
#include <waymark/tools/drive/description/fusion_settings.hpp>
#include <waymark/tools/drive/model/place.hpp>
#include <waymark/tools/drive/model/sensors.hpp>

namespace waymark::drive {

/// What the models know of a drive before its first part.
struct DriveFacts {
  Eigen::Vector2d antenna_m{0, 0};  ///< body frame
  double time_offset_s = 0;         ///< FixMoment::assumed_offset_s
  double gap_noise_factor = 1;      ///< for the odometry model
  double median_accuracy_m = 0;     ///< for the modeling: GnssInput
};

/// The next part of a drive, in order of time. The first part with a fix has an interval, or follows
/// one: the motion at a fix is that of an interval. The spans are used during the call only.
struct DrivePart {
  std::span<const Stamp> stamps;           ///< of its nodes, later than those before
  std::span<const Eigen::Vector3d> poses;  ///< their initial guess: x, y in m, heading in rad
  /// the motion to each of these nodes from the one before; none to the first node of the drive
  std::span<const Interval> intervals;
  std::span<const Fix> fixes;  ///< accepted ones
  /// The node at the stamp of each fix, counted from the first of the drive. If fixes are assumed
  /// to be early, the nodes up to when they were measured must be there.
  std::span<const std::size_t> fix_nodes;
  /// those of the constructor, each with its next readings
  std::span<const PreparedSensor> sensors = {};
};

/// A graph that grows with its drive. Nodes are known by index, so no vertex may leave the graph.
class GraphBuilder {
 public:
  /// @param settings from decided(), with the estimated noise among the options
  /// @throws UsageError for an unknown modeling, model, sensor or option
  GraphBuilder(const DriveFacts& facts, std::span<const PreparedSensor> sensors,
               const FusionSettings& settings, const TypeRegistry& registry);

  /// Judges a drive that is known as a whole, before its one part. @throws InputError of a sensor
  void check_drive(std::span<const Fix> accepted, std::span<const PreparedSensor> sensors) const {
    sensors_.check_drive(sensors, accepted);
  }

  /// Adds the vertices and edges of a part.
  /// @throws UsageError for fixes before the first interval; errors of the plugins
  void extend(const DrivePart& part);

  /// The nodes so far. The view is valid until the next part.
  [[nodiscard]] DriveNodes nodes() const { return {stamps_, poses_, intervals_}; }
  /// The graph so far. It may be optimised between two parts, and moved from after the last one.
  [[nodiscard]] Graph& graph() { return graph_; }
  /// The model of the fixes, with what it keeps of the graph.
  [[nodiscard]] std::shared_ptr<const GnssModeling> modeling() const { return modeling_; }

 private:
  void add_nodes(const DrivePart& part);

  DriveFacts facts_;
  std::optional<Loss> loss_;
  std::unique_ptr<OdometryModel> odometry_;
  SensorModels sensors_;
  std::shared_ptr<GnssModeling> modeling_;
  Graph graph_;
  std::vector<Stamp> stamps_;
  std::vector<VertexIndex> poses_;
  std::vector<Interval> intervals_;
  double grid_scale_ = 1;  ///< of the last fix
};

/// A graph at its initial guess.
struct BuiltGraph {
  Graph graph;                        ///< the pose of node i has the id i + 1
  std::vector<std::string> warnings;  ///< of the sensors
  std::shared_ptr<const GnssModeling> modeling;
};

/// Builds the graph of the accepted fixes of a whole drive.
/// @param sensors further ones, on the clock and in the frame of the drive; may be empty
/// @param settings from decided(), with the estimated noise among the options
/// @throws UsageError for an unknown modeling or option; errors of the plugins
[[nodiscard]] BuiltGraph build_graph(const PlacedDrive& placed, std::span<const PreparedSensor> sensors,
                                     const FusionSettings& settings, const TypeRegistry& registry);

}  // namespace waymark::drive
