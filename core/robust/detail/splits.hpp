/// Splits of the edges into kept ones and outliers: what a split costs, and the search edge by edge.
#pragma once

#include <limits>
#include <map>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include <waymark/core/graph/graph.hpp>
#include <waymark/core/optimize/optimizer.hpp>
#include <waymark/core/robust/detail/wrong_places.hpp>
#include <waymark/core/robust/edge_selection.hpp>
#include <waymark/core/robust/graduation.hpp>

namespace waymark::detail {

/// A split of the edges, and its minimum.
struct Verdict {
  std::vector<EdgePlace> outliers;  ///< ascending
  std::vector<double> values;       ///< empty: there is none
  Summary summary;
  double cost = std::numeric_limits<double>::infinity();  ///< chi2 of the kept edges + price of the outliers
};

/// Which edges may be outliers; both lists are ascending.
struct EdgeRoles {
  std::vector<EdgePlace> candidates;
  std::vector<EdgePlace> trusted;  ///< the other ones
};

/// Returns the edges that are not among others; both lists are ascending, and so is the result.
[[nodiscard]] std::vector<EdgePlace> difference(const std::vector<EdgePlace>& edges,
                                                const std::vector<EdgePlace>& others);
/// Returns the edges of both; both lists are ascending, and so is the result.
[[nodiscard]] std::vector<EdgePlace> united(const std::vector<EdgePlace>& edges,
                                            const std::vector<EdgePlace>& others);

/// The splits of a graph, and the cheapest one of those that were tried.
///
/// Every minimum of a split is left in the values of the graph, from which the next one begins. The graph, the
/// algorithm, the solver and the options must live longer.
class Splits {
 public:
  Splits(Graph& graph, Algorithm& algorithm, LinearSolver& solver, const GraduationOptions& options);

  // Edges and their roles.

  [[nodiscard]] Graph& graph() { return graph_; }
  [[nodiscard]] const Graph& graph() const { return graph_; }
  [[nodiscard]] const GraduationOptions& options() const { return options_; }
  [[nodiscard]] const EdgeRoles& roles() const { return roles_; }
  void set_roles(EdgeRoles roles) { roles_ = std::move(roles); }
  void move_to_candidates(const std::vector<EdgePlace>& edges);
  /// Tells whether the rule trusts an edge, doubted or not.
  [[nodiscard]] bool is_trusted(EdgePlace place) const;
  /// Returns what the squared error of an edge inside may be.
  [[nodiscard]] double bound(EdgePlace place) const;

  // What the values of the graph say.

  /// Returns those of some edges whose error is beyond their bound.
  [[nodiscard]] std::vector<EdgePlace> beyond_bound(std::span<const EdgePlace> edges) const;
  /// Returns those of some trusted edges whose error is beyond their bound. Stated noise is often smaller than the
  /// true one; the median of their errors tells by how much.
  [[nodiscard]] std::vector<EdgePlace> contradicted(std::span<const EdgePlace> trusted) const;
  /// Returns those edges that others of them close by confirm, ascending.
  [[nodiscard]] std::vector<EdgePlace> confirmed(std::span<const EdgePlace> edges);

  // One split.

  /// Returns the candidates that it keeps.
  [[nodiscard]] std::vector<EdgePlace> inside(const Verdict& verdict) const;
  /// Tells whether the kept edges contradict each other, by chi2.
  [[nodiscard]] bool is_implausible(const Verdict& verdict) const;
  /// @param verdict whose values are those of the graph
  [[nodiscard]] double cost(const Verdict& verdict);
  /// Returns what it would cost if every edge of a group counted.
  [[nodiscard]] double cost_by_edges(const Verdict& verdict) const;
  /// Returns the outliers but those without which the rest falls apart, although nothing contradicts them.
  [[nodiscard]] std::vector<EdgePlace> without_joining(const std::vector<EdgePlace>& outside) const;
  /// Returns those of some edges inside that all others contradict: without such an edge the minimum would fall by
  /// more than it costs outside. A false edge makes good neighbours look bad, so only those close to the worst are
  /// returned: the worst first, with what the minimum would fall by.
  [[nodiscard]] std::vector<std::pair<double, EdgePlace>> accusations(std::span<const EdgePlace> edges,
                                                                      const Verdict& verdict) const;
  /// Returns the same edges, ascending.
  [[nodiscard]] std::vector<EdgePlace> most_accused(std::span<const EdgePlace> edges,
                                                    const Verdict& verdict) const;

  // Trying splits.

  /// Optimises any graph by the algorithm, and counts its iterations.
  Summary optimized(Graph& graph, const OptimizerOptions& how);
  /// Returns a split without its cost. @throws InputError if the remaining edges determine no solution
  [[nodiscard]] Verdict optimize_without(std::vector<EdgePlace> outliers);
  /// Makes a split the best one, whatever it costs.
  void choose(std::vector<EdgePlace> outliers);
  /// Makes a split the best one if it is cheaper; the graph gets its values.
  void consider(Verdict verdict);
  /// Improves a first split until no single edge makes it cheaper by leaving or returning. A first split that was
  /// judged before is not judged again.
  void judge(std::vector<EdgePlace> outliers);
  /// Lets a first split be judged again.
  void forget(const std::vector<EdgePlace>& outliers) { std::erase(judged_, outliers); }
  /// Improves the best split by edges that return one at a time, and by those that bend the rest without a large
  /// error of their own. It takes an innovation per candidate.
  void cross_examine();
  /// Calls a search that improves the best split of its own, even if another search has found a cheaper one that may
  /// be improved no more.
  template <typename Search>
  void apart(Search search) {
    Verdict others = std::exchange(best_, {});
    search();
    if (!(best_.cost < others.cost)) best_ = std::move(others);
  }
  /// Makes the cheapest split by edges the best one; anything is cheaper.
  void take_best_by_edges();

  // What was found.

  [[nodiscard]] const Verdict& best() const { return best_; }
  /// The cheapest one if every edge of a group counted.
  [[nodiscard]] const Verdict& best_by_edges() const { return best_by_edges_; }
  /// Returns the most outliers of the best split that want the same. None: no more than may by chance.
  [[nodiscard]] std::vector<EdgePlace> agreeing_outliers() const;
  [[nodiscard]] bool interrupted() const { return interrupted_; }
  [[nodiscard]] int iterations() const { return iterations_; }
  [[nodiscard]] int passes() const { return passes_; }  ///< minima of splits

 private:
  [[nodiscard]] double price(EdgePlace place) const;
  [[nodiscard]] std::vector<EdgePlace> joining(std::span<const EdgePlace> outside, const Graph& kept) const;
  [[nodiscard]] std::vector<EdgePlace> still_out(const Verdict& verdict,
                                                 std::vector<EdgePlace>& returned) const;
  void return_singly();
  bool put_out_accused();  // and returns whether it improved the best split

  Graph& graph_;  // with its own losses, and the values of the last verdict
  Algorithm& algorithm_;
  LinearSolver& solver_;
  const GraduationOptions& options_;
  std::map<int, double> bounds_;    // of squared errors, by dimension
  std::vector<EdgePlace> of_rule_;  // what the rule trusts, doubted or not
  EdgeRoles roles_;
  std::optional<WrongPlaces> wrong_places_;
  std::vector<std::vector<EdgePlace>> judged_;  // splits whose minimum is known
  Verdict best_;
  Verdict best_by_edges_;
  bool interrupted_ = false;
  int iterations_ = 0;
  int passes_ = 0;
};

}  // namespace waymark::detail
