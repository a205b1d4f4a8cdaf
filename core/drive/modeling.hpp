/// The interfaces through which a drive becomes a graph: how odometry intervals become edges, how GNSS fixes
/// and the readings of further sensors become vertices and edges. Implementations are plugins.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <waymark/core/drive/sample.hpp>
#include <waymark/core/graph/loss.hpp>
#include <waymark/core/graph/vertex.hpp>
#include <waymark/core/registry/options.hpp>

namespace waymark {

class Graph;  // core/graph/graph.hpp

/// The nodes of a drive in time: where everything that is measured finds its pose.
struct DriveNodes {
  std::span<const Stamp> stamps;  ///< strictly increasing, on the drive's scale
  std::span<const VertexIndex>
      poses;  ///< VERTEX_SE2 of each node; its value is the start of the optimisation
  std::span<const Interval> intervals;  ///< the motion from each node to the next: one fewer
};

/// The node nearest to a moment.
struct NodeInTime {
  std::size_t node = 0;
  double ahead_s = 0;  ///< the moment minus the node's stamp
};
/// Empty where the moment lies more than `tolerance_s` outside the drive.
[[nodiscard]] std::optional<NodeInTime> nearest_node(const DriveNodes& nodes, Stamp moment,
                                                     double tolerance_s = 0.05);

/// The odometry's motion at a node: of the interval after it, at the last node of the one before.
[[nodiscard]] const Interval& motion_at(const DriveNodes& nodes, std::size_t node);

/// Joins the poses of neighbouring nodes.
class OdometryModel {
 public:
  virtual ~OdometryModel();
  /// Adds one edge (or more) per interval, and the states that it calibrates (ids from Graph::free_id).
  virtual void build(const DriveNodes& nodes, Graph& graph) const = 0;
  /// |speed| in m/s below which the vehicle counts as standing: its measured motion is then the identity.
  [[nodiscard]] virtual double standstill_speed() const = 0;
};

/// What a GNSS modeling works on.
struct GnssInput {
  std::span<const Fix> fixes;        ///< accepted ones only; Fix::vertex names the pose at the epoch
  std::span<const Interval> motion;  ///< the odometry's motion at each of them
  Eigen::Vector2d antenna = {0, 0};  ///< antenna in the body frame, m
  std::optional<Loss> loss = {};     ///< robust loss of the edges that carry the fixes' information
};

/// Ties the poses to the fixes (the paper's G1, G2, G3, and what plugins bring).
class GnssModeling {
 public:
  virtual ~GnssModeling();
  /// Adds vertices (ids from Graph::free_id) and edges for all fixes. Existing vertices' values are the start
  /// of the optimisation.
  virtual void build(const GnssInput& input, Graph& graph) const = 0;
};

/// What a sensor model works on.
struct SensorInput {
  DriveNodes nodes;
  std::span<const Fix> fixes;  ///< accepted ones only, with what their receiver says of course and speed
  Eigen::Vector2d antenna = {0, 0};  ///< GNSS antenna in the body frame, m
  const SensorTable& readings;  ///< the sensor's log in SI units; empty where the type asks for no columns
};

/// Ties the poses to what a further sensor read: a compass, a scan matcher, a landmark detector.
class SensorModel {
 public:
  virtual ~SensorModel();
  /// Adds vertices (ids from Graph::free_id) and edges for all readings that lie within the drive.
  /// @throws InputError for readings that make no sense, naming the row
  virtual void build(const SensorInput& input, Graph& graph) const = 0;
};

struct OdometryModelType {
  std::string name;
  std::string description;
  std::vector<OptionInfo> options;
  std::function<std::unique_ptr<OdometryModel>(const CheckedOptions&)> make;
  /// The option that is the variance factor of bridged intervals (Interval::bridged); empty: there is none. A
  /// drive sets it from its timeline if nobody states it.
  std::string gap_factor_option = {};
};

struct GnssModelingType {
  std::string name;
  std::string description;
  std::vector<OptionInfo> options;
  std::function<std::unique_ptr<GnssModeling>(const CheckedOptions&)> make;
  /// Whether outliers, biases and the odometry's calibration are part of its error model. Then a drive has no
  /// gate, all calibration states and an estimated noise, unless it says otherwise; else the paper's gate,
  /// none of the states and the noise as stated.
  bool complete = false;
};

/// A registered sensor. drive.yaml names it under `sensors`; a log reader brings its columns.
struct SensorModelType {
  std::string name;
  std::string description;
  std::vector<SensorColumn> columns;  ///< beside `time`; empty: the sensor has no log of its own
  std::vector<OptionInfo> options;
  std::function<std::unique_ptr<SensorModel>(const CheckedOptions&)> make;
};

}  // namespace waymark
