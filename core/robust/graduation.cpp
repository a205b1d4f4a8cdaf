#include <algorithm>
#include <chrono>
#include <iterator>
#include <optional>
#include <utility>

#include <waymark/core/linear/block_symbolic.hpp>
#include <waymark/core/robust/detail/consistent_edges.hpp>
#include <waymark/core/robust/detail/doubts.hpp>
#include <waymark/core/robust/detail/growth.hpp>
#include <waymark/core/robust/detail/narrowing.hpp>
#include <waymark/core/robust/detail/splits.hpp>
#include <waymark/core/robust/graduation.hpp>
#include <waymark/core/system/gauge.hpp>
#include <waymark/core/system/structure.hpp>

namespace waymark {
namespace {

using detail::Splits;
using detail::Verdict;

/// Steps towards the minimum of all edges.
constexpr int kFirstIterations = 50;
/// Times that trusted edges are doubted, and the search is repeated without them.
constexpr int kMaxDoubts = 10;
/// If more than this share of the candidates are outliers, they may be right, and a trusted edge wrong.
constexpr double kManyOutliers = 0.2;
constexpr double kFewOutliers = 3;  // so few say nothing about the others

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

class Graduation {
 public:
  Graduation(Graph& graph, Algorithm& algorithm, LinearSolver& solver, const GraduationOptions& options)
      : graph_(graph), options_(options), splits_(graph, algorithm, solver, options) {
    result_.trusted = splits_.roles().trusted.size();
    result_.candidates = splits_.roles().candidates.size();
    if (!options.doubts_trusted) return;
    parallels_ = contradicting_parallels(graph, splits_.roles().trusted, algorithm, solver,
                                         options.inlier_probability);
    for (const std::vector<EdgePlace>& group : parallels_) splits_.move_to_candidates(group);
  }

  GraduationResult run();

 private:
  void weigh();
  bool begin_with_confirmed();
  bool are_outliers_grouped();
  void grow();
  void search();
  bool is_confirmed();
  void try_consistent();
  template <typename Search>
  void from_trusted(Search search);
  bool is_doubtful(double share) const;
  bool ends_badly(double share) const;
  bool outliers_agree(double share) const;
  void doubt();
  void doubt_best();
  void trust_nothing();
  void tell();

