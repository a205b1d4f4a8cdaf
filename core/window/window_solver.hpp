/// Gauss-Newton on the graph of a sliding window of time, as a running estimator needs it.
///
/// The vertices of such a graph follow one another in time, and only a few states (biases, scales) join
/// more than their neighbours. So it is eliminated in the order of time through one small dense front,
/// which needs no analysis of a pattern: appending, dropping and late measurements cost nothing extra, and
/// a step costs time in proportion to the window. What the newest pose and the states that are still in
/// use have in common stands at the end of the front, so their joint covariance costs nothing either.
///
/// Graphs of any kind give right results. If the front grows (loop closures in the window), the cost is
/// that of the front, and IncrementalOptimizer is the better choice.
///
/// It refers to the graph, which must outlive it; between calls the caller may change the graph at will. If
/// vertices were removed, or values or edges were changed, restart() must be called. One thread at a time may
/// use it and its graph. Equal graphs with equal histories give equal bits.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <Eigen/Core>

#include <waymark/core/base/export.hpp>
#include <waymark/core/graph/graph.hpp>

namespace WAYMARK_EXPORT waymark {

struct WindowOptions {
  int max_iterations = 5;
  /// stop below this decrement of chi2, as the quadratic model predicts it
  double decrement_tolerance = 1e-4;
  /// a step that promises less is taken without a look at chi2 afterwards
  double safe_decrement = 1e-2;
  /// so many calls in a row may begin with a step that linearises anew only what has changed since the last
  /// one; the next call linearises everything. 0: each call linearises everything
  int partial_updates = 0;
};

/// The result of a call of WindowSolver::update().
struct WindowSummary {
  bool solved = false;       ///< false: the normal matrix is not positive definite; no value has changed
  bool converged = false;    ///< the last decrement was below the tolerance
  int iterations = 0;        ///< steps that were taken
  double chi2 = 0;           ///< before the last step
  double decrement = 0;      ///< of the last step
  VertexIndex singular{-1};  ///< if not solved: the vertex whose pivot failed
};

/// The joint Gaussian of the vertices that were eliminated last.
struct WindowTail {
  std::vector<VertexIndex> vertices;
  Eigen::MatrixXd covariance;  ///< of their tangents, in this order
};

class WindowSolver {
 public:
  explicit WindowSolver(Graph& graph);
  ~WindowSolver();
  WindowSolver(const WindowSolver&) = delete;
  WindowSolver& operator=(const WindowSolver&) = delete;

  /// Improves the values of the graph by Gauss-Newton steps, each shortened until chi2 decreases. Every
  /// component must be anchored, by a prior or by fixes.
  /// @throws PluginError from edges
  WindowSummary update(const WindowOptions& options = {});

  /// Forgets former steps: the next one linearises everything.
  void restart();

  /// Returns the joint covariance of a vertex and of all that were eliminated after it, as of the last
  /// step of update(). Precondition: update() solved, and the graph has the same vertices since then.
  /// @param first the newest pose; empty if it is no unknown of the graph
  [[nodiscard]] WindowTail tail(VertexIndex first) const;

  /// Returns the scalar size of the largest front of the last step.
  [[nodiscard]] int largest_front() const;

 private:
  class Elimination;
  std::unique_ptr<Elimination> elimination_;
};

}  // namespace waymark
