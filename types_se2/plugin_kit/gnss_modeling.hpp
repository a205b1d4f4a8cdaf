/// Small steps that every GNSS modeling takes: the information matrix of a fix, the position edge
/// of the paper, and the origin node.
#pragma once

#include <array>
#include <string>

#include <Eigen/LU>

#include <waymark/core/base/error.hpp>
#include <waymark/core/drive/kept_vertex.hpp>
#include <waymark/core/drive/modeling.hpp>
#include <waymark/core/registry/options.hpp>
#include <waymark/types_se2/edge_gnss.hpp>
#include <waymark/types_se2/edge_se2.hpp>

namespace waymark {

/// Returns the information matrix of a fix: the inverse of its covariance, in 1/m^2 and frame axes.
[[nodiscard]] inline Eigen::Matrix2d position_information(const Fix& fix) {
  const Eigen::Matrix2d inverse = fix.covariance.inverse();
  return 0.5 * (inverse + inverse.transpose());
}

/// Returns the same matrix with a third axis, the heading, that carries no information.
[[nodiscard]] inline Eigen::Matrix3d pose_information(const Fix& fix) {
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  information.topLeftCorner<2, 2>() = position_information(fix);
  return information;
}

/// Returns the vertex of the pose that a fix belongs to. @throws UsageError if the fix names none.
[[nodiscard]] inline VertexIndex pose_vertex(const Fix& fix, const Graph& graph) {
  const auto found = graph.find(fix.vertex);
  if (!found)
    throw UsageError("fix of epoch " + std::to_string(fix.epoch) + " belongs to no pose of the graph");
  return *found;
}

/// Adds the fixed node at the origin of the frame, the "UTM origin" of the paper.
inline VertexIndex add_origin(Graph& graph) {
  const VertexIndex origin = graph.add_vertex<VertexSe2>(graph.free_id(), {0, 0, 0});
  graph.set_fixed(origin, true);
  return origin;
}

/// Adds the time offset of fixes. @param prior_sigma_s sigma of its prior about 0
/// @param assumed_s its initial guess
inline VertexIndex add_time_offset(Graph& graph, double prior_sigma_s, double assumed_s) {
  const VertexIndex offset = graph.add_vertex<VertexTimeOffset>(graph.free_id(), {assumed_s});
  add_prior_about_zero(graph, offset, prior_sigma_s);
  return offset;
}

/// Returns the options that all modelings share: the form of the error of a fix, and whether its
/// time offset is estimated.
[[nodiscard]] inline std::vector<OptionInfo> gnss_options() {
  return {
      {"error", "decoupled", "", OptionWords{"decoupled", "literal"},
       "error of a fix: 'decoupled', p - z in frame axes; 'literal', the paper's "
       "logarithm with heading 0"},
      {"time_offset", "off", "", OptionWords{"off", "constant"},
       "delay of the fixes against the odometry: 'off', or 'constant' (estimated)"},
      {"time_offset_sigma", "0.3", "s", OptionRange{1e-6, 100}, "sigma of the prior of time_offset about 0"}};
}
[[nodiscard]] inline bool is_literal(const CheckedOptions& options) {
  return options.word("error") == "literal";
}

/// @throws UsageError if the input does not tell where the antenna was
inline void require_moments(const GnssInput& input) {
  if (input.moments.size() != input.fixes.size())
    throw UsageError("a time offset needs the motion at each fix (GnssInput::moments)");
}

/// Returns the velocity of the antenna in the axes of the frame. @param heading of its pose
[[nodiscard]] inline Eigen::Vector2d velocity_in_frame(const FixMoment& moment, double heading) {
  return rotate(heading, moment.velocity);
}

/// Adds the position edges of fixes. If the time offset is to be estimated, one offset serves
/// all of them.
class PositionEdges {
 public:
  /// @param prior_sigma_s sigma of the prior on the time offset; 0: the offset is not estimated
  /// @param offset of the earlier fixes; it is made for the first ones
  /// @throws UsageError if the offset is estimated and the moments of the fixes are not given
  PositionEdges(const GnssInput& input, double prior_sigma_s, KeptVertex& offset, Graph& graph)
      : input_(input), graph_(graph) {
    if (prior_sigma_s == 0) return;
    require_moments(input);
    if (input.fixes.empty()) return;
    const double assumed_s = input.moments.front().assumed_offset_s;
    offset_ = offset.in_or(graph, [&] { return add_time_offset(graph, prior_sigma_s, assumed_s); });
  }

  /// Where the antenna was in the body frame of the pose of fix i.
  [[nodiscard]] const Eigen::Vector2d& antenna(std::size_t i) const {
    return input_.moments.empty() ? input_.antenna : input_.moments[i].antenna;
  }

  /// Adds the edge of fix i.
  /// @param antenna in the body frame of the second vertex: antenna(i), or 0 if that is the antenna
  /// @param vertices the reference pose and the pose that carries the antenna
  void add(std::size_t i, const Eigen::Vector2d& measured, const Eigen::Vector2d& antenna,
           const std::array<VertexIndex, 2>& vertices) {
    const Eigen::Matrix2d information = position_information(input_.fixes[i]);
    if (offset_ < 0) {
      graph_.add_edge(EdgeGnssPosition{measured, antenna}, vertices, information, input_.loss);
      return;
    }
    const FixMoment& moment = input_.moments[i];
    const Eigen::Vector2d velocity = velocity_in_frame(moment, graph_.value(vertices[1])[2]);
    graph_.add_edge(EdgeGnssPositionLate{measured, antenna, velocity, moment.assumed_offset_s},
                    {vertices[0], vertices[1], offset_}, information, input_.loss);
  }

 private:
  const GnssInput& input_;
  Graph& graph_;
  VertexIndex offset_ = -1;
};

/// Sigma of the time offset's prior; 0 if it is not estimated. @throws UsageError
[[nodiscard]] inline double time_offset_sigma(const CheckedOptions& options) {
  if (options.word("time_offset") == "off") return 0;
  if (is_literal(options))
    throw UsageError(options.owner() +
                     ": the paper's literal error has no time offset; use error: decoupled");
  return options.number("time_offset_sigma");
}

/// Refuses a lever arm, because the literal error of the paper has none. @throws UsageError
inline void require_no_lever_arm(const GnssInput& input, const char* modeling) {
  if (input.antenna.isZero(0)) return;
  throw UsageError(std::string(modeling) +
                   ": the paper's literal error has no antenna lever arm; use error: decoupled");
}

}  // namespace waymark
