/// Measuring contestants (an algorithm with a solver, or a peer) on one graph from one start.
#pragma once

#include <atomic>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <waymark/core/graph/graph.hpp>

namespace waymark::benchmark {

/// One optimisation. Seconds of wall time.
struct RunOutcome {
  double total_seconds = 0;      ///< from the graph in memory (a peer: its problem built) to the result
  double setup_seconds = 0;      ///< a peer's: building its problem, outside of the total
  double structure_seconds = 0;  ///< gauge, ordering, pattern; a peer's: what precedes its first iteration
  double linearize_seconds = 0;  ///< a peer's: its residuals are counted here too
  double solve_seconds = 0;      ///< factorisations and solves
  int iterations = 0;            ///< proposed steps, accepted or not
  double initial_chi2 = 0;       ///< not halved, by Waymark's own error functions
  double final_chi2 = 0;
  bool converged = false;
  std::string message{};             ///< why it ended
  std::string solver_description{};  ///< what the solver chose inside
  std::vector<std::string> notes{};  ///< what the reader of the table must know
};

struct Contestant {
  std::string name;    ///< of the algorithm or the peer
  std::string solver;  ///< empty for a peer
  bool peer = false;
  /// Optimises the graph; it then holds the result.
  std::function<RunOutcome(Graph&)> run;
};

/// What was measured of a contestant.
struct Cell {
  std::string name;
  std::string solver;
  bool peer = false;
  std::vector<RunOutcome> runs;              ///< one per repetition
  std::optional<double> memory_before_mb{};  ///< resident before a run: the graph and its copy, ...
  std::optional<double> memory_peak_mb{};    ///< ... and the largest during it
};

struct MeasureOptions {
  int repetitions = 5;  ///< >= 1
  /// Asked after every run; true ends the measurement without a result.
  const std::atomic<bool>* cancel = nullptr;
  /// Told before every run: "2/5 dogleg".
  std::function<void(const std::string&)> progress = [](const std::string&) {};
};

/// First every contestant once for its memory, which also warms up; then the repetitions, in each of them all
/// contestants in turn (A B A B), so that a slow moment of the machine meets them alike. Every run has a
/// fresh copy of the graph; copying is not timed. @return one cell per contestant; empty when cancelled
[[nodiscard]] std::vector<Cell> measure(const Graph& start, std::span<const Contestant> contestants,
                                        const MeasureOptions& options);

}  // namespace waymark::benchmark
