/// Builds the graph of a placed drive: poses, odometry edges, further sensors, and the connection
/// to the fixes.
///
/// The graph grows: each part of a drive adds its nodes, and each plugin adds its share of the
/// part. A drive that is known as a whole is one part. The graph of several parts has the same
/// vertices and edges as that of one, in another order (tests/tools/drive/growing_drive_test.cpp).
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <waymark/core/registry/registry.hpp>
#include <waymark/formats/graph/graph_document.hpp>
#include <waymark/tools/drive/description/fusion_settings.hpp>
#include <waymark/tools/drive/model/motion_runs.hpp>
#include <waymark/tools/drive/model/place.hpp>
#include <waymark/tools/drive/sensors/sensor_models.hpp>

namespace waymark::drive {

/// What a source has added to the graph.
struct SourceShare {
  std::vector<formats::VertexRange> vertices;  ///< ranges of ids, first and last
  std::vector<formats::EdgeShare> edges;
};
using SourceShares = std::map<std::string, SourceShare>;  ///< by name of the source

/// Absolute sources that one model serves: one, or several that share their lasting errors.
struct AbsoluteGroup {
  std::string name;             ///< of the source that the others of the group name
  std::vector<int> sources;     ///< Fix::source of its members
  double time_offset_s = 0;     ///< FixMoment::assumed_offset_s
  ClaimedAccuracies claimed{};  ///< for the modeling: GnssInput
};

/// What the models know of a drive before its first part.
struct DriveFacts {
  std::vector<AbsoluteGroup> absolute;
  std::vector<std::string> relative;      ///< names of the relative sources, the one of the nodes first
  Eigen::Vector2d antenna_m{0, 0};        ///< of the first receiver, body frame
  double gap_noise_factor = 1;            ///< for the odometry models
  std::optional<FirstPose> first_pose{};  ///< of the first node: it becomes a prior
  std::shared_ptr<const DriveSurroundings> surroundings{};  ///< null: plugins see nothing else
};

/// Returns the facts of a drive that is known as a whole. @param settings from decided()
[[nodiscard]] DriveFacts facts_of(const PlacedDrive& placed, const FusionSettings& settings);

/// Returns the groups of the absolute sources, in the order of their first members.
[[nodiscard]] std::vector<AbsoluteGroup> groups_of(const PlacedDrive& placed, const FusionSettings& settings);

/// The next part of a drive, in order of time. The first part with a fix has an interval, or follows
/// one: the motion at a fix is that of an interval. The spans are used during the call only.
struct DrivePart {
  std::span<const Stamp> stamps;           ///< of its nodes, later than those before
  std::span<const Eigen::Vector3d> poses;  ///< their initial guess: x, y in m, heading in rad
  /// the motion to each of these nodes from the one before; none to the first node of the drive
  std::span<const Interval> intervals;
  std::span<const Fix> fixes;  ///< accepted ones
  /// The node at the stamp of each fix, counted from the first of the drive. If fixes are assumed
  /// to be early, the nodes up to when they were measured must be there. Empty: fixes lie between
  /// nodes, and belong to the nearest ones.
  std::span<const std::size_t> fix_nodes;
  /// those of the constructor, each with its next readings
  std::span<const PreparedSensor> sensors = {};
  /// what the relative sources measured, if there are several; otherwise `intervals` say it
  std::span<const MotionRun> runs = {};
  /// one for each sensor, to be filled by its model; empty: nobody asks
  std::span<MeasurementGroups> groups = {};
};

/// A graph that grows with its drive. Vertices may leave it if dropped() is told so.
class GraphBuilder {
 public:
  /// @param settings from decided(), with the estimated noise among the options
  /// @throws UsageError for an unknown modeling, model, sensor or option
  GraphBuilder(DriveFacts facts, std::span<const PreparedSensor> sensors, const FusionSettings& settings,
               const TypeRegistry& registry);

