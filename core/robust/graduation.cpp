#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <iterator>
#include <limits>
#include <map>
#include <optional>
#include <span>
#include <utility>

#include <waymark/core/base/detail/median.hpp>
#include <waymark/core/base/error.hpp>
#include <waymark/core/linear/block_symbolic.hpp>
#include <waymark/core/robust/chi_square.hpp>
#include <waymark/core/robust/detail/moved_errors.hpp>
#include <waymark/core/robust/detail/ways.hpp>
#include <waymark/core/robust/detail/wrong_places.hpp>
#include <waymark/core/robust/graduation.hpp>
#include <waymark/core/system/gauge.hpp>
#include <waymark/core/system/structure.hpp>

namespace waymark {
namespace {

/// There are verdicts at this stretch, at a quarter of it, ..., and at 1. The default width of
/// Geman-McClure is then 4, 2 and 1 standard deviations. The best width depends on how far the
/// stated noise is from the true one.
constexpr double kFirstVerdict = 16;
/// Steps towards the minimum of all edges.
constexpr int kFirstIterations = 50;
/// Times that trusted edges are doubted, and the search is repeated without them.
constexpr int kMaxDoubts = 10;
/// If more than this share of the candidates are outliers, they may be right, and a trusted edge wrong.
constexpr double kManyOutliers = 0.2;
constexpr double kFewOutliers = 3;  // so few say nothing about the others
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

/// Returns how many operations the dense part of a factorisation of the normal equations takes.
double factorization_operations(const Graph& graph) {
  Structure structure;
  structure.build(graph, find_gauge(graph, PartlyAnchored::hold_vertex).held);
  double sum = 0;
  for (const Supernode& node : analyze_blocks(structure.pattern()).nodes) {
    if (node.links > 0) continue;
    const double height = node.columns + node.below;
    sum += node.columns * height * height;
  }
  return sum;
}

/// Returns the edges that are not among others; both lists are ascending, and so is the result.
std::vector<EdgePlace> difference(const std::vector<EdgePlace>& edges, const std::vector<EdgePlace>& others) {
  std::vector<EdgePlace> result;
  std::set_difference(edges.begin(), edges.end(), others.begin(), others.end(), std::back_inserter(result));
  return result;
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
  void move_to_candidates(const std::vector<EdgePlace>& edges);
  std::vector<EdgePlace> confirmed(std::span<const EdgePlace> edges);
  Verdict approach_all();
  bool is_clean(const Verdict& with_all) const;
  bool are_outliers_grouped();
  bool begin_with_confirmed();
  void search();
  template <typename Search>
  void from_trusted(Search search);
  template <typename Search>
  void apart(Search search);
  std::optional<std::vector<EdgePlace>> grown_from(std::vector<EdgePlace> out);
  std::vector<EdgePlace> contradicted(std::span<const EdgePlace> trusted) const;
  std::vector<EdgePlace> kept_and_trusted() const;
  std::vector<EdgePlace> unconfirmed() const;
  bool doubt_trusted();
  bool doubt_for_agreeing();
  bool doubt_ways(const Verdict& verdict);
  bool doubt_all(const std::vector<EdgePlace>& doubted, std::vector<EdgePlace> outliers,
                 const Verdict& verdict);
  void weigh();
  bool may_be_grown(const Graph& trusted) const;
  bool is_implausible(const Verdict& verdict) const;
  bool is_doubtful(double share) const;
  bool ends_badly(double share) const;
  bool outliers_agree(double share) const;
  std::vector<EdgePlace> agreeing_outliers() const;
  double cost(const Verdict& verdict);
  double cost_by_edges(const Verdict& verdict) const;
  void doubt();
  void doubt_best();
  double bound(EdgePlace place) const;
  bool is_trusted(EdgePlace place) const {
    return std::binary_search(of_rule_.begin(), of_rule_.end(), place);
  }
  double price(EdgePlace place) const;
  std::vector<EdgePlace> beyond_bound() const;
  std::vector<EdgePlace> inside(const Verdict& verdict) const;
  double first_stretch() const;
  void attach_losses();
  void narrow();
  void judge(std::vector<EdgePlace> outliers);
  void return_singly();
  void cross_examine();
  Verdict optimize_without(std::vector<EdgePlace> outliers);
  void choose(std::vector<EdgePlace> outliers);
  std::vector<EdgePlace> most_accused(std::span<const EdgePlace> edges, const Verdict& verdict);
  std::vector<std::pair<double, EdgePlace>> accusations(std::span<const EdgePlace> edges,
                                                        const Verdict& verdict);
  std::vector<EdgePlace> joining(std::span<const EdgePlace> outside, const Graph& kept) const;
  std::vector<EdgePlace> without_joining(const std::vector<EdgePlace>& outside) const;
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
  std::map<int, double> bounds_;    // of squared errors, by dimension
  std::vector<EdgePlace> of_rule_;  // what the rule trusts, doubted or not
  std::vector<EdgePlace> candidates_;
  std::vector<EdgePlace> trusted_;                 // the other ones
  std::vector<std::vector<EdgePlace>> parallels_;  // groups of candidates that would be trusted alone
  std::vector<std::vector<EdgePlace>> judged_;     // splits whose minimum is known
  std::optional<detail::WrongPlaces> wrong_places_;
  Verdict best_;
  Verdict best_by_edges_;  // the cheapest one if every edge of a group counted
  bool is_slow_ = false;   // a step with all edges takes a part of a second
  bool dense_ = false;     // and so many seconds that none is done
  bool interrupted_ = false;
  GraduationResult result_;
};

void Graduation::find_candidates() {
  of_rule_ = options_.trusted(graph_);
  result_.trusted = of_rule_.size();
  for (std::size_t b = 0; b < graph_.batch_count(); ++b) {
    result_.weights.emplace_back(graph_.batch(b).size(), 1.0);
    for (std::size_t e = 0; e < graph_.batch(b).size(); ++e) {
      (is_trusted({b, e}) ? trusted_ : candidates_).push_back({b, e});
      const auto [bound, is_new] = bounds_.try_emplace(graph_.batch(b).error_dimension(e));
      if (is_new) bound->second = chi_square_quantile(options_.inlier_probability, bound->first);
    }
  }
  result_.candidates = candidates_.size();
  wrong_places_.emplace(graph_, trusted_, algorithm_, solver_,
                        [this](EdgePlace place) { return bound(place); });
  if (!options_.doubts_trusted) return;
  parallels_ = contradicting_parallels(graph_, trusted_, algorithm_, solver_, options_.inlier_probability);
  for (const std::vector<EdgePlace>& group : parallels_) move_to_candidates(group);
  result_.candidates = candidates_.size();
}

void Graduation::move_to_candidates(const std::vector<EdgePlace>& edges) {
  std::erase_if(trusted_,
                [&](EdgePlace place) { return std::binary_search(edges.begin(), edges.end(), place); });
  candidates_.insert(candidates_.end(), edges.begin(), edges.end());
  std::sort(candidates_.begin(), candidates_.end());
}

double Graduation::bound(EdgePlace place) const {
  return bounds_.at(graph_.batch(place.batch).error_dimension(place.edge));
}

// What an edge costs outside. A trusted edge costs more: a false closure that only joins a tail of the graph and each
// edge of this tail explain the contradiction alike.
double Graduation::price(EdgePlace place) const {
  constexpr double kOfTrusted = 2;
  return (is_trusted(place) ? kOfTrusted : 1.0) * bound(place);
}

// A trusted edge is against whole places, not against each of their closures.
// @param verdict whose values are those of the graph
double Graduation::cost(const Verdict& verdict) {
  std::vector<EdgePlace> outliers = verdict.outliers;
  const auto closures = std::stable_partition(outliers.begin(), outliers.end(),
                                              [&](EdgePlace place) { return is_trusted(place); });
  double result = verdict.summary.final_chi2;
  for (auto place = outliers.begin(); place != closures; ++place) result += price(*place);
  return result + wrong_places_->price(graph_, std::span(closures, outliers.end()));
}

double Graduation::cost_by_edges(const Verdict& verdict) const {
  double result = verdict.summary.final_chi2;
  for (const EdgePlace place : verdict.outliers) result += price(place);
  return result;
}

std::vector<EdgePlace> Graduation::beyond_bound() const {
  std::vector<EdgePlace> result;
  for (const EdgePlace place : candidates_) {
    if (!(squared_error(graph_, place) <= bound(place))) result.push_back(place);
  }
  return result;
}

std::vector<EdgePlace> Graduation::inside(const Verdict& verdict) const {
  return difference(candidates_, verdict.outliers);
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

// Narrows the loss from the present values of the graph. The cheapest split on the way counts.
void Graduation::search() {
  if (!dense_) {
    working_ = graph_;
    narrow();
  }
  cross_examine();
}

// Calls a search with all candidates outside, but one edge of each group of parallel ones: the first one, then
// the last.
template <typename Search>
void Graduation::from_trusted(Search search) {
  for (const bool first : {true, false}) {
    std::vector<EdgePlace> out = candidates_;
    for (const std::vector<EdgePlace>& group : parallels_)
      std::erase(out, first ? group.front() : group.back());
    apart([&] { search(std::move(out)); });
    if (parallels_.empty()) return;
  }
}

// Improves the best split of this search, even if another search has found a cheaper one that may be improved
// no more.
template <typename Search>
void Graduation::apart(Search search) {
  Verdict others = std::exchange(best_, {});
  search();
  if (!(best_.cost < others.cost)) best_ = std::move(others);
}

// Tells whether another search may find better. @param share of the candidates that may be outside
bool Graduation::is_doubtful(double share) const {
  return best_.values.empty() || is_implausible(best_) || outliers_agree(share);
}

// Tells the same of a search with all edges.
bool Graduation::ends_badly(double share) const {
  return !interrupted_ && !dense_ && is_doubtful(share);
}

// Tells how much all edges fill the factor. False closures do, because they join places anywhere; right ones on
// 200,000 street corners would not.
void Graduation::weigh() {
  constexpr double kSeconds = 1e9;  // operations: the hundreds of steps of narrowing would take minutes
  constexpr double kManySeconds = 1e11;
  const double operations = factorization_operations(graph_);
  is_slow_ = operations > kSeconds;
  dense_ = operations >= kManySeconds && may_be_grown(without_edges(graph_, without_joining(candidates_)));
}

// Tells whether these edges place what they join, or nothing else says where that is. Elsewhere the innovations
// would take a place for known that nothing places.
bool Graduation::may_be_grown(const Graph& first) const {
  const std::vector<char> held = find_gauge(first, PartlyAnchored::hold_vertex).held;
  if (std::none_of(held.begin(), held.end(), [](char mark) { return mark != 0; })) return true;
  return std::all_of(candidates_.begin(), candidates_.end(), [&](EdgePlace place) {
    const std::span<const VertexIndex> vertices = graph_.batch(place.batch).vertices(place.edge);
    return std::count_if(vertices.begin(), vertices.end(), [&](VertexIndex v) { return !graph_.fixed(v); }) >
           1;
  });
}

// Tells whether more than a share of the candidates are outside, and some of them want the same: these may be right,
// and what contradicts them wrong.
bool Graduation::outliers_agree(double share) const {
  const double many = share * static_cast<double>(candidates_.size());
  if (static_cast<double>(best_.outliers.size()) <= std::max(kFewOutliers, many)) return false;
  const bool are_pairs = std::all_of(best_.outliers.begin(), best_.outliers.end(), [&](EdgePlace place) {
    return graph_.batch(place.batch).vertices(place.edge).size() == 2;
  });
  if (!are_pairs) return true;  // what they want is not compared
  return !agreeing_outliers().empty();
}

// Returns the most of the outliers that want the same. None: no more than may by chance.
std::vector<EdgePlace> Graduation::agreeing_outliers() const {
  Graph at_best = graph_;
  at_best.set_values(best_.values);
  const double wide = 4 * chi_square_quantile(options_.inlier_probability, 3);
  const std::size_t by_chance = detail::most_by_chance(at_best, best_.outliers, wide);
  std::vector<EdgePlace> most = detail::most_that_agree(std::move(at_best), best_.outliers, wide);
  const bool is_chance = most.size() <= by_chance || static_cast<double>(most.size()) < kFewOutliers;
  if (is_chance) most.clear();
  return most;
}

// Returns the outliers that remain if those that agree with the rest return, a share of them at a time. Those
// that the rest predicts most surely come first: others may agree by chance, and once their betters are in,
// they do not. What nothing joins is joined by one edge before.
std::optional<std::vector<EdgePlace>> Graduation::grown_from(std::vector<EdgePlace> out) {
  constexpr int kMaxSplits = 1000;
  constexpr std::size_t kShare = 10;
  constexpr double kTogether = 2;  // of the looseness, between the first and the last that return at a time
  out = without_joining(out);
  if (!may_be_grown(without_edges(graph_, out))) return std::nullopt;
  Verdict cheapest;
  std::vector<EdgePlace> refused;  // had returned, and were contradicted by others
  for (int split = 0; split < kMaxSplits; ++split) {
    Verdict verdict;
    try {
      verdict = optimize_without(out);
    } catch (const InputError&) {
      break;  // the remaining edges determine no solution
    }
    if (interrupted_) break;
    verdict.cost = cost_by_edges(verdict);  // growing lowers both costs
    if (verdict.cost < cheapest.cost) cheapest = verdict;
    const Graph kept = without_edges(graph_, verdict.outliers);
    const std::vector<Innovation> innovation =
        innovations(graph_, verdict.outliers, Membership::outside, kept);
    std::vector<std::pair<double, EdgePlace>> agreeing;
    for (std::size_t i = 0; i < out.size(); ++i) {
      if (innovation[i].squared <= bound(out[i]) &&
          !std::binary_search(refused.begin(), refused.end(), out[i]))
        agreeing.emplace_back(innovation[i].looseness, out[i]);
    }
    if (agreeing.empty()) break;
    std::sort(agreeing.begin(), agreeing.end());
    agreeing.resize((agreeing.size() + kShare - 1) / kShare);
    std::erase_if(agreeing, [limit = agreeing.front().first + kTogether](const auto& edge) {
      return edge.first > limit;
    });
    for (const auto& [looseness, place] : agreeing) std::erase(out, place);
    for (const EdgePlace place : inside(verdict)) {
      if (squared_error(graph_, place) <= bound(place)) continue;
      out.push_back(place);
      refused.push_back(place);
    }
    std::sort(out.begin(), out.end());
    std::sort(refused.begin(), refused.end());
  }
  if (!cheapest.values.empty()) {
    graph_.set_values(cheapest.values);
    cheapest.cost = cost(cheapest);
    if (cheapest.cost < best_.cost) best_ = std::move(cheapest);
  }
  return out;
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
  verdict.outliers = std::move(outliers);
  return verdict;
}

// Makes a split the best one, whatever it costs.
void Graduation::choose(std::vector<EdgePlace> outliers) {
  best_ = optimize_without(std::move(outliers));
  best_.cost = cost(best_);
}

// Returns the edges without which a split falls apart, although nothing contradicts them; trusted ones are preferred.
std::vector<EdgePlace> Graduation::joining(std::span<const EdgePlace> outside, const Graph& kept) const {
  std::vector<EdgePlace> edges(outside.begin(), outside.end());
  std::stable_partition(edges.begin(), edges.end(), [&](EdgePlace place) { return is_trusted(place); });
  std::vector<EdgePlace> result = joining_edges(graph_, edges, kept);
  std::sort(result.begin(), result.end());
  return result;
}

std::vector<EdgePlace> Graduation::without_joining(const std::vector<EdgePlace>& outside) const {
  return difference(outside, joining(outside, without_edges(graph_, outside)));
}

// Returns the edges that are outside after this minimum. Edges inside that exceed the bound go out.
// Edges outside whose innovation is within the bound come in, each of them once; the other ones would raise the
// minimum by more than they cost outside. Those that join what falls apart raise nothing, and come in whenever they do.
std::vector<EdgePlace> Graduation::still_out(const Verdict& verdict, std::vector<EdgePlace>& returned) {
  const Graph kept = without_edges(graph_, verdict.outliers);
  const std::vector<Innovation> innovation = innovations(graph_, verdict.outliers, Membership::outside, kept);
  const std::vector<EdgePlace> joins = joining(verdict.outliers, kept);
  std::vector<EdgePlace> out;
  for (std::size_t i = 0; i < verdict.outliers.size(); ++i) {
    const EdgePlace place = verdict.outliers[i];
    const auto known = std::lower_bound(returned.begin(), returned.end(), place);
    const bool was_back = known != returned.end() && *known == place;
    const bool agrees = !was_back && innovation[i].squared <= price(place);
    if (!agrees && !std::binary_search(joins.begin(), joins.end(), place)) {
      out.push_back(place);
    } else if (!was_back) {
      returned.insert(known, place);
    }
  }
  for (const EdgePlace place : inside(verdict)) {
    if (!(squared_error(graph_, place) <= bound(place))) out.push_back(place);
  }
  std::sort(out.begin(), out.end());
  return out;
}

// Returns those of some edges inside that all others contradict: without such an edge the minimum would
// fall by more than it costs outside. A false edge makes good neighbours look bad, so only those close
// to the worst are returned.
std::vector<EdgePlace> Graduation::most_accused(std::span<const EdgePlace> members, const Verdict& verdict) {
  std::vector<EdgePlace> result;
  for (const auto& [gain, place] : accusations(members, verdict)) result.push_back(place);
  std::sort(result.begin(), result.end());
  return result;
}

// Returns the same, the worst first, with what the minimum would fall by.
std::vector<std::pair<double, EdgePlace>> Graduation::accusations(std::span<const EdgePlace> members,
                                                                  const Verdict& verdict) {
  const Graph kept = without_edges(graph_, verdict.outliers);
  const std::vector<Innovation> against = innovations(graph_, members, Membership::inside, kept);
  double worst = 0;
  for (const Innovation& innovation : against) worst = std::max(worst, innovation.squared);
  std::vector<std::pair<double, EdgePlace>> result;
  for (std::size_t i = 0; i < members.size(); ++i) {
    if (against[i].squared > std::max(bound(members[i]), 0.5 * worst))
      result.emplace_back(against[i].squared, members[i]);
  }
  std::sort(result.begin(), result.end(), std::greater<>());
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
    verdict.cost = cost_by_edges(verdict);
    if (verdict.cost < best_by_edges_.cost) best_by_edges_ = verdict;
    verdict.cost = cost(verdict);
    outliers = still_out(verdict, returned);
    if (verdict.cost < best_.cost || best_.values.empty()) best_ = std::move(verdict);
  }
}

// Lets edges return one at a time, the one that agrees best first: of two that each agree with the rest, one may
// be false, and then both together cost more.
void Graduation::return_singly() {
  constexpr int kMaxReturns = 20;
  for (int round = 0; round < kMaxReturns && !interrupted_ && !best_.outliers.empty(); ++round) {
    graph_.set_values(best_.values);
    std::vector<EdgePlace> outliers = best_.outliers;
    const std::vector<Innovation> innovation =
        innovations(graph_, outliers, Membership::outside, without_edges(graph_, outliers));
    std::size_t best = 0;
    for (std::size_t i = 1; i < outliers.size(); ++i)
      if (innovation[i].squared < innovation[best].squared) best = i;
    if (!(innovation[best].squared <= price(outliers[best]))) return;
    outliers.erase(outliers.begin() + static_cast<std::ptrdiff_t>(best));
    const double before = best_.cost;
    judge(std::move(outliers));
    if (!(best_.cost < before)) return;
  }
}

// Finds edges that bend the rest without a large error of their own. This is done only for the best
// split, because it takes an innovation per candidate.
void Graduation::cross_examine() {
  constexpr int kMaxRounds = 20;
  return_singly();
  for (int round = 0; round < kMaxRounds && !interrupted_ && !best_.values.empty(); ++round) {
    graph_.set_values(best_.values);
    std::vector<EdgePlace> outliers = most_accused(inside(best_), best_);
    if (outliers.empty()) return;
    outliers.insert(outliers.end(), best_.outliers.begin(), best_.outliers.end());
    std::sort(outliers.begin(), outliers.end());
    const double before = best_.cost;
    judge(std::move(outliers));
    if (!(best_.cost < before)) return;
  }
}

// Returns the trusted edges whose error at the best split is beyond their bound. Stated noise is often smaller
// than the true one; the median of the trusted errors tells by how much.
std::vector<EdgePlace> Graduation::contradicted(std::span<const EdgePlace> trusted) const {
  std::vector<double> shares;  // of the bound
  for (const EdgePlace place : trusted) shares.push_back(squared_error(graph_, place) / bound(place));
  if (shares.empty()) return {};
  const double usual = chi_square_quantile(0.5, 3) / chi_square_quantile(options_.inlier_probability, 3);
  const double limit = std::max(1.0, upper_median(shares) / usual);
  std::vector<EdgePlace> result;
  for (std::size_t i = 0; i < shares.size(); ++i) {
    if (!(shares[i] <= limit)) result.push_back(trusted[i]);
  }
  return result;
}

std::vector<EdgePlace> Graduation::kept_and_trusted() const {
  std::vector<EdgePlace> result = trusted_;
  for (const EdgePlace place : inside(best_)) {
    if (is_trusted(place)) result.push_back(place);
  }
  std::sort(result.begin(), result.end());
  return result;
}

// Returns the candidates inside that no other edge checks, although outliers join the same parts elsewhere.
std::vector<EdgePlace> Graduation::unconfirmed() const {
  constexpr double kUnchecked = 1e-6;
  constexpr std::size_t kMostTried = 100;  // each takes a look at the whole graph
  std::vector<EdgePlace> result;
  if (best_.outliers.empty() || interrupted_) return result;
  const std::vector<EdgePlace> members = inside(best_);
  const std::vector<Innovation> innovation =
      innovations(graph_, members, Membership::inside, without_edges(graph_, best_.outliers));
  std::size_t tried = 0;
  for (std::size_t i = 0; i < members.size() && tried < kMostTried; ++i) {
    if (!(innovation[i].squared <= kUnchecked)) continue;
    ++tried;
    std::vector<EdgePlace> outside = best_.outliers;
    outside.insert(std::lower_bound(outside.begin(), outside.end(), members[i]), members[i]);
    const Graph parts = without_edges(graph_, outside);
    if (!joining_edges(graph_, best_.outliers, parts).empty()) result.push_back(members[i]);
  }
  return result;
}

// Makes candidates of the trusted edges that the best split contradicts most. A wrong edge may bend the rest so
// that its own error is small. If chi2 or closures outside tell that something may be wrong, all are asked what it
// costs to keep them.
// @return there is a cheaper split now
bool Graduation::doubt_trusted() {
  graph_.set_values(best_.values);
  const std::vector<EdgePlace> accused = most_accused(contradicted(trusted_), best_);
  if (doubt_all(accused, accused, best_)) return true;
  graph_.set_values(best_.values);
  const bool are_closures_out =
      std::any_of(best_.outliers.begin(), best_.outliers.end(), [&](EdgePlace place) {
        return !is_trusted(place) && graph_.batch(place.batch).vertices(place.edge).size() == 2;
      });
  if (!are_closures_out && !is_implausible(best_)) return false;
  return doubt_ways(best_);
}

// Doubts the trusted edges on those ways that the others contradict most: one edge of the worst way, as good as
// any other of it, because without several ways at once nothing contradicts any of them, and then all.
// @return there is a cheaper split now
bool Graduation::doubt_ways(const Verdict& verdict) {
  const std::vector<std::vector<EdgePlace>> ways = detail::by_way(graph_, trusted_, verdict.outliers);
  std::map<EdgePlace, std::size_t> way_of;  // by its first edge
  std::vector<EdgePlace> first;
  for (const std::vector<EdgePlace>& way : ways) {
    way_of[way.front()] = first.size();
    first.push_back(way.front());
  }
  std::vector<EdgePlace> accused;
  for (const auto& [gain, place] : accusations(first, verdict)) {
    const std::vector<EdgePlace>& way = ways[way_of[place]];
    if (accused.empty() && doubt_all(way, {place}, verdict)) return true;
    accused.insert(accused.end(), way.begin(), way.end());
  }
  std::sort(accused.begin(), accused.end());
  return doubt_all(accused, accused, verdict);
}

// Makes candidates of trusted edges if a split without some of them is cheaper. @return it is
bool Graduation::doubt_all(const std::vector<EdgePlace>& doubted, std::vector<EdgePlace> outliers,
                           const Verdict& verdict) {
  if (outliers.empty() || interrupted_) return false;
  const auto [trusted_before, candidates_before] = std::pair(trusted_, candidates_);
  move_to_candidates(doubted);
  outliers.insert(outliers.end(), verdict.outliers.begin(), verdict.outliers.end());
  std::sort(outliers.begin(), outliers.end());
  const double before = best_.cost;
  judge(std::move(outliers));
  graph_.set_values(best_.values);
  if (best_.cost < before) return true;
  trusted_ = trusted_before;
  candidates_ = candidates_before;
  return false;
}

// Lets the outliers that want the same return, and doubts the trusted edges that they accuse. Nothing else shows an
// edge that is wrong by so little that it costs less than its price once they are out.
// @return there is a cheaper split now
bool Graduation::doubt_for_agreeing() {
  const std::vector<EdgePlace> agreeing = agreeing_outliers();
  if (agreeing.empty() || interrupted_) return false;
  graph_.set_values(best_.values);
  const Verdict verdict = optimize_without(difference(best_.outliers, agreeing));
  return doubt_ways(verdict);
}

void Graduation::doubt() {
  for (int round = 0; round < kMaxDoubts && doubt_trusted(); ++round) {
    if (is_slow_ && !ends_badly(0))
      cross_examine();
    else
      search();
  }
}

// A wrong trusted edge shows only if the right closures over it are kept. They may be cheaper outside, as few
// places, than with a bent odometry inside; not where each of them counts.
void Graduation::doubt_best() {
  doubt();
  if (best_by_edges_.values.empty() || best_by_edges_.outliers == best_.outliers) return;
  apart([&] {
    best_ = std::move(best_by_edges_);
    best_.cost = std::numeric_limits<double>::infinity();
    doubt();
  });
}

// Tells whether the kept edges contradict each other, by chi2 of a split.
bool Graduation::is_implausible(const Verdict& verdict) const {
  std::int64_t freedom = -verdict.summary.unknowns;
  for (const EdgePlace place : trusted_) freedom += graph_.batch(place.batch).error_dimension(place.edge);
  for (const EdgePlace place : inside(verdict))
    freedom += graph_.batch(place.batch).error_dimension(place.edge);
  return freedom > 0 && chi_square_tail(verdict.summary.final_chi2, static_cast<int>(freedom)) <
                            1 - options_.inlier_probability;
}

// Returns those edges that others of them close by confirm, ascending.
std::vector<EdgePlace> Graduation::confirmed(std::span<const EdgePlace> edges) {
  std::vector<EdgePlace> result;
  for (const std::vector<EdgePlace>& group : wrong_places_->groups(graph_, edges))
    if (group.size() > 1) result.insert(result.end(), group.begin(), group.end());
  std::sort(result.begin(), result.end());
  return result;
}

// Makes some steps towards the minimum of all edges. With false ones there may be hundreds, and it is not needed.
Verdict Graduation::approach_all() {
  OptimizerOptions first = options_.optimizer;
  first.max_iterations = std::min(kFirstIterations, first.max_iterations);
  Verdict verdict;
  verdict.summary = count(optimize(graph_, algorithm_, solver_, first));
  return verdict;
}

// Tells whether the values of the graph, which are those of the verdict, fit all edges.
bool Graduation::is_clean(const Verdict& with_all) const {
  return !interrupted_ && beyond_bound().empty() && contradicted(trusted_).empty() &&
         !is_implausible(with_all);
}

// Tells whether many outliers of the best split, whose values the graph gets, come in groups. They may be right, and
// put out by a wrong group inside.
bool Graduation::are_outliers_grouped() {
  constexpr double kFewGrouped = 0.05;  // of the outliers
  graph_.set_values(best_.values);
  const auto grouped = static_cast<double>(confirmed(best_.outliers).size());
  return grouped > kFewGrouped * static_cast<double>(best_.outliers.size());
}

// Judges by the minimum of those candidates that others close by confirm. Single false closures are outside then,
// however many they are; those that come in groups are not, and put right ones out.
// @return this ends well; otherwise the values stay
bool Graduation::begin_with_confirmed() {
  constexpr double kFewOutside = 0.01;  // from here all edges may be reached
  const std::vector<double> start = graph_.values();
  const std::vector<EdgePlace> inside_first = confirmed(candidates_);
  if (inside_first.empty()) return false;
  judge(without_joining(difference(candidates_, inside_first)));
  const auto few = static_cast<std::size_t>(kFewOutside * static_cast<double>(candidates_.size()));
  if (!best_.values.empty() && !interrupted_ && !is_slow_ && best_.outliers.size() <= few) {
    graph_.set_values(best_.values);
    if (is_clean(approach_all())) {
      choose({});
      return true;
    }
  }
  cross_examine();
  const bool ends_well = !interrupted_ && !is_doubtful(0) && !are_outliers_grouped();
  graph_.set_values(ends_well ? best_.values : start);
  return ends_well;
}

GraduationResult Graduation::run() {
  const auto start = std::chrono::steady_clock::now();
  options_.check();
  find_candidates();
  weigh();
  // 1. Begin with the candidates that confirm each other.
  const bool begun = begin_with_confirmed();
  Verdict with_all;
  // 2. Use all edges. If none is beyond its bound, there are no outliers. With outliers this
  //    minimum may be far away; the next step need not start exactly from it.
  if (!dense_ && !begun) with_all = approach_all();
  const std::vector<double> of_all_edges = graph_.values();
  const bool hidden = !dense_ && !begun && beyond_bound().empty() && contradicted(trusted_).empty();
  const bool suspicious = begun ? !best_.outliers.empty() || !contradicted(trusted_).empty()
                                : !hidden || is_implausible(with_all);
  // 3. Grow a split from what is trusted. If that does not end well, narrow the loss, from the minimum of all edges
  //    and from that of the trusted ones.
  if (suspicious && !begun) {
    if (hidden) {
      judge({});
      cross_examine();
    }
    from_trusted([&](std::vector<EdgePlace> out) {
      std::optional<std::vector<EdgePlace>> grown = grown_from(std::move(out));
      if (!grown) return;
      judge(std::move(*grown));
      cross_examine();
    });
    if (ends_badly(0)) {
      graph_.set_values(of_all_edges);
      apart([&] { search(); });
    }
    if (ends_badly(kManyOutliers)) {
      from_trusted([&](std::vector<EdgePlace> out) {
        std::erase(judged_, out);  // its minimum is where this search begins
        judge(std::move(out));
        search();
      });
    }
  }
  if (best_.values.empty()) {
    if (!dense_) graph_.set_values(of_all_edges);
    choose(dense_ ? without_joining(candidates_) : std::vector<EdgePlace>{});
  }
  // 4. Doubt what was trusted: single edges, and all of them if they cost many of the others.
  if (suspicious && options_.doubts_trusted) {
    doubt_best();
    if (hidden) {
      apart([&] {
        graph_.set_values(of_all_edges);
        choose({});
        doubt();
      });
    }
    for (int round = 0; round < kMaxDoubts && doubt_for_agreeing(); ++round) doubt();
  }
  if (!interrupted_ && !dense_ && options_.doubts_trusted && suspicious && outliers_agree(kManyOutliers)) {
    graph_.set_values(of_all_edges);
    std::vector<EdgePlace> all = trusted_;
    std::erase_if(all, [&](EdgePlace place) {
      return graph_.edge_type(place.batch).arity == EdgeType::kRuntimeArity;  // many edges in one
    });
    move_to_candidates(all);
    apart([&] { search(); });
  }
  graph_.set_values(best_.values);
  for (const EdgePlace place : candidates_) {
    result_.weights[place.batch][place.edge] = options_.loss.at(squared_error(graph_, place)).weight;
  }
  result_.candidates = candidates_.size();
  result_.contradicted = contradicted(kept_and_trusted());
  result_.unconfirmed = unconfirmed();
  result_.outliers = std::move(best_.outliers);
  std::copy_if(result_.outliers.begin(), result_.outliers.end(), std::back_inserter(result_.distrusted),
               [&](EdgePlace place) { return is_trusted(place); });
  result_.summary = std::move(best_.summary);
  if (interrupted_) {
    result_.summary.termination = Termination::interrupted;
    result_.summary.message = "interrupted while looking for outliers";
  }
  result_.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return std::move(result_);
}

}  // namespace

GraduationResult graduate(Graph& graph, Algorithm& algorithm, LinearSolver& solver,
                          const GraduationOptions& options) {
  return Graduation(graph, algorithm, solver, options).run();
}

}  // namespace waymark
