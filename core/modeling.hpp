/// The interfaces through which a drive becomes a graph: how odometry intervals become edges, how GNSS fixes
/// become vertices and edges. Implementations are plugins.
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <waymark/core/algorithm.hpp>
#include <waymark/core/graph.hpp>
#include <waymark/core/sample.hpp>

namespace waymark {

/// Joins the poses of neighbouring nodes.
class OdometryModel {
 public:
  virtual ~OdometryModel();
  /// Adds one edge (or more) per interval. @param poses vertex of each node, intervals.size() + 1 of them
  virtual void build(std::span<const Interval> intervals, std::span<const VertexIndex> poses,
                     Graph& graph) const = 0;
  /// |speed| in m/s below which the vehicle counts as standing: its measured motion is then the identity.
  [[nodiscard]] virtual double standstill_speed() const = 0;
};

/// What a GNSS modeling works on.
struct GnssInput {
  std::span<const Fix> fixes;        ///< accepted ones only; Fix::vertex names the pose at the epoch
  Eigen::Vector2d antenna = {0, 0};  ///< antenna in the body frame, m
  VertexId first_free_id = 0;        ///< new vertices take ids from here upwards
};

/// Ties the poses to the fixes (the paper's G1, G2, G3, and what plugins bring).
class GnssModeling {
 public:
  virtual ~GnssModeling();
  /// Adds vertices and edges for all fixes. Existing vertices' values are the start of the optimisation.
  virtual void build(const GnssInput& input, Graph& graph) const = 0;
};

struct OdometryModelType {
  std::string name;
  std::string description;
  std::vector<OptionInfo> options;
  std::function<std::unique_ptr<OdometryModel>(const Options&)> make;
};

struct GnssModelingType {
  std::string name;
  std::string description;
  std::vector<OptionInfo> options;
  std::function<std::unique_ptr<GnssModeling>(const Options&)> make;
};

}  // namespace waymark
