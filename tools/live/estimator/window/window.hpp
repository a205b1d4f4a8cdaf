/// The graph of the last minute: it takes nodes, fixes and readings, finds its minimum, and loses its
/// oldest poses, of which a prior remains.
///
/// It is built by the same builder as the graph of a whole drive, with the same plugins and settings.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include <waymark/core/registry/registry.hpp>
#include <waymark/core/window/window_solver.hpp>
#include <waymark/tools/drive/model/build.hpp>
#include <waymark/tools/live/estimator/odometries.hpp>
#include <waymark/tools/live/estimator/window/predictor.hpp>
#include <waymark/tools/live/estimator/window/window_inputs.hpp>

namespace waymark::live {

class Window {
 public:
  /// @param settings from decided(), with the noise among the options
  /// @param registry must outlive the object
  Window(const drive::DriveFacts& facts, std::vector<drive::PreparedSensor> sensors,
         const drive::FusionSettings& settings, const TypeRegistry& registry);
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;

  /// Keeps the medians of what receivers claimed, whatever they claim from now on: the noise holds for those. Call it
  /// before begin(). @param claimed by Fix::source
  void keep_claimed(std::map<int, ClaimedAccuracies> claimed) { kept_claims_ = std::move(claimed); }

  /// Begins with a stretch of at least two nodes and the readings so far, and finds the minimum from its poses.
  /// @returns false if there is none
  [[nodiscard]] bool begin(const PlacedStretch& stretch);
  /// Adds what is known of the open states. Call it after begin().
  void add_known(std::span<const KnownState> states);
  /// Begins with what another window was given, and finds the minimum. Poses older than the given moment are
  /// then summed out. @returns false if there is no minimum
  [[nodiscard]] bool begin_again(const WindowInputs& inputs, Stamp oldest);
  /// Adds what another window was given since it had so many inputs. @param first inputs before it are known
  void catch_up(const WindowInputs& inputs, std::uint64_t first);

  /// Adds a node at the end of an interval, at its predicted pose. @param giver the odometry of the interval
  void add_node(Stamp stamp, const Interval& interval, std::size_t giver);
  /// Adds what an odometry measured beside the one that gives the nodes. The prediction does not use it, the
  /// next solution does.
  void add_way(const MeasuredWay& way);
  /// Adds a fix to the nearest node. Its stamp may be any within the window.
  void add_fix(const Fix& fix, const ClaimedAccuracies& claimed);
  /// Adds readings of a sensor; they wait for the next node or fix. @param sensor index in those of the
  /// constructor
  void add_reading(std::size_t sensor, Stamp stamp, std::span<const double> values);
  /// Adds the readings that wait to the nodes that there are.
  void use_readings();

  /// Finds the minimum of everything so far. @returns false if that failed; the values are then those
  /// before
  [[nodiscard]] bool solve();
  /// Removes the poses before a moment. Those that the removed edges alone do not determine stay.
  /// @returns the removed ones at their last values
  [[nodiscard]] std::vector<StampedPose> drop_before(Stamp moment);

  [[nodiscard]] std::span<const Stamp> stamps() const { return builder_.nodes().stamps; }
  [[nodiscard]] Stamp oldest() const { return builder_.nodes().stamps.front(); }
  [[nodiscard]] Stamp newest() const { return builder_.nodes().stamps.back(); }
  [[nodiscard]] Eigen::Vector3d newest_pose() const;
  /// Returns the newest height state, m above the ellipsoid; empty if the graph has none.
  [[nodiscard]] std::optional<double> newest_height() const;
  [[nodiscard]] Eigen::Matrix3d covariance() const { return predictor_.covariance(); }
  /// Returns where the antenna of a fix was at its stamp, as far as is known.
  [[nodiscard]] Eigen::Vector2d antenna_at(const Fix& fix) const;
  /// Returns the states that the newest pose shares with others, for a later start.
  [[nodiscard]] std::vector<KnownState> open_states() const;
  [[nodiscard]] std::size_t poses() const { return builder_.nodes().stamps.size(); }
  [[nodiscard]] const Graph& graph() const { return graph_; }
  /// Returns what it was given in the last ten minutes, at the present estimate.
  [[nodiscard]] const WindowInputs& inputs();
  [[nodiscard]] std::vector<StampedPose> remaining() const;

 private:
  void add_nodes(const PlacedStretch& stretch, std::size_t first, std::size_t last);
  void give_reading(std::size_t sensor, Stamp stamp, std::span<const double> values);
  void extend(const drive::DrivePart& part);
  [[nodiscard]] ClaimedAccuracies with_kept(int source, ClaimedAccuracies claimed) const;

  std::vector<drive::PreparedSensor> sensors_;  // each with the readings that wait for the next part
  const TypeRegistry& registry_;
  bool several_odometries_;
  drive::GraphBuilder builder_;
  Graph& graph_;
  WindowSolver solver_;
  Predictor predictor_;
  WindowInputs inputs_;
  std::map<int, ClaimedAccuracies> kept_claims_;
  bool readings_wait_ = false;
  std::optional<VertexId> height_{};  ///< of the newest height state
};

}  // namespace waymark::live
