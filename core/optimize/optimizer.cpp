#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <limits>
#include <optional>
#include <sstream>
#include <utility>

#include <waymark/core/base/detail/elapsed.hpp>
#include <waymark/core/base/detail/thread_pool.hpp>
#include <waymark/core/base/error.hpp>
#include <waymark/core/graph/checks/finite_check.hpp>
#include <waymark/core/optimize/detail/equations.hpp>
#include <waymark/core/optimize/detail/iteration_words.hpp>
#include <waymark/core/optimize/detail/jump_watch.hpp>
#include <waymark/core/optimize/detail/step_acceleration.hpp>
#include <waymark/core/optimize/optimizer.hpp>
#include <waymark/core/system/detail/information_unit.hpp>
#include <waymark/core/system/gauge.hpp>
#include <waymark/core/system/normal_equations.hpp>
#include <waymark/core/system/weakest_unknown.hpp>

namespace waymark {
namespace {

using detail::Clock;
using detail::seconds_since;

/// Adds its lifetime to a counter.
class Timer {
 public:
  explicit Timer(double& counter) : counter_(counter), start_(Clock::now()) {}
  ~Timer() { counter_ += seconds_since(start_); }
  Timer(const Timer&) = delete;
  Timer& operator=(const Timer&) = delete;

 private:
  double& counter_;
  Clock::time_point start_;
};

template <typename... Part>
std::string text(const Part&... part) {
  std::ostringstream out;
  out.imbue(std::locale::classic());
  (out << ... << part);
  return out.str();
}

/// Steps that reweight heavy-tailed losses converge linearly. Newton's steps with the whole curvature are tried
/// where the decrement is this share of chi2, and shrinks by less than a tenth at a time.
constexpr double kNearMinimum = 1e-4;
constexpr double kSlowly = 0.1;
/// They are accelerated where the decrement shrinks by less than to that.
constexpr double kAccelerated = 0.3;
/// The whole curvature is given up if the decrement does not shrink to that. The first one is larger than that of
/// the reweighted steps, which do not see how far it is.
constexpr double kContraction = 0.5;
constexpr double kFirst = 20;
/// It is tried again where the decrement has shrunk to that.
constexpr double kAgain = 0.1;
/// A difference of two sums below this share of chi2 is rounding, not a decrease.
constexpr double kChi2Rounding = 1e-12;
/// A difference so many times larger than rounding says something.
constexpr double kNoticeable = 10;
/// Steps beyond a jump of chi2 that may lead below the chi2 before it.
constexpr int kStepsBeyondJump = 15;
/// A jump is crossed where so many steps have lowered chi2 by no more than this share.
constexpr std::size_t kStepsOfProgress = 10;
constexpr double kProgress = 0.01;
/// Crossings of one jump that led nowhere, after which the run ends at it.
constexpr int kFutileCrossings = 3;

class Loop {
 public:
  /// @param kept a structure that follows the graph and that the solver has analysed; null:
  /// both are made
  Loop(Graph& graph, const Structure* kept, Algorithm& algorithm, LinearSolver& solver,
       const OptimizerOptions& options)
      : graph_(graph),
        algorithm_(algorithm),
        solver_(solver),
        options_(options),
        structure_(kept == nullptr ? made_ : *kept),
        equations_(graph, structure_) {
    if (options.threads > 1) pool_.emplace(options.threads);
    equations_.set_threads(pool());
    solver_.set_threads(pool());
  }
  ~Loop() { solver_.set_threads(nullptr); }
  Loop(const Loop&) = delete;
  Loop& operator=(const Loop&) = delete;

  Summary run();

