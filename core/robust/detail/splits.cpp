#include <algorithm>
#include <functional>
#include <iterator>

#include <waymark/core/base/detail/median.hpp>
#include <waymark/core/base/error.hpp>
#include <waymark/core/robust/chi_square.hpp>
#include <waymark/core/robust/detail/moved_errors.hpp>
#include <waymark/core/robust/detail/splits.hpp>
#include <waymark/core/robust/joining_edges.hpp>

namespace waymark::detail {

std::vector<EdgePlace> difference(const std::vector<EdgePlace>& edges, const std::vector<EdgePlace>& others) {
  std::vector<EdgePlace> result;
  std::set_difference(edges.begin(), edges.end(), others.begin(), others.end(), std::back_inserter(result));
  return result;
}

std::vector<EdgePlace> united(const std::vector<EdgePlace>& edges, const std::vector<EdgePlace>& others) {
  std::vector<EdgePlace> result;
  std::set_union(edges.begin(), edges.end(), others.begin(), others.end(), std::back_inserter(result));
  return result;
}

Splits::Splits(Graph& graph, Algorithm& algorithm, LinearSolver& solver, const GraduationOptions& options)
    : graph_(graph),
      algorithm_(algorithm),
      solver_(solver),
      options_(options),
      of_rule_(options.trusted(graph)) {
  for (std::size_t b = 0; b < graph_.batch_count(); ++b) {
    for (std::size_t e = 0; e < graph_.batch(b).size(); ++e) {
      (is_trusted({b, e}) ? roles_.trusted : roles_.candidates).push_back({b, e});
      const auto [bound, is_new] = bounds_.try_emplace(graph_.batch(b).error_dimension(e));
      if (is_new) bound->second = chi_square_quantile(options_.inlier_probability, bound->first);
    }
  }
  wrong_places_.emplace(graph_, roles_.trusted, algorithm_, solver_,
                        [this](EdgePlace place) { return bound(place); });
}

bool Splits::is_trusted(EdgePlace place) const {
  return std::binary_search(of_rule_.begin(), of_rule_.end(), place);
}

void Splits::move_to_candidates(const std::vector<EdgePlace>& edges) {
  roles_.trusted = difference(roles_.trusted, edges);
  roles_.candidates = united(roles_.candidates, edges);
}

double Splits::bound(EdgePlace place) const {
  return bounds_.at(graph_.batch(place.batch).error_dimension(place.edge));
}

// What an edge costs outside. A trusted edge costs more: a false closure that only joins a tail of the graph and each
// edge of this tail explain the contradiction alike.
double Splits::price(EdgePlace place) const {
  constexpr double kOfTrusted = 2;
  return (is_trusted(place) ? kOfTrusted : 1.0) * bound(place);
}

// A trusted edge is against whole places, not against each of their closures.
double Splits::cost(const Verdict& verdict) {
  std::vector<EdgePlace> outliers = verdict.outliers;
  const auto closures = std::stable_partition(outliers.begin(), outliers.end(),
                                              [&](EdgePlace place) { return is_trusted(place); });
  double result = verdict.summary.final_chi2;
  for (auto place = outliers.begin(); place != closures; ++place) result += price(*place);
  return result + wrong_places_->price(graph_, std::span(closures, outliers.end()));
}

double Splits::cost_by_edges(const Verdict& verdict) const {
  double result = verdict.summary.final_chi2;
  for (const EdgePlace place : verdict.outliers) result += price(place);
  return result;
}

std::vector<EdgePlace> Splits::beyond_bound(std::span<const EdgePlace> edges) const {
  std::vector<EdgePlace> result;
  for (const EdgePlace place : edges) {
    if (!(squared_error(graph_, place) <= bound(place))) result.push_back(place);
  }
  return result;
}

std::vector<EdgePlace> Splits::inside(const Verdict& verdict) const {
  return difference(roles_.candidates, verdict.outliers);
}

bool Splits::is_implausible(const Verdict& verdict) const {
  std::int64_t freedom = -verdict.summary.unknowns;
  for (const EdgePlace place : roles_.trusted)
    freedom += graph_.batch(place.batch).error_dimension(place.edge);
  for (const EdgePlace place : inside(verdict))
    freedom += graph_.batch(place.batch).error_dimension(place.edge);
  return freedom > 0 && chi_square_tail(verdict.summary.final_chi2, static_cast<int>(freedom)) <
                            1 - options_.inlier_probability;
}

std::vector<EdgePlace> Splits::confirmed(std::span<const EdgePlace> edges) {
  std::vector<EdgePlace> result;
  for (const std::vector<EdgePlace>& group : wrong_places_->groups(graph_, edges))
    if (group.size() > 1) result.insert(result.end(), group.begin(), group.end());
  std::sort(result.begin(), result.end());
  return result;
}

std::vector<EdgePlace> Splits::agreeing_outliers() const {
  Graph at_best = graph_;
  at_best.set_values(best_.values);
  const double wide = 4 * chi_square_quantile(options_.inlier_probability, 3);
  const std::size_t by_chance = most_by_chance(at_best, best_.outliers, wide);
  std::vector<EdgePlace> most = most_that_agree(std::move(at_best), best_.outliers, wide);
  constexpr std::size_t kFew = 3;  // that may agree whatever they are
  const bool is_chance = most.size() <= by_chance || most.size() < kFew;
  if (is_chance) most.clear();
  return most;
}

Verdict Splits::optimize_without(std::vector<EdgePlace> outliers) {
  Verdict verdict;
  Graph kept = without_edges(graph_, outliers);
  verdict.summary = optimized(kept, options_.optimizer);
  ++passes_;
  graph_.set_values(kept.values());
  verdict.values = kept.values();
  verdict.outliers = std::move(outliers);
  return verdict;
}

void Splits::choose(std::vector<EdgePlace> outliers) {
  best_ = optimize_without(std::move(outliers));
  best_.cost = cost(best_);
}

// Returns the edges without which a split falls apart, although nothing contradicts them; trusted ones are preferred.
std::vector<EdgePlace> Splits::joining(std::span<const EdgePlace> outside, const Graph& kept) const {
  std::vector<EdgePlace> edges(outside.begin(), outside.end());
  std::stable_partition(edges.begin(), edges.end(), [&](EdgePlace place) { return is_trusted(place); });
  std::vector<EdgePlace> result = joining_edges(graph_, edges, kept);
  std::sort(result.begin(), result.end());
  return result;
}

std::vector<EdgePlace> Splits::without_joining(const std::vector<EdgePlace>& outside) const {
  return difference(outside, joining(outside, without_edges(graph_, outside)));
}

// Returns the edges that are outside after this minimum. Edges inside that exceed the bound go out.
// Edges outside whose innovation is within the bound come in, each of them once; the other ones would raise the
// minimum by more than they cost outside. Those that join what falls apart raise nothing, and come in whenever they do.
std::vector<EdgePlace> Splits::still_out(const Verdict& verdict, std::vector<EdgePlace>& returned) const {
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
  return united(out, beyond_bound(inside(verdict)));
}

std::vector<std::pair<double, EdgePlace>> Splits::accusations(std::span<const EdgePlace> members,
                                                              const Verdict& verdict) const {
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

std::vector<EdgePlace> Splits::most_accused(std::span<const EdgePlace> members,
                                            const Verdict& verdict) const {
  std::vector<EdgePlace> result;
  for (const auto& [gain, place] : accusations(members, verdict)) result.push_back(place);
  std::sort(result.begin(), result.end());
  return result;
}

void Splits::judge(std::vector<EdgePlace> outliers) {
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
void Splits::return_singly() {
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

void Splits::cross_examine() {
  constexpr int kMaxTurns = 5;
  return_singly();
  for (int turn = 0; turn < kMaxTurns && put_out_accused(); ++turn) return_singly();
}

bool Splits::put_out_accused() {
  constexpr int kMaxRounds = 20;
  for (int round = 0; round < kMaxRounds; ++round) {
    if (interrupted_ || best_.values.empty()) return round > 0;
    graph_.set_values(best_.values);
    const std::vector<EdgePlace> accused = most_accused(inside(best_), best_);
    if (accused.empty()) return round > 0;
    const double before = best_.cost;
    judge(united(accused, best_.outliers));
    if (!(best_.cost < before)) return round > 0;
  }
  return true;
}

std::vector<EdgePlace> Splits::contradicted(std::span<const EdgePlace> trusted) const {
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

Summary Splits::optimized(Graph& graph, const OptimizerOptions& how) {
  Summary summary = optimize(graph, algorithm_, solver_, how);
  iterations_ += summary.iterations;
  interrupted_ = interrupted_ || summary.termination == Termination::interrupted;
  return summary;
}

void Splits::consider(Verdict verdict) {
  if (verdict.values.empty()) return;
  graph_.set_values(verdict.values);
  verdict.cost = cost(verdict);
  if (verdict.cost < best_.cost) best_ = std::move(verdict);
}

void Splits::take_best_by_edges() {
  best_ = std::move(best_by_edges_);
  best_.cost = std::numeric_limits<double>::infinity();
}

}  // namespace waymark::detail
