#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <exception>

#include <waymark/core/base/detail/elapsed.hpp>
#include <waymark/core/base/detail/index.hpp>
#include <waymark/core/base/error.hpp>
#include <waymark/core/optimize/detail/equations.hpp>
#include <waymark/core/optimize/detail/iteration_words.hpp>
#include <waymark/core/optimize/multi_start.hpp>
#include <waymark/core/system/detail/components.hpp>
#include <waymark/core/system/detail/incidence.hpp>
#include <waymark/core/system/gauge.hpp>

namespace waymark {
namespace {

using detail::Clock;
using detail::seconds_since;

constexpr int kPatience = 30;          // steps from one start before the next is tried
constexpr double kSameMinimum = 1e-6;  // relative difference of chi2
constexpr double kSuspicious = 6;      // standard deviations above the degrees of freedom
// loops per free vertex; from here on a start costs less than a step
constexpr double kLoopShare = 0.02;
constexpr double kFewLoops = 2;  // times the degrees of freedom are plausible in a graph with fewer

struct Size {
  std::int64_t unknowns = 0;   ///< scalar, of the gauge of some values; measure() leaves them open
  std::int64_t equations = 0;  ///< scalar
  std::int64_t vertices = 0;   ///< free, with edges
  std::int64_t loops = 0;      ///< edges between free vertices beyond a spanning tree of each part
};

/// The gauge that is refused at the present values is one of other values, where all may be seen: nothing is held then.
std::int64_t unknowns_of(const Graph& graph) {
  try {
    return count_unknowns(graph, find_gauge(graph));
  } catch (const InputError&) {
    Gauge none;
    none.held.assign(graph.vertex_count(), 0);
    return count_unknowns(graph, none);
  }
}

Size measure(const Graph& graph) {
  Size size;
  const std::vector<std::int32_t> part = detail::find_components(graph);
  const std::vector<char> has_edge = vertices_with_edges(graph);
  std::int64_t parts = 0;
  for (VertexIndex v = 0; v < static_cast<VertexIndex>(graph.vertex_count()); ++v) {
    if (graph.fixed(v) || has_edge[detail::at(v)] == 0) continue;
    ++size.vertices;
    parts += part[detail::at(v)] == v ? 1 : 0;
  }
  std::int64_t joints = 0;
  for (std::size_t b = 0; b < graph.batch_count(); ++b) {
    const EdgeBatchBase& batch = graph.batch(b);
    for_each_edge(batch, [&](std::span<const VertexIndex> vertices) {
      std::int64_t free = 0;
      for (const VertexIndex v : vertices) free += graph.fixed(v) ? 0 : 1;
      joints += std::max<std::int64_t>(free - 1, 0);
    });
  }
  size.equations = detail::count_equations(graph);
  size.loops = joints - (size.vertices - parts);
  return size;
}

double freedom_of(const Size& size) {
  return static_cast<double>(std::max<std::int64_t>(size.equations - size.unknowns, 1));
}

double plausible(const Size& size) {
  const double freedom = freedom_of(size);
  return freedom + kSuspicious * std::sqrt(2 * freedom);
}

bool has_many_loops(const Size& size) {
  return static_cast<double>(size.loops) > kLoopShare * static_cast<double>(size.vertices);
}

/// Returns the chi2 at which a minimum is taken for the lowest one. Sigmas that are wrong by a little make the
/// chi2 of every long drive implausible. In one loop of many, a false minimum adds little more; the false minima
/// of a chain that is held by fixes cost many times as much as the right one.
double acceptable(const Size& size) {
  const double strict = plausible(size);
  return has_many_loops(size) ? strict : std::max(strict, kFewLoops * freedom_of(size));
}

class MultiStart {
 public:
  MultiStart(Graph& graph, const RegistryTable<StartType>& starts, Algorithm& algorithm, LinearSolver& solver,
             const OptimizerOptions& options)
      : graph_(graph), starts_(starts), algorithm_(algorithm), solver_(solver), options_(options) {}

  MultiStartSummary run();

 private:
  void choose_first();
  void try_from(std::string_view start, const std::vector<double>& values, int patience);
  void try_others();
  void finish_best();
  void describe();
  void describe_improbable_minimum();
  void count_iterations_in_message();
  std::vector<double> make(const StartType& start);
  double chi2_at(const std::vector<double>& values);

