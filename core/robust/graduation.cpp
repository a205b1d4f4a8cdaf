#include <algorithm>
#include <chrono>
#include <cmath>
#include <iterator>
#include <limits>
#include <sstream>

#include <waymark/core/base/error.hpp>
#include <waymark/core/robust/chi_square.hpp>
#include <waymark/core/robust/graduation.hpp>

namespace waymark {
namespace {

/// There are verdicts at this stretch, at a quarter of it, ..., and at 1. The default width of
/// Geman-McClure is then 4, 2 and 1 standard deviations. The best width depends on how far the
/// stated noise is from the true one.
constexpr double kFirstVerdict = 16;
/// Steps towards the minimum of all edges.
constexpr int kFirstIterations = 50;
/// Steps towards the minimum with the loss before a verdict.
constexpr int kConverge = 30;

LossValue no_loss(double squared, double) {
  return {squared, 1, 0};
}

/// Tells whether m rho(s / m) is still convex in the error at s: it has no negative curvature
/// along the error.
bool convex_at(const Loss& loss, double squared) {
  const LossValue value = loss.at(squared);
  return value.weight > 0 && value.weight + 2 * squared * value.curvature >= -1e-9 * value.weight;
}

/// A split of the edges, and its minimum.
struct Verdict {
  std::vector<EdgePlace> outliers;
  std::vector<double> values;
  Summary summary;
  /// chi2 of the kept edges + quantile per outlier
  double cost = std::numeric_limits<double>::infinity();
};

class Graduation {
 public:
  Graduation(Graph& graph, Algorithm& algorithm, LinearSolver& solver, const GraduationOptions& options)
      : graph_(graph), working_(graph), algorithm_(algorithm), solver_(solver), options_(options) {}

  GraduationResult run();

 private:
  void find_candidates();
  double bound(EdgePlace place) const;
  std::vector<EdgePlace> beyond_bound() const;
  std::vector<EdgePlace> inside(const Verdict& verdict) const;
  double first_stretch() const;
  void attach_losses();
  void narrow();
  void judge(std::vector<EdgePlace> outliers);
  void cross_examine();
  Verdict optimize_without(std::vector<EdgePlace> outliers);
  std::vector<EdgePlace> accused(const Verdict& verdict);
  std::vector<EdgePlace> still_out(const Verdict& verdict, std::vector<EdgePlace>& returned);
  Summary count(Summary summary) {
    result_.iterations += summary.iterations;
    interrupted_ = interrupted_ || summary.termination == Termination::interrupted;
    return summary;
  }

