/// The interfaces through which a drive becomes a graph. Odometry intervals become edges; GNSS
/// fixes and readings of further sensors become vertices and edges. Implementations are plugins.
///
/// A model serves one graph and lets it grow: each call of extend() adds the next part of the drive.
/// A drive that is known as a whole is one part. So a model keeps what the next call continues
/// from: the last states, the landmarks seen. It keeps vertices by id (KeptVertex), because
/// vertices may leave the graph between two calls, as in a sliding window, and indices change then.
///
/// Spans in inputs are valid only during the call. One thread at a time may use a model. It belongs
/// to the caller of its factory.
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include <waymark/core/base/export.hpp>
#include <waymark/core/drive/drive_context.hpp>
#include <waymark/core/drive/measurement_groups.hpp>
#include <waymark/core/drive/sample.hpp>
#include <waymark/core/graph/loss.hpp>
#include <waymark/core/graph/vertex.hpp>
#include <waymark/core/registry/options.hpp>

namespace WAYMARK_EXPORT waymark {

class Graph;  // core/graph/graph.hpp

/// The nodes of a drive in time. Every measurement finds its pose among them.
struct DriveNodes {
  std::span<const Stamp> stamps;       ///< strictly increasing, on the drive's scale
  std::span<const VertexIndex> poses;  ///< VERTEX_SE2 of each node; its value is the initial guess
  /// the motion from each node to the next; one fewer than nodes
  std::span<const Interval> intervals;
};

/// The node nearest to a moment.
struct NodeInTime {
  std::size_t node = 0;
  double ahead_s = 0;  ///< the moment minus the node's stamp
};
/// Returns the node nearest to a moment. Empty if the moment is more than `tolerance_s`
/// outside the drive.
[[nodiscard]] std::optional<NodeInTime> nearest_node(const DriveNodes& nodes, Stamp moment,
                                                     double tolerance_s = 0.05);

/// Returns the motion of the odometry at a node: that of the interval after it, or before it for
/// the last node.
[[nodiscard]] const Interval& motion_at(const DriveNodes& nodes, std::size_t node);
/// The motion of the odometry from a node to a moment near it.
struct MotionFromNode {
  /// Mean twist times time: forward [m], 0, turn [rad]. Negative for a moment before the node.
  Eigen::Vector3d way = Eigen::Vector3d::Zero();
  Eigen::Vector3d twist = Eigen::Vector3d::Zero();  ///< at the moment: forward [m/s], 0, yaw rate [rad/s]
};
/// Returns the motion in the interval that contains a moment, which is linear there; beyond the
/// nodes it stays what it is at the last one. At a node itself the interval before counts, so that
/// the next part of a drive changes nothing. @param nodes with one interval at least
[[nodiscard]] MotionFromNode motion_from_node(const DriveNodes& nodes, const NodeInTime& moment);

/// The input of an odometry model.
struct OdometryInput {
  /// the next part: its first node is the last one of the part before, or a later one if the source was
  /// silent in between
  DriveNodes nodes;
  std::string_view source = {};  ///< name of the source that measured the intervals
  const DriveContext& context = DriveContext::none();
};

/// Joins the poses of consecutive nodes.
class OdometryModel {
 public:
  virtual ~OdometryModel();
  /// Adds one or more edges per interval, and the states that the model calibrates (ids from
  /// Graph::free_id).
  virtual void extend(const OdometryInput& input, Graph& graph) = 0;
  /// Returns |speed| in m/s below which the vehicle stands. Its measured motion is then
  /// the identity.
  [[nodiscard]] virtual double standstill_speed() const = 0;
};

/// The antenna when a fix was measured, if the fix is late by the assumed offset.
struct FixMoment {
  /// in the body frame of the pose that Fix::vertex names, m. It is the lever arm, where the receiver has it
  /// (Fix::antenna_seen_m), moved by the odometry from the stamp of that pose to the moment.
  Eigen::Vector2d antenna = {0, 0};
  /// of the antenna, in the same axes, (grid) m/s
  Eigen::Vector2d velocity = {0, 0};
  double assumed_offset_s = 0;  ///< late: > 0
};

/// Kinds of solutions, from coarse to fine. Their errors differ by orders of magnitude, and one kind's
/// bias tells nothing of another's.
enum class SolutionKind { code, floating, fixed };

/// Returns `floating` and `fixed` for the qualities of these names, else `code`.
[[nodiscard]] SolutionKind kind_of(FixQuality quality);

/// What the accepted fixes of a drive claim about their accuracy, for each kind of solution.
struct ClaimedAccuracies {
  /// by SolutionKind: the median of Fix::accuracy_m, in m; 0 if no fix of the kind claims any
  /// (Fix::accuracy_claimed); empty if there is no fix of it
  std::array<std::optional<double>, 3> median_m{};
  /// by SolutionKind: the median of what stands in for claims, in m; 0 if there is no such fix
  std::array<double, 3> stand_in_m{};