 private:
  void prepare();
  bool converged_at_gradient();
  /// Tells whether chi2 was lower before, by more than the tolerance.
  bool is_above_best() const {
    return chi2_ - best_chi2_ > options_.decrement_tolerance * (unit_ + best_chi2_);
  }
  bool step_once();
  std::optional<double> accelerated_chi2();
  bool converges_slowly() const;
  bool step_with_whole_curvature();
  bool give_up_whole_curvature();
  IterationRecord begin_record();
  void keep(IterationRecord& record);
  double decrement_bound() const;
  bool converged_by(const Step& step, double step_size);
  bool has_more_to_gain(const IterationRecord& record) const;
  void finish(Termination termination, std::string message);
  double linearize(const std::vector<double>& values);
  void accept(double trial_chi2);
  void retreat();
  bool crosses_jump(const IterationRecord& record);
  bool makes_progress();
  /// The lowest chi2 after so many iterations, of the last ones.
  double& best_after(std::size_t iterations) { return lowest_[iterations % lowest_.size()]; }
  void judge_crossing();
  void come_back();
  bool goes_back_from_above();
  void finish_without_step();
  std::string singular_message();
  /// Tells whether the last step was damped, which hides an unknown that the edges do not determine.
  bool was_damped() const { return summary_.records.empty() || summary_.records.back().kind != "newton"; }
  void name_undetermined();
  bool is_undetermined(bool has_factor);
  bool not_finite_without_unknowns() const;
  /// Returns ": " and what is not finite in the graph, if something is.
  std::string named_flaw() const;
  ThreadPool* pool() { return pool_ ? &*pool_ : nullptr; }

  Graph& graph_;
  Algorithm& algorithm_;
  LinearSolver& solver_;
  const OptimizerOptions& options_;
  std::optional<ThreadPool> pool_;
  Structure made_;
  const Structure& structure_;
  NormalEquations equations_;
  Summary summary_;
  Clock::time_point start_ = Clock::now();