  /// Judges a drive that is known as a whole, before its one part. @throws InputError of a sensor
  void check_drive(std::span<const Fix> accepted, std::span<const PreparedSensor> sensors) const {
    sensors_.check_drive(sensors, accepted);
  }

  /// Adds the vertices and edges of a part.
  /// @throws UsageError for fixes before the first interval; errors of the plugins
  void extend(const DrivePart& part);

  /// Follows a graph that has lost its oldest vertices. What sources have added is forgotten.
  /// @param removal the result of Graph::remove_vertices
  void dropped(const Removal& removal);
  /// Tells what the fixes of an absolute source claim, of the ones so far. @param source Fix::source
  void set_claimed(int source, const ClaimedAccuracies& claimed);

  /// The nodes so far, without those that were dropped. The view is valid until the next part.
  [[nodiscard]] DriveNodes nodes() const { return {stamps_, poses_, intervals_}; }
  /// The graph so far. It may be optimised between two parts, and moved from after the last one.
  [[nodiscard]] Graph& graph() { return graph_; }
  /// The models of the fixes, with what they keep of the graph: one for each absolute source.
  [[nodiscard]] std::vector<std::shared_ptr<const GnssModeling>> modelings() const;
  /// What each source has added, by its name.
  [[nodiscard]] const SourceShares& shares() const { return shares_; }

 private:
  struct Relative {
    std::string name;
    std::unique_ptr<OdometryModel> model;
    /// of the ties between its track and the nodes; empty if it joins the nodes themselves
    std::optional<Eigen::Matrix3d> tie_information;
    std::optional<Loss> loss;
    /// where its track ends: the stamp of the node, and the pose at it or beside it
    std::optional<std::pair<Stamp, VertexId>> end{};
  };
  struct Absolute {
    AbsoluteGroup group;
    std::optional<Loss> loss;
    std::shared_ptr<GnssModeling> model;
  };
  void add_nodes(const DrivePart& part);
  void add_first_pose();
  void add_motion(const DrivePart& part, std::size_t joint);
  /// Returns the poses of a run: the nodes, or poses beside them. A run that begins where the last one of
  /// its source ended goes on from there.
  [[nodiscard]] std::vector<VertexIndex> track_of(const MotionRun& run);
  void add_fixes(const std::vector<Fix>& fixes, const std::vector<FixMoment>& moments);
  [[nodiscard]] std::size_t absolute_of(int source) const;
  /// Runs a step of a source, and keeps which vertices and edges it adds. A loss is put on those
  /// edges that join a pose: they measure, and others describe how states change.
  template <typename Step>
  void add_for(const std::string& source, const std::optional<Loss>& loss, const Step& step);
  [[nodiscard]] std::vector<std::size_t> batch_sizes() const;
  void put_loss(const Loss& loss, std::size_t batch, std::size_t first);

  DriveFacts facts_;
  std::vector<Relative> relative_;
  SensorModels sensors_;
  std::vector<Absolute> absolute_;
  SourceShares shares_;
  Graph graph_;
  std::vector<Stamp> stamps_;
  std::vector<VertexIndex> poses_;
  std::vector<Interval> intervals_;
  double grid_scale_ = 1;  ///< of the last fix
};

/// A graph at its initial guess.
struct BuiltGraph {
  Graph graph;                                                 ///< the pose of node i has the id i + 1
  std::vector<std::string> warnings;                           ///< of the sensors
  std::vector<std::shared_ptr<const GnssModeling>> modelings;  ///< one for each absolute source
  SourceShares shares;
  std::vector<GroupsOfSource> groups;  ///< of the sensors that tell of any
};

/// Builds the graph of the accepted fixes of a whole drive.
/// @param sensors further ones, on the clock and in the frame of the drive; may be empty
/// @param settings from decided(), with the estimated noise among the options
/// @throws UsageError for an unknown modeling or option; errors of the plugins
[[nodiscard]] BuiltGraph build_graph(const PlacedDrive& placed, std::span<const PreparedSensor> sensors,
                                     const FusionSettings& settings, const TypeRegistry& registry);

}  // namespace waymark::drive