  /// Returns the median of a kind. Of one that claims nothing: that of its stand-ins if there are other kinds, which
  /// then says how much coarser or finer it is than those; else 0.
  [[nodiscard]] double of(SolutionKind kind) const;
  /// Returns the median of the coarsest kind of which there are fixes: parameters of a modeling hold for it.
  [[nodiscard]] double reference_m() const;
  /// Returns the number of kinds of which there are fixes.
  [[nodiscard]] int kinds() const;
};
[[nodiscard]] ClaimedAccuracies claimed_accuracies(std::span<const Fix> fixes);

/// The input of a GNSS modeling.
struct GnssInput {
  /// only accepted ones; Fix::vertex names the pose nearest in time to when it was measured: the
  /// pose at its stamp if its assumed offset is 0
  std::span<const Fix> fixes;
  /// One for each fix. A modeling without a time offset may leave them alone: the assumed offset is
  /// then 0, and FixMoment::antenna is `antenna`, unless the receiver smooths (Fix::smoothed_m). May be empty for
  /// such a modeling.
  std::span<const FixMoment> moments;
  /// of the first fix in the body frame, m; all others have it too unless errors are shared
  Eigen::Vector2d antenna = {0, 0};
  /// robust loss of the edges that carry the information of the fixes
  std::optional<Loss> loss = {};
  /// claimed_accuracies() of all fixes of the drive, of the ones so far if it grows; none: of these fixes
  ClaimedAccuracies claimed = {};
  /// name of the source of these fixes; of the first one if several share their errors
  std::string_view source = {};
  const DriveContext& context = DriveContext::none();
};

/// The error of a fix (measured minus antenna, m, frame) as a modeling expects it: what states of a graph
/// tell of it, and a rest that is independent of them.
struct ExpectedError {
  struct Term {
    VertexIndex vertex;      ///< with two values
    Eigen::Matrix2d factor;  ///< of its value
  };
  std::vector<Term> terms;
  /// covariance of the rest, m^2: what happens between the states, and the noise that is new in each fix
  Eigen::Matrix2d rest = Eigen::Matrix2d::Zero();

