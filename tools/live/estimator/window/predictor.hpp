/// The newest pose between two solutions: the motion of the odometry with its covariance, together with
/// the states that it shares with former poses.
///
/// It works on the edges that the odometry model adds, whatever they are: their Gaussian is joined with
/// that of the newest pose and the open states, and the former pose is summed out.
#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include <waymark/core/graph/graph.hpp>
#include <waymark/core/window/window_solver.hpp>

namespace waymark::live {

class Predictor {
 public:
  /// Begins with a solution. @param pose the newest pose, one of the tail
  void begin(const Graph& graph, const WindowTail& tail, VertexIndex pose);
  /// Keeps in mind which edges and vertices the graph has.
  void mark(const Graph& graph);
  /// Takes the edges that were added since mark(): it sets the values of new vertices to their
  /// expectation, and the pose is now the given one.
  void follow(Graph& graph, VertexIndex pose);

  /// Sets vertices that were added since mark() to their expectation if all others are as they are: the states
  /// of a new fix begin where the former ones lead them. @param first of them
  void settle(Graph& graph, VertexIndex first) const;

  /// Returns the covariance of the newest pose: x, y, heading.
  [[nodiscard]] Eigen::Matrix3d covariance() const;
  /// Returns the joint Gaussian: the pose first, then the states.
  [[nodiscard]] const std::vector<VertexId>& vertices() const { return vertices_; }
  [[nodiscard]] const Eigen::MatrixXd& joint() const { return covariance_; }

 private:
  struct Joint;
  void forget_dropped(const Graph& graph);
  void keep_sizes(const Graph& graph);
  void add_edge(const Graph& graph, std::size_t batch, std::size_t edge, Joint& joint) const;
  /// Tells whether an edge has a vertex whose covariance is not known here, and that is not new.
  static bool touches_unknown(const Graph& graph, EdgePlace edge, const Joint& joint);

  std::vector<VertexId> vertices_;   // the pose first
  std::vector<Eigen::Index> sizes_;  // of their tangents
  Eigen::MatrixXd covariance_;
  std::vector<std::size_t> edges_;  // per batch, at the mark
};

}  // namespace waymark::live