  Graph& graph_;   // with its own losses, and the values of the last verdict
  Graph working_;  // with the narrowing loss
  Algorithm& algorithm_;
  LinearSolver& solver_;
  const GraduationOptions& options_;
  std::vector<EdgePlace> candidates_;
  std::vector<std::vector<EdgePlace>> judged_;  // splits whose minimum is known
  Verdict best_;
  bool interrupted_ = false;
  GraduationResult result_;
};

void Graduation::find_candidates() {
  for (std::size_t b = 0; b < graph_.batch_count(); ++b) {
    result_.weights.emplace_back(graph_.batch(b).size(), 1.0);
    for (std::size_t e = 0; e < graph_.batch(b).size(); ++e) {
      if (!options_.trusted(graph_, {b, e})) candidates_.push_back({b, e});
    }
  }
  result_.candidates = candidates_.size();
}

double Graduation::bound(EdgePlace place) const {
  const int dimension = graph_.batch(place.batch).error_dimension(place.edge);
  return chi_square_quantile(options_.inlier_probability, dimension);
}

std::vector<EdgePlace> Graduation::beyond_bound() const {
  std::vector<EdgePlace> result;
  for (const EdgePlace place : candidates_) {
    if (!(squared_error(graph_, place) <= bound(place))) result.push_back(place);
  }
  return result;
}

std::vector<EdgePlace> Graduation::inside(const Verdict& verdict) const {
  std::vector<EdgePlace> result;
  std::set_difference(candidates_.begin(), candidates_.end(), verdict.outliers.begin(),
                      verdict.outliers.end(), std::back_inserter(result));
  return result;
}

// Returns the smallest power of two at which the loss is convex at every candidate.
double Graduation::first_stretch() const {
  double largest = 0;
  for (const EdgePlace place : candidates_) largest = std::max(largest, squared_error(working_, place));
  Loss loss = options_.loss;
  while (std::isfinite(largest) && std::isfinite(loss.stretch) && !convex_at(loss, largest)) {
    loss.stretch *= 2;
  }
  return loss.stretch;
}

// Candidates have the loss of their batch, which narrows. The other edges keep their own, or none.
void Graduation::attach_losses() {
  auto candidate = candidates_.begin();
  for (std::size_t b = 0; b < working_.batch_count(); ++b) {
    for (std::size_t e = 0; e < working_.batch(b).size(); ++e) {
      const Loss* own = graph_.batch(b).loss(e);
      const bool doubted = candidate != candidates_.end() && *candidate == EdgePlace{b, e};
      if (!doubted) working_.batch(b).set_loss(e, own != nullptr ? *own : Loss{"none", &no_loss});
      candidate += doubted;
    }
  }
}

void Graduation::narrow() {
  OptimizerOptions inner = options_.optimizer;
  inner.max_iterations = options_.inner_iterations;
  Loss loss = options_.loss;
  loss.stretch = first_stretch();
  attach_losses();
  double next_verdict = kFirstVerdict;
  while (!interrupted_) {
    for (std::size_t b = 0; b < working_.batch_count(); ++b) working_.batch(b).set_loss(loss);
    (void)count(optimize(working_, algorithm_, solver_, inner));
    ++result_.rounds;
    if (loss.stretch <= next_verdict) {
      Graph settled = working_;  // the narrowing itself continues from its own values
      OptimizerOptions converge = inner;
      converge.max_iterations = kConverge;
      if (!interrupted_) (void)count(optimize(settled, algorithm_, solver_, converge));
      graph_.set_values(settled.values());
      judge(beyond_bound());
      next_verdict = std::max(1.0, loss.stretch / 4);
    }
    if (loss.stretch <= 1) return;
    loss.stretch = std::max(1.0, loss.stretch / options_.factor);
  }
}

Verdict Graduation::optimize_without(std::vector<EdgePlace> outliers) {
  Verdict verdict;
  Graph kept = without_edges(graph_, outliers);
  verdict.summary = count(optimize(kept, algorithm_, solver_, options_.optimizer));
  ++result_.passes;
  graph_.set_values(kept.values());
  verdict.values = kept.values();
  verdict.cost = verdict.summary.final_chi2;
  for (const EdgePlace place : outliers) verdict.cost += bound(place);
  verdict.outliers = std::move(outliers);
  return verdict;
}

// Returns the edges that are outside after this minimum. Edges inside that exceed the bound go out.
// Edges outside whose innovation is within it come in, each of them once; the other ones would
// raise the minimum by more than they cost outside.
std::vector<EdgePlace> Graduation::still_out(const Verdict& verdict, std::vector<EdgePlace>& returned) {
  const Graph kept = without_edges(graph_, verdict.outliers);
  const std::vector<double> innovation =
      innovations(graph_, verdict.outliers, Membership::outside, kept, solver_);
  std::vector<EdgePlace> out;
  for (std::size_t i = 0; i < verdict.outliers.size(); ++i) {
    const EdgePlace place = verdict.outliers[i];
    const auto known = std::lower_bound(returned.begin(), returned.end(), place);
    const bool was_back = known != returned.end() && *known == place;
    if (was_back || !(innovation[i] <= bound(place))) {
      out.push_back(place);
    } else {
      returned.insert(known, place);
    }
  }
  for (const EdgePlace place : inside(verdict)) {
    if (!(squared_error(graph_, place) <= bound(place))) out.push_back(place);
  }
  std::sort(out.begin(), out.end());
  return out;
}

// Returns the edges inside that all others contradict: without such an edge the minimum would fall
// by more than it costs outside. A false edge makes good neighbours look bad, so only those close
// to the worst are returned.
std::vector<EdgePlace> Graduation::accused(const Verdict& verdict) {
  const std::vector<EdgePlace> members = inside(verdict);
  const Graph kept = without_edges(graph_, verdict.outliers);
  const std::vector<double> against = innovations(graph_, members, Membership::inside, kept, solver_);
  const double worst = against.empty() ? 0 : *std::max_element(against.begin(), against.end());
  std::vector<EdgePlace> result;
  for (std::size_t i = 0; i < members.size(); ++i) {
    if (against[i] > std::max(bound(members[i]), 0.5 * worst)) result.push_back(members[i]);
  }
  return result;
}

// Improves a first split until no single edge makes it cheaper by leaving or returning.
void Graduation::judge(std::vector<EdgePlace> outliers) {
  constexpr int kMaxPasses = 20;  // two or three are usual
  std::vector<EdgePlace> returned;
  for (int pass = 0; pass < kMaxPasses && !interrupted_; ++pass) {
    if (std::find(judged_.begin(), judged_.end(), outliers) != judged_.end()) return;
    judged_.push_back(outliers);
    Verdict verdict;
    try {
      verdict = optimize_without(std::move(outliers));
    } catch (const InputError&) {
      return;  // the remaining edges determine no solution, so there is no split to choose
    }
    if (interrupted_) return;
    outliers = still_out(verdict, returned);
    if (verdict.cost < best_.cost || best_.values.empty()) best_ = std::move(verdict);
  }
}

// Finds edges that bend the rest without a large error of their own. This is done only for the best
// split, because it takes a solve per candidate and dimension.
void Graduation::cross_examine() {
  constexpr int kMaxRounds = 20;
  for (int round = 0; round < kMaxRounds && !interrupted_; ++round) {
    graph_.set_values(best_.values);
    std::vector<EdgePlace> outliers = accused(best_);
    if (outliers.empty()) return;
    outliers.insert(outliers.end(), best_.outliers.begin(), best_.outliers.end());
    std::sort(outliers.begin(), outliers.end());
    const double before = best_.cost;
    judge(std::move(outliers));
    if (!(best_.cost < before)) return;
  }
}

GraduationResult Graduation::run() {
  const auto start = std::chrono::steady_clock::now();
  options_.check();
  find_candidates();
  // 1. Use all edges. If none is beyond its bound, there are no outliers. With outliers this
  //    minimum may be far away; the next step need not start exactly from it.
  OptimizerOptions first = options_.optimizer;
  first.max_iterations = std::min(kFirstIterations, first.max_iterations);
  (void)count(optimize(graph_, algorithm_, solver_, first));
  const bool suspicious = !beyond_bound().empty();
  working_.set_values(graph_.values());
  if (!interrupted_ && suspicious) {
    // 2. Narrow the loss from there. The cheapest split on the way counts.
    narrow();
    cross_examine();
  }
  if (best_.values.empty()) best_ = optimize_without({});
  graph_.set_values(std::move(best_.values));
  for (const EdgePlace place : candidates_) {
    result_.weights[place.batch][place.edge] = options_.loss.at(squared_error(graph_, place)).weight;
  }
  result_.outliers = std::move(best_.outliers);
  result_.summary = std::move(best_.summary);
  if (interrupted_) {
    result_.summary.termination = Termination::interrupted;
    result_.summary.message = "interrupted while looking for outliers";
  }
  result_.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return std::move(result_);
}

}  // namespace

namespace {

bool follow_each_other(VertexId a, VertexId b) {
  return to_number(a) + 1 == to_number(b) || to_number(b) + 1 == to_number(a);
}

}  // namespace

bool is_odometry_edge(const Graph& graph, EdgePlace place) {
  if (graph.edge_type(place.batch).arity == EdgeType::kRuntimeArity) return true;
  const EdgeBatchBase& batch = graph.batch(place.batch);
  std::vector<VertexIndex> placed;
  for (const VertexIndex v : batch.vertices(place.edge)) {
    if (graph.vertex_type(v).position != nullptr) placed.push_back(v);
  }
  if (placed.size() != 2 || graph.fixed(placed[0]) || graph.fixed(placed[1])) return false;
  const VertexType& type = graph.vertex_type(placed[0]);
  return type.tag == graph.vertex_type(placed[1]).tag &&
         batch.error_dimension(place.edge) >= type.tangent_size &&
         follow_each_other(graph.id(placed[0]), graph.id(placed[1]));
}

GraduationOptions::GraduationOptions() {
  for (const LossType& type : builtin_losses()) {
    if (type.name == "geman_mcclure") loss = Loss{type.name, type.evaluate, 1};
  }
}

void GraduationOptions::check() const {
  const auto require = [](bool valid, const char* field, double value, const char* rule) {
    if (valid) return;
    std::ostringstream message;
    message.imbue(std::locale::classic());
    message << "graduation option " << field << " = " << value << ": must be " << rule;
    throw UsageError(message.str());
  };
  require(loss.evaluate != nullptr && loss.scale > 0, "loss.scale", loss.scale, "> 0, of a known loss");
  require(factor > 1, "factor", factor, "> 1");
  require(inner_iterations >= 1, "inner_iterations", inner_iterations, ">= 1");
  require(inlier_probability > 0 && inlier_probability < 1, "inlier_probability", inlier_probability,
          "in (0, 1)");
  optimizer.check();
}

GraduationResult graduate(Graph& graph, Algorithm& algorithm, LinearSolver& solver,
                          const GraduationOptions& options) {
  return Graduation(graph, algorithm, solver, options).run();
}

}  // namespace waymark