  /// Returns the expectation at the values of the graph, m.
  [[nodiscard]] Eigen::Vector2d mean(const Graph& graph) const;
};

/// Connects poses and the fixes of one source (the paper's G1, G2, G3, and those of plugins). Several
/// sources are served by one object only if they share their errors (GnssModelingType::shares_errors).
class GnssModeling {
 public:
  virtual ~GnssModeling();
  /// Adds vertices (ids from Graph::free_id) and edges for the fixes, the next ones in time. The
  /// values of existing vertices are the initial guess.
  virtual void extend(const GnssInput& input, Graph& graph) = 0;
  /// Predicts the errors of fixes that are not in the graph from those that are, by the part of them that
  /// lasts. A model of white noise has none.
  /// @param fixes those that extend() never saw, in order of time
  /// @param minimum the graph that extend() built, at its minimum; no vertex has left it
  /// @returns one error for each fix, or for none of them: there is no such part
  [[nodiscard]] virtual std::vector<ExpectedError> lasting_errors(std::span<const Fix> fixes,
                                                                  const Graph& minimum) const;
};

/// The input of a sensor model.
struct SensorInput {
  /// all nodes in the graph, those of former parts too: a reading may look back
  DriveNodes nodes;
  /// the next ones, only accepted ones, with course and speed of their receiver
  std::span<const Fix> fixes;
  Eigen::Vector2d antenna = {0, 0};  ///< antenna of the first receiver in the body frame, m
  /// the next readings of the sensor in SI units; empty if the type has no columns
  const SensorTable& readings;
  double grid_scale = 1;         ///< grid metres per metre on the ground, at the last fix before these
  std::string_view source = {};  ///< name of the source that the readings are of
  const DriveContext& context = DriveContext::none();
  /// where the model may tell what its measurements are about, for reports; null: nobody asks
  MeasurementGroups* groups = nullptr;
};

/// Connects poses with the readings of a further sensor: a compass, a scan matcher, a
/// landmark detector.
class SensorModel {
 public:
  virtual ~SensorModel();
  /// Judges a drive that is known as a whole, before it becomes a graph.
  /// @param fixes, readings all of the drive
  /// @throws InputError if the drive has nothing that the sensor could use
  virtual void check_drive(std::span<const Fix> fixes, const SensorTable& readings) const;
  /// Returns where readings alone place the vehicle, in any order: for frame and initial guess of a
  /// drive without fixes. They are not measurements of the graph. It is called before there is a
  /// frame, so columns of places are still as in the log. Less than half of them may be wrong.
  /// @throws InputError for impossible readings
  [[nodiscard]] virtual std::vector<RoughPosition> rough_positions(const SensorTable& readings) const;
  /// Adds vertices (ids from Graph::free_id) and edges for all readings within the drive.
  /// @throws InputError for impossible readings; it names the row
  virtual void extend(const SensorInput& input, Graph& graph) = 0;
};

struct OdometryModelType {
  std::string name;
  std::string description;
  std::vector<OptionInfo> options;
  std::function<std::unique_ptr<OdometryModel>(const CheckedOptions&)> make;
  /// The option with the variance factor of bridged intervals (Interval::bridged). Empty: there is
  /// none. A drive sets it from its timeline unless the user states it.
  std::string gap_factor_option = {};
  /// The options with the standard deviations, in m and rad, of a track beside that of the first relative
  /// source. Late stamps, smoothing and slow readings move a track to and fro, and do not add up. So the
  /// poses of every further source are vertices of their own, tied to the nodes with these deviations.
  /// Empty: the source joins the nodes themselves.
  std::string track_sigma_option = {};
  std::string track_heading_option = {};
};

struct GnssModelingType {
  std::string name;
  std::string description;
  std::vector<OptionInfo> options;
  std::function<std::unique_ptr<GnssModeling>(const CheckedOptions&)> make;
  /// Whether its error model contains outliers, biases and the calibration of the odometry. Such a
  /// drive has by default no gate, all calibration states and an estimated noise. Other drives have
  /// by default the gate of the paper, no calibration states, and the stated noise.
  bool complete = false;
  /// Whether one object may serve several sources whose lasting errors are common, such as receivers
  /// that see the same satellites. It then takes the antenna of each fix from its moment.
  bool shares_errors = false;
};

/// A registered sensor. drive.yaml names it under `sensors`, and a log reader reads its columns.
struct SensorModelType {
  std::string name;
  std::string description;
  std::vector<SensorColumn> columns;  ///< besides `time`; empty: the sensor has no log of its own
  std::vector<OptionInfo> options;
  std::function<std::unique_ptr<SensorModel>(const CheckedOptions&)> make;
  /// The loss of its measurements where the user states none: a registered loss and its scale, or "none" for
  /// errors with tails of their own. With Cauchy's of this scale, readings with normal errors keep 95 % of
  /// their worth (Holland and Welsch 1977), and a few that are wrong (a landmark taken for another, a loop that
  /// is none, iron beside a compass) cannot bend the drive.
  std::string loss = "cauchy:2.4";
  /// How options with a prior are estimated.
  struct NoiseSearch {
    /// From readings at least this far apart, s: those whose errors are nearly the same cost time and tell
    /// little. 0: from all of them
    double period_s = 0;
    /// With these in place of the user's: the marginal likelihood takes edges for linear.
    Options options = {};
  };
  NoiseSearch noise_search = {};
};

}  // namespace waymark