  std::vector<double> values_;  // present
  std::vector<double> trial_;
  // values of the lowest chi2, if that is not at values_ (after an uphill step)
  std::vector<double> best_;
  bool present_is_best_ = true;
  double chi2_ = 0;
  double best_chi2_ = 0;
  std::array<double, kStepsOfProgress + 1> lowest_{};  // in turn
  bool last_accepted_ = true;
  double gradient_ = 0;
  double unit_ = 1;  // of the information: a chi2 far below it is small
  bool has_losses_ = false;
  double freedom_ = 0;  // equations less unknowns, >= 0
  Step step_;
  std::optional<detail::StepAcceleration> acceleration_;  // of graphs with losses
  detail::JumpWatch jumps_;
  int steps_beyond_jump_ = 0;  // still to take before it is judged; 0: no crossing
  double chi2_before_jump_ = 0;
  bool exhausted_ = false;                                     // the algorithm had no step left
  bool whole_curvature_ = false;                               // of the losses, in the present linearisation
  double tried_at_ = std::numeric_limits<double>::infinity();  // decrement at which that was given up
  bool done_ = false;
};

void Loop::finish(Termination termination, std::string message) {
  summary_.termination = termination;
  summary_.message = std::move(message);
  done_ = true;
}

void Loop::prepare() {
  const Timer timer(summary_.structure_seconds);
  if (&structure_ == &made_) {
    Gauge gauge = find_gauge(graph_);
    summary_.notes = gauge.messages;
    made_.build(graph_, gauge.held);
    if (made_.pattern().dimension() > 0) solver_.analyze(made_.pattern());
  }
  unit_ = information_unit(graph_);
  summary_.ordering = structure_.ordering();
  summary_.vertices = graph_.vertex_count();
  summary_.edges = graph_.edge_count();
  summary_.unknowns =
      structure_.pattern().dimension() - static_cast<std::int64_t>(structure_.held_coordinates().size());
  has_losses_ = has_losses(graph_);
  if (has_losses_) acceleration_.emplace(structure_.pattern().dimension());
  freedom_ =
      static_cast<double>(std::max<std::int64_t>(detail::count_equations(graph_) - summary_.unknowns, 0));
  for (std::size_t b = 0; b < graph_.batch_count(); ++b) {
    if (graph_.batch(b).size() == 0) continue;
    const EdgeType& type = graph_.edge_type(b);
    if (!summary_.error_forms.empty()) summary_.error_forms += ", ";
    summary_.error_forms += type.form.empty() ? type.tag : type.tag + " " + type.form;
  }
}

double Loop::linearize(const std::vector<double>& values) {
  const Timer timer(summary_.linearize_seconds);
  return whole_curvature_ ? equations_.linearize_with_concave_terms(values) : equations_.linearize(values);
}

bool Loop::converged_at_gradient() {
  const Eigen::VectorXd& diagonal = equations_.diagonal();
  const auto gradient = equations_.gradient();
  double largest = 0;
  for (Eigen::Index i = 0; i < diagonal.size(); ++i) {
    // in the unit of the information: the square of a faint gradient would be 0
    const double square = gradient[i] / unit_ * gradient[i];
    const double curvature = diagonal[i] / unit_;
    if (square > largest * curvature && curvature > 0) largest = square / curvature;
  }
  gradient_ = std::sqrt(largest);
  const double bound = options_.gradient_tolerance * std::sqrt(unit_ + chi2_);
  if (!(gradient_ <= bound)) return false;
  finish(Termination::converged_gradient, text("converged: scaled gradient ", gradient_, " <= ", bound));
  return true;
}

/// Outliers raise a robust chi2 far above what the rest of the graph adds, so that it says nothing about what is
/// left to gain: no more than the degrees of freedom count then.
double Loop::decrement_bound() const {
  const double usual = options_.decrement_tolerance * (unit_ + chi2_);
  if (!has_losses_) return usual;
  const double bound = options_.decrement_tolerance * (unit_ + std::min(chi2_, freedom_));
  return std::max(bound, std::min(usual, kNoticeable * kChi2Rounding * chi2_));
}

/// Steps that reweight losses converge linearly: if each leaves the share r of the distance, a step that promised d
/// leaves d r^2 / (1 - r) to gain. r shows in the gain, d (1 + r), and in the decrements of two steps, d and r^2 d.
bool Loop::has_more_to_gain(const IterationRecord& record) const {
  if (!has_losses_ || summary_.termination != Termination::converged_decrement) return false;
  const double promised = record.newton_decrement;
  if (promised <= kNoticeable * kChi2Rounding * chi2_ || record.decrease < 0) return false;
  double left = record.decrease / promised - 1;
  if (!summary_.records.empty()) {
    const IterationRecord& before = summary_.records.back();
    if (before.accepted && before.kind == "newton")
      left = std::max(left, std::sqrt(promised / before.newton_decrement));
  }
  return left >= 1 || (left > 0 && promised * left * left / (1 - left) > decrement_bound());
}

bool Loop::converged_by(const Step& step, double step_size) {
  if (!step.full_newton) return false;
  const double bound = decrement_bound();
  if (step.newton_decrement <= bound) {
    finish(Termination::converged_decrement,
           text("converged: Newton decrement ", step.newton_decrement, " <= ", bound));
    return true;
  }
  const double largest =
      Eigen::Map<const Eigen::VectorXd>(values_.data(), static_cast<Eigen::Index>(values_.size()))
          .lpNorm<Eigen::Infinity>();
  const double step_bound = options_.step_tolerance * (1 + largest);
  if (step_size > step_bound) return false;
  finish(Termination::converged_step, text("converged: full Newton step ", step_size, " <= ", step_bound));
  return true;
}

std::string Loop::singular_message() {
  const Eigen::VectorXd& diagonal = equations_.diagonal();
  Graph at_present = graph_;
  at_present.set_values(values_);
  if (!diagonal.allFinite()) {
    return "the normal equations are not finite: " + find_not_finite(at_present).value_or("");
  }
  return "the normal equations are not positive definite; " +
         describe_weakest(at_present, equations_, solver_);
}

/// Rounding may leave no acceptable step. No minimum is lower than 0, so a chi2 that is small itself leaves nothing to gain.
void Loop::finish_without_step() {
  exhausted_ = true;
  const double bound = options_.decrement_tolerance * unit_;
  if (best_chi2_ <= bound) {
    finish(Termination::converged_decrement,
           text("converged: no step lowers chi2 any more, and all of it, ", best_chi2_, " <= ", bound));
  } else {
    finish(Termination::stalled,
           "stalled: no step lowers chi2 any more, yet the Newton decrement is not small");
  }
}

IterationRecord Loop::begin_record() {
  IterationRecord record;
  record.iteration = ++summary_.iterations;
  record.predicted_decrease = step_.predicted_decrease;
  record.newton_decrement = step_.newton_decrement;
  record.gradient = gradient_;
  record.step = step_.delta.lpNorm<Eigen::Infinity>();
  record.control = step_.control;
  record.kind = step_.kind;
  return record;
}

void Loop::keep(IterationRecord& record) {
  record.seconds = seconds_since(start_);
  summary_.records.push_back(record);
  best_after(summary_.records.size()) = best_chi2_;
  if (options_.observer) options_.observer(record);
}

bool Loop::converges_slowly() const {
  const std::vector<IterationRecord>& records = summary_.records;
  if (records.size() < 2) return false;
  const IterationRecord& last = records.back();
  const IterationRecord& before = records[records.size() - 2];
  const bool full = last.accepted && before.accepted && last.kind == "newton" && before.kind == "newton";
  return full && last.newton_decrement > kSlowly * before.newton_decrement &&
         last.newton_decrement <= std::min(kNearMinimum * (unit_ + chi2_), kAgain * tried_at_) && has_losses_;
}

/// Goes on with the steps of the algorithm. @returns false: nothing has moved
bool Loop::give_up_whole_curvature() {
  whole_curvature_ = false;
  tried_at_ = summary_.records.back().newton_decrement;
  linearize(values_);
  return false;
}

/// Takes one step of Newton's, with the concave parts of the losses. It converges quadratically, if there is a
/// minimum of that curvature nearby. @returns whether the values have moved
bool Loop::step_with_whole_curvature() {
  const bool is_first = !whole_curvature_;
  whole_curvature_ = true;
  if (is_first) linearize(values_);
  {
    const Timer timer(summary_.solve_seconds);
    if (solver_.factorize(equations_.hessian()) != FactorStatus::ok) return give_up_whole_curvature();
    step_.delta = -equations_.gradient();
    solver_.solve({step_.delta.data(), static_cast<std::size_t>(step_.delta.size())},
                  {step_.delta.data(), static_cast<std::size_t>(step_.delta.size())});
  }
  step_.newton_decrement = step_.predicted_decrease = -step_.delta.dot(equations_.gradient());
  step_.full_newton = true;
  step_.kind = "newton";
  const double most = (is_first ? kFirst : kContraction) * summary_.records.back().newton_decrement;
  if (!(step_.newton_decrement >= 0 && step_.newton_decrement <= most)) return give_up_whole_curvature();
  equations_.retract(values_, step_.delta, trial_);
  const double trial_chi2 = equations_.chi2(trial_);
  if (!(chi2_ - trial_chi2 >= -kChi2Rounding * chi2_)) return give_up_whole_curvature();
  IterationRecord record = begin_record();
  const bool converged = converged_by(step_, record.step);
  record.chi2 = trial_chi2;
  record.decrease = chi2_ - trial_chi2;
  record.accepted = true;
  accept(trial_chi2);
  if (!converged) linearize(values_);
  keep(record);
  return true;
}

/// Tries the accelerated step where steps that reweight losses are slow. @returns chi2 at trial_, where the equations are
/// linearised then; empty if it is not lower
std::optional<double> Loop::accelerated_chi2() {
  if (!acceleration_ || summary_.records.empty()) return std::nullopt;
  const IterationRecord& last = summary_.records.back();
  const bool is_slow = step_.full_newton && last.accepted && last.kind == "newton" &&
                       step_.newton_decrement > kAccelerated * last.newton_decrement;
  if (!is_slow) {
    acceleration_->reset();
    return std::nullopt;
  }
  if (!acceleration_->accelerate(step_.delta, equations_.diagonal())) return std::nullopt;
  equations_.retract(values_, acceleration_->accelerated(), trial_);
  const double chi2 = linearize(trial_);
  if (chi2 < chi2_) {
    acceleration_->moved(acceleration_->accelerated());
    return chi2;
  }
  acceleration_->begin(step_.delta);
  return std::nullopt;
}

// Takes one step: from the present linearisation to the next one, or to the end.
bool Loop::step_once() {
  // 1. Propose.
  ProposalStatus status;
  {
    const Timer timer(summary_.solve_seconds);
    status = algorithm_.propose(equations_, solver_, decrement_bound(), step_);
  }
  if (status == ProposalStatus::singular) {
    finish(Termination::singular, singular_message());
    return false;
  }
  if (status == ProposalStatus::exhausted) {
    finish_without_step();
    return false;
  }
  if (status == ProposalStatus::retreat) {
    retreat();
    if (steps_beyond_jump_ > 0) come_back();
    return true;
  }
  IterationRecord record = begin_record();

  // 2. Test convergence, only on full Newton steps. The last step is still taken unless chi2 rises.
  bool converged = converged_by(step_, record.step);

  // 3. Try it. Most steps are accepted, so their chi2 comes with the next linearisation. After a
  //    rejection, and for the last step, only chi2 is computed.
  const bool linearized = !converged && last_accepted_;
  const std::optional<double> accelerated = linearized ? accelerated_chi2() : std::nullopt;
  if (!accelerated) equations_.retract(values_, step_.delta, trial_);
  const double trial_chi2 = accelerated  ? *accelerated
                            : linearized ? linearize(trial_)
                                         : equations_.chi2(trial_);
  if (acceleration_ && !accelerated) acceleration_->moved(step_.delta);
  record.chi2 = trial_chi2;
  record.decrease = chi2_ - trial_chi2;
  if (converged && has_more_to_gain(record)) converged = done_ = false;
  const double noise = kChi2Rounding * chi2_;
  const bool within_rounding = std::abs(record.decrease) <= noise && step_.predicted_decrease <= noise;
  const double ratio = within_rounding ? 1 : record.decrease / step_.predicted_decrease;
  const bool finite = std::isfinite(trial_chi2);

  // 4. Accept or reject it.
  record.accepted = finite && (converged ? record.decrease >= -noise : algorithm_.acceptable(ratio));
  if (record.accepted) {
    accept(trial_chi2);
    if (!converged) {
      algorithm_.accepted(step_, ratio);
      if (!linearized) linearize(values_);
    }
  } else if (!converged && finite && crosses_jump(record)) {
    record.accepted = true;
    accept(trial_chi2);
    algorithm_.reset();
    if (!linearized) linearize(values_);
  } else if (!converged) {
    algorithm_.rejected(step_, finite ? ratio : -1);
    if (linearized) linearize(values_);
  }
  last_accepted_ = record.accepted;
  keep(record);
  return record.accepted;
}

void Loop::accept(double trial_chi2) {
  if (present_is_best_ && trial_chi2 > chi2_) {
    best_ = values_;
    present_is_best_ = false;
  }
  values_.swap(trial_);
  chi2_ = trial_chi2;
  if (chi2_ <= best_chi2_) {
    best_chi2_ = chi2_;
    present_is_best_ = true;
  }
}

/// Goes back to the values of the lowest chi2, and linearises there.
void Loop::retreat() {
  if (present_is_best_) return;
  values_.swap(best_);
  present_is_best_ = true;
  chi2_ = best_chi2_;
  linearize(values_);
  last_accepted_ = false;
}

/// Tells whether the last steps have lowered the lowest chi2 by a noticeable share, or are too few to tell:
/// then the way on this side is good enough. Steps that were undone have lowered nothing.
bool Loop::makes_progress() {
  const std::size_t steps = summary_.records.size();
  return steps < kStepsOfProgress || best_after(steps - kStepsOfProgress) - best_chi2_ > kProgress * chi2_;
}

/// Tells whether a rejected step is taken nevertheless, because chi2 jumps. The steps beyond the jump begin afresh.
bool Loop::crosses_jump(const IterationRecord& record) {
  if (steps_beyond_jump_ > 0 || -record.decrease <= decrement_bound()) return false;
  if (!jumps_.rejected(record.step, record.predicted_decrease - record.decrease, chi2_) || makes_progress())
    return false;
  steps_beyond_jump_ = kStepsBeyondJump;
  chi2_before_jump_ = best_chi2_;
  return true;
}

/// After a step beyond a jump: the crossing was worth it as soon as chi2 is lower than before it. If that does not
/// happen within a few steps, they are undone.
void Loop::judge_crossing() {
  if (best_chi2_ <= chi2_before_jump_ - decrement_bound()) {
    steps_beyond_jump_ = 0;
    jumps_.crossed();
    return;
  }
  if (!done_ && --steps_beyond_jump_ > 0) return;
  done_ = false;
  exhausted_ = false;
  retreat();
  algorithm_.reset();
  come_back();
}

/// Counts a crossing that led nowhere. The run ends at a jump that was crossed in vain too often.
void Loop::come_back() {
  steps_beyond_jump_ = 0;
  jumps_.came_back(best_chi2_);
  if (jumps_.returns() < kFutileCrossings) return;
  finish(Termination::stalled, text("stalled: chi2 jumps by ", jumps_.height(),
                                    " at these values, and no lower one was found beyond the jump"));
}

/// Steps on trial that diverge end where all is flat. The algorithm decides whether it goes back from there.
bool Loop::goes_back_from_above() {
  if (!is_above_best()) return false;
  if (algorithm_.propose(equations_, solver_, decrement_bound(), step_) != ProposalStatus::retreat)
    return false;
  retreat();
  done_ = false;
  if (steps_beyond_jump_ > 0) come_back();
  return true;
}

/// A graph whose Jacobians are NaN may look as if nothing were to do.
bool Loop::not_finite_without_unknowns() const {
  return summary_.unknowns == 0 && find_not_finite(graph_).has_value();
}

std::string Loop::named_flaw() const {
  const std::optional<std::string> flaw = find_not_finite(graph_);
  return flaw ? ": " + *flaw : "";
}

/// Tells whether H has no factor, or one that is rounding. After a step without damping the solver has that factor.
bool Loop::is_undetermined(bool has_factor) {
  FactorStatus status = has_factor ? FactorStatus::ok : solver_.factorize(equations_.hessian());
  if (status == FactorStatus::ok) {
    if (!is_on_the_verge(equations_, solver_)) return false;
    linearize(values_);  // the last step came after the last linearisation
    status = solver_.factorize(equations_.hessian());
  }
  if (status != FactorStatus::ok) return status == FactorStatus::not_positive_definite;
  return is_lost_in_rounding(graph_, values_, equations_, solver_);
}

/// If no minimum was reached, the message names an undetermined unknown; if one was, a note does.
void Loop::name_undetermined() {
  const bool gave_up = exhausted_ || summary_.termination == Termination::max_iterations ||
                       summary_.termination == Termination::stalled;
  const bool may_be_one_of_many = summary_.converged() && summary_.unknowns > 0;
  if (!gave_up && !may_be_one_of_many) return;
  if (!is_undetermined(!gave_up && !was_damped())) return;
  if (summary_.converged()) {
    summary_.notes.push_back(
        "the minimum is not the only one, and the values of some vertices are arbitrary: " +
        singular_message());
  } else {
    summary_.message += "; " + singular_message();
  }
}

Summary Loop::run() {
  prepare();
  summary_.records.reserve(static_cast<std::size_t>(std::min(options_.max_iterations, 1000)));
  values_ = graph_.values();
  best_.reserve(values_.size());  // not inside an iteration; untouched pages use no memory yet
  chi2_ = best_chi2_ = best_after(0) = summary_.initial_chi2 = linearize(values_);
  if (!std::isfinite(chi2_) || !equations_.diagonal().allFinite() || not_finite_without_unknowns()) {
    finish(Termination::non_finite, "chi2 of the initial guess is not finite" + named_flaw());
  } else if (summary_.unknowns == 0) {
    finish(Termination::nothing_to_do, "nothing to do: every vertex is fixed, held or without edges");
  }
  algorithm_.reset();
  bool moved = true;
  while (!done_) {
    if (moved && converged_at_gradient() && !goes_back_from_above()) {
      if (steps_beyond_jump_ > 0) judge_crossing();
      continue;
    }
    if (done_) break;
    if (options_.cancel != nullptr && options_.cancel->load()) {
      finish(Termination::interrupted, "interrupted " + detail::after_iterations(summary_.iterations));
    } else if (summary_.iterations >= options_.max_iterations) {
      finish(Termination::max_iterations, "not converged " + detail::after_iterations(summary_.iterations));
    } else {
      const bool whole = whole_curvature_ || converges_slowly();
      const bool beyond_jump = steps_beyond_jump_ > 0;
      moved = whole ? step_with_whole_curvature() : step_once();
      if (beyond_jump && steps_beyond_jump_ > 0) judge_crossing();
    }
  }
  // Full steps that went uphill may end at a minimum above earlier values. The values that are then
  // returned are no minimum.
  if (summary_.converged() && is_above_best()) {
    finish(Termination::stalled, text("the steps ended at a stationary point with chi2 ", chi2_,
                                      "; the lowest chi2 on the way, ", best_chi2_, ", is kept"));
  }
  name_undetermined();
  summary_.final_chi2 = best_chi2_;
  if (summary_.unknowns > 0) {
    summary_.factor_size = solver_.factor_size();
    summary_.solver = solver_.description();
  }
  graph_.set_values(std::move(present_is_best_ ? values_ : best_));
  summary_.total_seconds = seconds_since(start_);
  return std::move(summary_);
}

}  // namespace

bool has_losses(const Graph& graph) {
  for (std::size_t b = 0; b < graph.batch_count(); ++b)
    for (std::size_t e = 0; e < graph.batch(b).size(); ++e)
      if (graph.batch(b).loss(e) != nullptr) return true;
  return false;
}

void OptimizerOptions::check() const {
  const auto require = [](bool valid, const char* field, double value, const char* rule) {
    if (!valid) throw UsageError(text("optimizer option ", field, " = ", value, ": must be ", rule));
  };
  require(max_iterations >= 0, "max_iterations", max_iterations, ">= 0");
  require(threads >= 1, "threads", threads, ">= 1");
  require(decrement_tolerance > 0, "decrement_tolerance", decrement_tolerance, "> 0");
  require(gradient_tolerance >= 0, "gradient_tolerance", gradient_tolerance, ">= 0");
  require(step_tolerance >= 0, "step_tolerance", step_tolerance, ">= 0");
}

Summary optimize(Graph& graph, Algorithm& algorithm, LinearSolver& solver, const OptimizerOptions& options) {
  options.check();
  return Loop(graph, nullptr, algorithm, solver, options).run();
}

Summary optimize(Graph& graph, StructuredSolver& solver, Algorithm& algorithm,
                 const OptimizerOptions& options) {
  options.check();
  if (!solver.structure().follows(graph))
    throw UsageError("optimize: the structure does not follow the graph");
  return Loop(graph, &solver.structure(), algorithm, solver.analysed(), options).run();
}

Algorithm::~Algorithm() = default;
LinearSolver::~LinearSolver() = default;

}  // namespace waymark