  Graph& graph_;
  const GraduationOptions& options_;
  Splits splits_;
  std::vector<std::vector<EdgePlace>> parallels_;  // groups of candidates that would be trusted alone
  std::vector<double> of_all_edges_;               // the values of their minimum, or near it
  bool is_slow_ = false;                           // a step with all edges takes a part of a second
  bool dense_ = false;                             // and so many seconds that none is done
  bool hidden_ = false;  // no error is large at the minimum of all edges, which may still be wrong
  GraduationResult result_;
};

// Tells how much all edges fill the factor. False closures do, because they join places anywhere; right ones on
// 200,000 street corners would not.
void Graduation::weigh() {
  constexpr double kSeconds = 1e9;  // operations: the hundreds of steps of narrowing would take minutes
  constexpr double kManySeconds = 1e11;
  const double operations = factorization_operations(graph_);
  is_slow_ = operations > kSeconds;
  dense_ = operations >= kManySeconds &&
           may_be_grown(splits_, without_edges(graph_, splits_.without_joining(splits_.roles().candidates)));
}

// Tells whether another search may find better. @param share of the candidates that may be outside
bool Graduation::is_doubtful(double share) const {
  return splits_.best().values.empty() || splits_.is_implausible(splits_.best()) || outliers_agree(share);
}

// Tells the same of a search with all edges.
bool Graduation::ends_badly(double share) const {
  return !splits_.interrupted() && !dense_ && is_doubtful(share);
}

// Tells whether more than a share of the candidates are outside, and some of them want the same: these may be right,
// and what contradicts them wrong.
bool Graduation::outliers_agree(double share) const {
  const std::vector<EdgePlace>& outliers = splits_.best().outliers;
  const double many = share * static_cast<double>(splits_.roles().candidates.size());
  if (static_cast<double>(outliers.size()) <= std::max(kFewOutliers, many)) return false;
  const bool are_pairs = std::all_of(outliers.begin(), outliers.end(), [&](EdgePlace place) {
    return graph_.batch(place.batch).vertices(place.edge).size() == 2;
  });
  if (!are_pairs) return true;  // what they want is not compared
  return !splits_.agreeing_outliers().empty();
}

// Makes some steps towards the minimum of all edges. With false ones there may be hundreds, and it is not needed.
Verdict approach_all(Splits& splits) {
  OptimizerOptions first = splits.options().optimizer;
  first.max_iterations = std::min(kFirstIterations, first.max_iterations);
  Verdict verdict;
  verdict.summary = splits.optimized(splits.graph(), first);
  return verdict;
}

bool no_error_is_large(const Splits& splits) {
  return splits.beyond_bound(splits.roles().candidates).empty() &&
         splits.contradicted(splits.roles().trusted).empty();
}

// Tells whether many outliers of the best split, whose values the graph gets, come in groups. They may be right, and
// put out by a wrong group inside.
bool Graduation::are_outliers_grouped() {
  constexpr double kFewGrouped = 0.05;  // of the outliers
  const std::vector<EdgePlace>& outliers = splits_.best().outliers;
  graph_.set_values(splits_.best().values);
  const auto grouped = static_cast<double>(splits_.confirmed(outliers).size());
  return grouped > kFewGrouped * static_cast<double>(outliers.size());
}

// Judges by the minimum of those candidates that others close by confirm. Single false closures are outside then,
// however many they are; those that come in groups are not, and put right ones out.
// @return this ends well; otherwise the values stay
bool Graduation::begin_with_confirmed() {
  constexpr double kFewOutside = 0.01;  // from here all edges may be reached
  const std::vector<double> start = graph_.values();
  const std::vector<EdgePlace>& candidates = splits_.roles().candidates;
  const std::vector<EdgePlace> inside_first = splits_.confirmed(candidates);
  if (inside_first.empty()) return false;
  splits_.judge(splits_.without_joining(detail::difference(candidates, inside_first)));
  const auto few = static_cast<std::size_t>(kFewOutside * static_cast<double>(candidates.size()));
  const Verdict& best = splits_.best();
  if (!best.values.empty() && !splits_.interrupted() && !is_slow_ && best.outliers.size() <= few) {
    graph_.set_values(best.values);
    const Verdict with_all = approach_all(splits_);
    if (!splits_.interrupted() && no_error_is_large(splits_) && !splits_.is_implausible(with_all)) {
      splits_.choose({});
      return true;
    }
  }
  splits_.cross_examine();
  const bool ends_well = !splits_.interrupted() && !is_doubtful(0) && !are_outliers_grouped();
  graph_.set_values(ends_well ? best.values : start);
  return ends_well;
}

// Calls a search with all candidates outside, but one edge of each group of parallel ones: the first one, then
// the last.
template <typename Search>
void Graduation::from_trusted(Search search) {
  for (const bool first : {true, false}) {
    std::vector<EdgePlace> out = splits_.roles().candidates;
    for (const std::vector<EdgePlace>& group : parallels_)
      std::erase(out, first ? group.front() : group.back());
    splits_.apart([&] { search(std::move(out)); });
    if (parallels_.empty()) return;
  }
}

// Narrows the loss from the present values of the graph. The cheapest split on the way counts.
void Graduation::search() {
  if (!dense_) result_.rounds += narrow(splits_);
  splits_.cross_examine();
}

// Grows a split from what is trusted. If that does not end well, narrows the loss, from the minimum of all edges and
// from that of the trusted ones.
void Graduation::grow() {
  if (hidden_) {
    splits_.judge({});
    splits_.cross_examine();
  }
  from_trusted([&](std::vector<EdgePlace> out) {
    std::optional<std::vector<EdgePlace>> grown = grown_from(splits_, std::move(out));
    if (!grown) return;
    splits_.judge(std::move(*grown));
    splits_.cross_examine();
  });
  if (ends_badly(0)) {
    graph_.set_values(of_all_edges_);
    splits_.apart([&] { search(); });
  }
  if (ends_badly(kManyOutliers)) {
    from_trusted([&](std::vector<EdgePlace> out) {
      splits_.forget(out);  // its minimum is where this search begins
      splits_.judge(std::move(out));
      search();
    });
  }
}

// Tells whether most of what is kept is confirmed by others close by. The graph gets the values of the best split.
bool Graduation::is_confirmed() {
  if (splits_.best().values.empty()) return false;
  graph_.set_values(splits_.best().values);
  const std::vector<EdgePlace> kept = splits_.inside(splits_.best());
  return 2 * splits_.confirmed(kept).size() > kept.size();
}

// Begins with the largest sets of candidates that are consistent with each other. Among few right ones, far from each
// other, no single edge leads from a split that has some false ones inside to the one without. Where others close by
// confirm them, they are found without, and a set that is consistent by chance may leave out a whole group of them,
// which costs little more than one.
void Graduation::try_consistent() {
  constexpr double kFew = 5e5;  // candidates times vertices: each of them takes a minimum
  const auto candidates = static_cast<double>(splits_.roles().candidates.size());
  if (candidates * static_cast<double>(graph_.vertex_count()) > kFew || splits_.interrupted()) return;
  if (is_confirmed()) return;
  for (const std::vector<EdgePlace>& consistent : consistent_edges(splits_)) {
    splits_.apart([&] {
      splits_.judge(detail::difference(splits_.roles().candidates, consistent));
      splits_.cross_examine();
    });
  }
}

void Graduation::doubt() {
  for (int round = 0; round < kMaxDoubts && doubt_trusted(splits_); ++round) {
    if (is_slow_ && !ends_badly(0))
      splits_.cross_examine();
    else
      search();
  }
}

// Doubts single trusted edges. A wrong one shows only if the right closures over it are kept. They may be cheaper
// outside, as few places, than with a bent odometry inside; not where each of them counts.
void Graduation::doubt_best() {
  doubt();
  const Verdict& by_edges = splits_.best_by_edges();
  if (!by_edges.values.empty() && by_edges.outliers != splits_.best().outliers) {
    splits_.apart([&] {
      splits_.take_best_by_edges();
      doubt();
    });
  }
  if (hidden_) {
    splits_.apart([&] {
      graph_.set_values(of_all_edges_);
      splits_.choose({});
      doubt();
    });
  }
  for (int round = 0; round < kMaxDoubts && doubt_for_agreeing(splits_); ++round) doubt();
}

// Searches with every edge of few vertices as a candidate.
void Graduation::trust_nothing() {
  graph_.set_values(of_all_edges_);
  std::vector<EdgePlace> all = splits_.roles().trusted;
  std::erase_if(all, [&](EdgePlace place) {
    return graph_.edge_type(place.batch).arity == EdgeType::kRuntimeArity;  // many edges in one
  });
  splits_.move_to_candidates(all);
  splits_.apart([&] { search(); });
}

// Fills the result from the best split, whose values the graph gets.
void Graduation::tell() {
  graph_.set_values(splits_.best().values);
  for (std::size_t b = 0; b < graph_.batch_count(); ++b)
    result_.weights.emplace_back(graph_.batch(b).size(), 1.0);
  for (const EdgePlace place : splits_.roles().candidates) {
    result_.weights[place.batch][place.edge] = options_.loss.at(squared_error(graph_, place)).weight;
  }
  result_.candidates = splits_.roles().candidates.size();
  result_.contradicted = contradicted_inside(splits_);
  result_.unconfirmed = unconfirmed(splits_);
  result_.outliers = splits_.best().outliers;
  std::copy_if(result_.outliers.begin(), result_.outliers.end(), std::back_inserter(result_.distrusted),
               [&](EdgePlace place) { return splits_.is_trusted(place); });
  result_.summary = splits_.best().summary;
  result_.passes = splits_.passes();
  result_.iterations = splits_.iterations();
  if (splits_.interrupted()) {
    result_.summary.termination = Termination::interrupted;
    result_.summary.message = "interrupted while looking for outliers";
  }
}

GraduationResult Graduation::run() {
  const auto start = std::chrono::steady_clock::now();
  weigh();
  // 1. Begin with the candidates that confirm each other.
  const bool begun = begin_with_confirmed();
  Verdict with_all;
  // 2. Use all edges. If none is beyond its bound, there are no outliers. With outliers this
  //    minimum may be far away; the next step need not start exactly from it.
  if (!dense_ && !begun) with_all = approach_all(splits_);
  of_all_edges_ = graph_.values();
  hidden_ = !dense_ && !begun && no_error_is_large(splits_);
  const bool suspicious =
      begun ? !splits_.best().outliers.empty() || !splits_.contradicted(splits_.roles().trusted).empty()
            : !hidden_ || splits_.is_implausible(with_all);
  // 3. Search for a split.
  if (suspicious && !begun) grow();
  if (splits_.best().values.empty()) {
    if (!dense_) graph_.set_values(of_all_edges_);
    splits_.choose(dense_ ? splits_.without_joining(splits_.roles().candidates) : std::vector<EdgePlace>{});
  }
  if (suspicious) try_consistent();
  // 4. Doubt what was trusted: single edges, and all of them if they cost many of the others.
  if (suspicious && options_.doubts_trusted) doubt_best();
  if (!splits_.interrupted() && !dense_ && options_.doubts_trusted && suspicious &&
      outliers_agree(kManyOutliers))
    trust_nothing();
  tell();
  result_.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return std::move(result_);
}

}  // namespace

GraduationResult graduate(Graph& graph, Algorithm& algorithm, LinearSolver& solver,
                          const GraduationOptions& options) {
  options.check();
  return Graduation(graph, algorithm, solver, options).run();
}

}  // namespace waymark