  [[nodiscard]] bool tried(std::string_view start) const {
    return std::find(tried_.begin(), tried_.end(), start) != tried_.end();
  }
  [[nodiscard]] bool settled() const {
    if (result_.trials.empty()) return false;
    const Summary& best = result_.summary;
    if (best.termination == Termination::interrupted || iterations_left() <= 0) return true;
    if (!best.converged()) return false;
    return best.final_chi2 <= acceptable(size_) || confirmed_;
  }
  [[nodiscard]] int iterations_left() const { return options_.max_iterations - iterations_; }

  Graph& graph_;
  const RegistryTable<StartType>& starts_;
  Algorithm& algorithm_;
  LinearSolver& solver_;
  const OptimizerOptions& options_;

  MultiStartSummary result_;
  std::vector<double> file_values_;
  std::vector<double> best_from_;  // where the best run began
  std::vector<double> best_values_;
  std::vector<std::string> notes_;  // about starts that could not be computed or used
  std::vector<std::string> tried_;
  std::exception_ptr refusal_;  // the first one
  Size size_;
  double file_chi2_ = 0;
  bool confirmed_ = false;         // two starts have ended at the best minimum
  int iterations_ = 0;             // of all runs
  int iterations_of_message_ = 0;  // that the message of the best run tells
  Clock::time_point begin_ = Clock::now();
};

std::vector<double> MultiStart::make(const StartType& start) {
  graph_.set_values(file_values_);
  InitialValues made = start.make(graph_);
  if (made.values.empty()) notes_.push_back("initial guess " + start.name + " cannot be made: " + made.note);
  return std::move(made.values);
}

double MultiStart::chi2_at(const std::vector<double>& values) {
  graph_.set_values(values);
  return graph_.chi2();
}

void MultiStart::try_from(std::string_view start, const std::vector<double>& values, int patience) {
  const Clock::time_point begin = Clock::now();
  graph_.set_values(values);
  tried_.emplace_back(start);
  OptimizerOptions options = options_;
  options.max_iterations = std::min(patience, iterations_left());
  Summary summary;
  try {
    summary = optimize(graph_, algorithm_, solver_, options);
  } catch (const InputError& error) {
    // The gauge is judged at these values. If, for example, all poses are at one place, they seem
    // to say nothing about their headings.
    if (!refusal_) refusal_ = std::current_exception();
    notes_.push_back("initial guess " + std::string(start) + " cannot be used: " + error.what());
    return;
  }
  iterations_ += summary.iterations;
  result_.trials.push_back({std::string(start), summary.initial_chi2, summary.final_chi2, summary.iterations,
                            summary.termination, seconds_since(begin)});
  const Summary& best = result_.summary;
  const bool first = result_.trials.size() == 1;
  const bool same = !first && best.converged() && summary.converged() &&
                    std::abs(summary.final_chi2 - best.final_chi2) <= kSameMinimum * best.final_chi2;
  confirmed_ = confirmed_ || same;
  // of equal ones the first is kept
  if (same || (!first && !(summary.final_chi2 < best.final_chi2))) return;
  confirmed_ = false;
  iterations_of_message_ = summary.iterations;
  size_.unknowns = summary.unknowns;  // the gauge of these values may be another one
  result_.summary = std::move(summary);
  result_.start = start;
  const bool only_one = first && !refusal_ && settled();
  if (only_one) return;
  best_from_ = values;
  best_values_ = graph_.values();
}

void MultiStart::choose_first() {
  size_ = measure(graph_);
  if (has_many_loops(size_) && !starts_.empty() && options_.max_iterations > 0) {
    size_.unknowns = unknowns_of(graph_);
    file_chi2_ = graph_.chi2();
    if (!(file_chi2_ <= freedom_of(size_))) {
      const StartType& start = starts_.front().type;
      const std::vector<double> values = make(start);
      if (!values.empty() && chi2_at(values) < file_chi2_) return try_from(start.name, values, kPatience);
    }
  }
  try_from(kFileStart, file_values_, kPatience);
}

void MultiStart::try_others() {
  if (!settled() && !tried(kFileStart)) try_from(kFileStart, file_values_, kPatience);
  for (const auto& [start, origin] : starts_) {
    if (settled()) return;
    if (tried(start.name)) continue;
    const std::vector<double> values = make(start);
    if (!values.empty()) try_from(start.name, values, kPatience);
  }
}

/// Finishes the best run, which may have been cut short. The gauge is that of its beginning: on the way landmarks that
/// are only seen may be so far that the edges seem to say nothing about them.
void MultiStart::finish_best() {
  if (result_.summary.termination != Termination::max_iterations || iterations_left() <= 0) return;
  Summary& best = result_.summary;
  graph_.set_values(best_from_);
  StructuredSolver kept{solver_};
  kept.build(graph_, find_gauge(graph_).held);
  graph_.set_values(best_values_);
  OptimizerOptions options = options_;
  options.max_iterations = iterations_left();
  Summary rest = optimize(graph_, kept, algorithm_, options);
  iterations_ += rest.iterations;
  iterations_of_message_ = rest.iterations;
  rest.notes.insert(rest.notes.begin(), best.notes.begin(), best.notes.end());
  // The two parts become one run.
  for (IterationRecord& record : rest.records) record.iteration += best.iterations;
  rest.records.insert(rest.records.begin(), best.records.begin(), best.records.end());
  rest.iterations += best.iterations;
  rest.initial_chi2 = best.initial_chi2;
  rest.structure_seconds += best.structure_seconds;
  rest.linearize_seconds += best.linearize_seconds;
  rest.solve_seconds += best.solve_seconds;
  rest.total_seconds += best.total_seconds;
  best = std::move(rest);
  for (StartTrial& trial : result_.trials) {
    if (trial.start != result_.start) continue;
    trial.final_chi2 = best.final_chi2;
    trial.iterations = best.iterations;
    trial.termination = best.termination;
    trial.seconds = best.total_seconds;
  }
  best_values_ = graph_.values();
}

std::string number(const char* format, double value) {
  char text[40];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

/// The message of a run that did not end by itself tells how many iterations it had. The limit counts those of all runs.
void MultiStart::count_iterations_in_message() {
  Summary& best = result_.summary;
  const std::string told = detail::after_iterations(iterations_of_message_);
  const std::size_t place = best.message.find(told);
  if (place == std::string::npos) return;
  std::string all = detail::after_iterations(best.iterations);
  if (iterations_ > best.iterations)
    all += " (" + std::to_string(iterations_) + " with those from other initial guesses)";
  best.message.replace(place, told.size(), all);
}

void MultiStart::describe() {
  count_iterations_in_message();
  std::vector<std::string>& notes = result_.summary.notes;
  notes.insert(notes.end(), notes_.begin(), notes_.end());
  if (result_.trials.size() == 1) {
    if (result_.start == kFileStart) return;
    std::string note = "initial guess " + result_.start;
    if (!refusal_) {  // otherwise chi2 at these values was not computed
      note += ": chi2 " + number("%.6g", result_.summary.initial_chi2) + " there, " +
              number("%.6g", file_chi2_) + " at the values given";
    }
    notes.push_back(note);
    return;
  }
  std::string note =
      "the first initial guess led to no minimum, or to one of implausible chi2, so others were tried:";
  for (const StartTrial& trial : result_.trials) {
    note += " " + trial.start + " (chi2 " + number("%.6g", trial.initial_chi2) + " -> " +
            number("%.6g", trial.final_chi2) + " in " + std::to_string(trial.iterations) + ")";
  }
  notes.push_back(note + "; kept: " + result_.start);
  describe_improbable_minimum();
}

/// A false minimum says nothing but its chi2.
void MultiStart::describe_improbable_minimum() {
  const Summary& best = result_.summary;
  if (!best.converged() || !(best.final_chi2 > acceptable(size_))) return;
  const double freedom = freedom_of(size_);
  const double deviations = (best.final_chi2 - freedom) / std::sqrt(2 * freedom);
  result_.summary.notes.push_back(
      "chi2 " + number("%.6g", best.final_chi2) + " is " + number("%.3g", deviations) +
      " standard deviations above the " + number("%.0f", freedom) +
      " that are expected, which is no chance: edges say too much, some are wrong, or a lower minimum exists "
      "(another initial guess or algorithm may find it)");
}

MultiStartSummary MultiStart::run() {
  options_.check();
  file_values_ = graph_.values();
  choose_first();
  if (!settled()) {
    try_others();
    if (result_.trials.empty()) std::rethrow_exception(refusal_);
    finish_best();
    graph_.set_values(std::move(best_values_));
  }
  describe();
  result_.total_seconds = seconds_since(begin_);
  return std::move(result_);
}

}  // namespace

double plausible_chi2(const Graph& graph) {
  Size size = measure(graph);
  size.unknowns = unknowns_of(graph);
  return plausible(size);
}

MultiStartSummary optimize_from_best_start(Graph& graph, const RegistryTable<StartType>& starts,
                                           Algorithm& algorithm, LinearSolver& solver,
                                           const OptimizerOptions& options) {
  return MultiStart(graph, starts, algorithm, solver, options).run();
}

}  // namespace waymark
