/// Measures contestants (an algorithm with a solver, or a peer) on one graph from one
/// initial guess.
#pragma once

#include <atomic>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <waymark/core/graph/graph.hpp>

namespace waymark::benchmark {

/// One optimisation. Times are seconds of wall time.
struct RunOutcome {
  /// from the graph in memory (peer: from its built problem) to the result
  double total_seconds = 0;
  double setup_seconds = 0;  ///< peer: the time to build its problem, not part of the total
  /// gauge, ordering, pattern; peer: the time before its first iteration
  double structure_seconds = 0;
  double linearize_seconds = 0;  ///< peer: includes the residuals
  double solve_seconds = 0;      ///< factorisations and solves
  int iterations = 0;            ///< proposed steps, accepted or not
  double initial_chi2 = 0;       ///< not halved, by Waymark's own error functions
  double final_chi2 = 0;
  bool converged = false;
  std::string message{};             ///< why it stopped
  std::string solver_description{};  ///< the choices that the solver made itself
  std::vector<std::string> notes{};  ///< remarks for the reader of the table
};

struct Contestant {
  std::string name;    ///< of the algorithm or the peer
  std::string solver;  ///< empty for a peer
  bool peer = false;
  /// Optimises the graph. The graph then holds the result.
  std::function<RunOutcome(Graph&)> run;
};

/// The measurements of one contestant.
struct Cell {
  std::string name;
  std::string solver;
  bool peer = false;
  std::vector<RunOutcome> runs;  ///< one per repetition
  /// resident set before a run, with the graph and its copy
  std::optional<double> memory_before_mb{};
  std::optional<double> memory_peak_mb{};  ///< largest resident set during the run
};

struct MeasureOptions {
  int repetitions = 5;  ///< >= 1
  /// Checked after every run; true ends the measurement without a result.
  const std::atomic<bool>* cancel = nullptr;
  /// Called before every run: "2/5 dogleg".
  std::function<void(const std::string&)> progress = [](const std::string&) {};
};

/// Measures all contestants. First each of them runs once for its memory, which also warms up. Then
/// come the repetitions. In each repetition all contestants run in turn (A B A B), so that a slow
/// moment of the machine affects them alike. Every run has a fresh copy of the graph; copying is
/// not timed. @return one cell per contestant; empty when cancelled
[[nodiscard]] std::vector<Cell> measure(const Graph& start, std::span<const Contestant> contestants,
                                        const MeasureOptions& options);

}  // namespace waymark::benchmark
