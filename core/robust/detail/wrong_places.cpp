#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <optional>
#include <set>
#include <utility>

#include <waymark/core/base/detail/index.hpp>
#include <waymark/core/base/error.hpp>
#include <waymark/core/robust/detail/id_order.hpp>
#include <waymark/core/robust/detail/moved_errors.hpp>
#include <waymark/core/robust/detail/wrong_places.hpp>
#include <waymark/core/system/detail/components.hpp>
#include <waymark/core/system/detail/finite_motion.hpp>

namespace waymark::detail {
namespace {

/// Ends of two closures in a row are at most so many poses apart, and so are those of an edge of odometry: two
/// drives whose ids are interleaved have every second one.
constexpr std::int64_t kGap = 2;
/// Probability that a false closure is followed by another one of the same mistake.
constexpr double kGoesOn = 0.7;

/// An edge between two places of a drive.
struct Closure {
  std::int64_t earlier;  // places of its ends in the order of ids
  std::int64_t later;
  VertexIndex moved;  // the later one
  EdgePlace place;
};

/// @param order place of each vertex
Closure closure_of(const Graph& graph, std::span<const std::int64_t> order, EdgePlace place) {
  const std::span<const VertexIndex> ends = graph.batch(place.batch).vertices(place.edge);
  const std::int64_t first = order[at(ends[0])];
  const std::int64_t second = order[at(ends[1])];
  if (first < second) return {first, second, ends[1], place};
  return {second, first, ends[0], place};
}

std::optional<FiniteMotion> motion_wanted_by(const Closure& closure, Graph& graph) {
  return motion_to_agree(graph.batch(closure.place.batch), closure.place.edge, graph,
                         std::array{closure.moved});
}

double squared_error_at(const FiniteMotion& motion, const Closure& closure, Graph& graph) {
  return squared_error_after(graph.batch(closure.place.batch), closure.place.edge, graph,
                             std::array{closure.moved}, motion);
}

bool is_pair(const Graph& graph, EdgePlace place) {
  return graph.batch(place.batch).vertices(place.edge).size() == 2;
}

std::vector<EdgePlace> pairs_of(const Graph& graph, std::span<const EdgePlace> edges) {
  std::vector<EdgePlace> result;
  for (const EdgePlace place : edges)
    if (is_pair(graph, place)) result.push_back(place);
  return result;
}

/// Closures in the order of their earlier ends, of which groups are taken out.
class Closures {
 public:
  Closures(const Graph& graph, std::span<const std::int64_t> order, std::span<const EdgePlace> edges) {
    for (const EdgePlace place : edges) closures_.push_back(closure_of(graph, order, place));
    std::sort(closures_.begin(), closures_.end(), [](const Closure& a, const Closure& b) {
      return std::pair(a.earlier, a.later) < std::pair(b.earlier, b.later);
    });
    taken_.assign(closures_.size(), 0);
  }

  /// Returns the edges that see the same wrong place as the first one that is left, ascending.
  /// None: no edge is left.
  /// @param agree tells whether two neighbours see the same
  template <typename Agree>
  std::vector<EdgePlace> take_group(Agree agree) {
    while (first_ < closures_.size() && taken_[first_] != 0) ++first_;
    std::vector<EdgePlace> result;
    if (first_ == closures_.size()) return result;
    std::vector<std::size_t> members{first_};
    taken_[first_] = 1;
    for (std::size_t next = 0; next < members.size(); ++next) {
      const Closure& member = closures_[members[next]];
      result.push_back(member.place);
      for (const std::size_t other : neighbours(member)) {
        if (!agree(member, closures_[other])) continue;
        taken_[other] = 1;
        members.push_back(other);
      }
    }
    std::sort(result.begin(), result.end());
    return result;
  }

 private:
  /// Returns the closures beside one that are not taken.
  [[nodiscard]] std::vector<std::size_t> neighbours(const Closure& of) const {
    std::vector<std::size_t> result;
    const auto first = std::partition_point(closures_.begin(), closures_.end(), [&](const Closure& other) {
      return other.earlier < of.earlier - kGap;
    });
    for (auto other = first; other != closures_.end() && other->earlier <= of.earlier + kGap; ++other) {
      const auto index = static_cast<std::size_t>(other - closures_.begin());
      if (taken_[index] == 0 && std::abs(other->later - of.later) <= kGap) result.push_back(index);
    }
    return result;
  }

  std::vector<Closure> closures_;
  std::vector<char> taken_;
  std::size_t first_ = 0;  // all before it are taken
};

/// A graph of a group of closures and of the two ways that they join. A vertex on both ways is there twice.
class TwoWays {
 public:
  void add_closure(const Graph& from, const Closure& closure) {
    add(from, closure.place, [&](VertexIndex v) { return v == closure.moved; });
    moved_.push_back(copies_.at({true, closure.moved}));
  }

  void add_odometry(const Graph& from, EdgePlace place, bool later) {
    add(from, place, [&](VertexIndex) { return later; });
  }

  /// Moves the later way to where the first closure wants it.
  void bring_together() {
    const std::optional<FiniteMotion> motion =
        motion_to_agree(graph_.batch(0), 0, graph_, std::array{moved_.front()});
    if (!motion) return;
    for (const auto& [of, copy] : copies_)
      if (of.first) move(graph_, copy, *motion);
  }

  /// Tells whether the ways join all closures. Others would be compared with nothing.
  [[nodiscard]] bool is_whole() const {
    const std::vector<std::int32_t> component = find_components(graph_);
    return std::all_of(moved_.begin(), moved_.end(),
                       [&](VertexIndex v) { return component[at(v)] == component[at(moved_.front())]; });
  }

  [[nodiscard]] Graph& graph() { return graph_; }

 private:
  template <typename IsLater>
  void add(const Graph& from, EdgePlace place, IsLater is_later) {
    const EdgeBatchBase& batch = from.batch(place.batch);
    std::vector<VertexIndex> vertices;
    for (const VertexIndex v : batch.vertices(place.edge)) {
      const auto [copy, is_new] = copies_.try_emplace({is_later(v), v}, 0);
      const VertexId id{static_cast<std::int64_t>(copies_.size())};
      if (is_new) copy->second = graph_.add_vertex(from.vertex_type(v), id, from.value(v));
      vertices.push_back(copy->second);
    }
    std::vector<double> fields;
    batch.fields(place.edge, fields);
    graph_.add_edge(from.edge_type(place.batch), vertices, fields, batch.information(place.edge));
  }

  Graph graph_;
  std::map<std::pair<bool, VertexIndex>, VertexIndex> copies_;  // of those of the earlier and the later way
  std::vector<VertexIndex> moved_;                              // later ends of the closures
};

}  // namespace

WrongPlaces::WrongPlaces(const Graph& graph, std::span<const EdgePlace> odometry, Algorithm& algorithm,
                         LinearSolver& solver, std::function<double(EdgePlace)> price)
    : algorithm_(algorithm), solver_(solver), price_(std::move(price)), order_(places_by_id(graph)) {
  for (const EdgePlace place : odometry) {
    if (!is_pair(graph, place)) continue;
    const Closure ends = closure_of(graph, order_, place);
    if (ends.later - ends.earlier <= kGap) odometry_.emplace(ends.earlier, place);
  }
}

std::vector<std::vector<EdgePlace>> WrongPlaces::groups(Graph& values_of, std::span<const EdgePlace> edges) {
  const Closure* asked = nullptr;
  std::optional<FiniteMotion> motion;
  const auto agree = [&](const Closure& one, const Closure& other) {
    if (asked != &one) motion = motion_wanted_by(one, values_of);
    asked = &one;
    if (!motion) return false;
    if (squared_error_at(*motion, other, values_of) <= price_(other.place))
      return true;  // whatever the odometry's noise
    std::vector<EdgePlace> both{one.place, other.place};
    std::sort(both.begin(), both.end());
    return chi2_alone(values_of, both) <= price_(other.place);
  };
  Closures closures(values_of, order_, pairs_of(values_of, edges));
  std::vector<std::vector<EdgePlace>> result;
  for (std::vector<EdgePlace> group; !(group = closures.take_group(agree)).empty();)
    result.push_back(std::move(group));
  return result;
}

double WrongPlaces::price(Graph& values_of, std::span<const EdgePlace> edges) {
  double result = 0;
  for (const EdgePlace place : edges)
    if (!is_pair(values_of, place)) result += price_(place);
  for (const std::vector<EdgePlace>& group : groups(values_of, edges))
    result += group.size() == 1 ? price_(group[0]) : price_of_group(values_of, group);
  return result;
}

double WrongPlaces::price_of_group(const Graph& values_of, const std::vector<EdgePlace>& group) {
  double apart = 0;
  for (const EdgePlace place : group) apart += price_(place);
  const double goes_on = -2 * std::log(kGoesOn) * static_cast<double>(group.size() - 1);
  return std::min(apart, price_(group[0]) + chi2_alone(values_of, group) + goes_on);
}

double WrongPlaces::chi2_alone(const Graph& values_of, const std::vector<EdgePlace>& group) {
  const auto [known, is_new] = known_.try_emplace(group, 0);
  if (is_new) known->second = computed_chi2(values_of, group);
  return known->second;
}

double WrongPlaces::computed_chi2(const Graph& values_of, const std::vector<EdgePlace>& group) const {
  TwoWays ways;
  std::set<std::int64_t> ends[2];
  for (const EdgePlace place : group) {
    const Closure closure = closure_of(values_of, order_, place);
    ends[0].insert(closure.earlier);
    ends[1].insert(closure.later);
    ways.add_closure(values_of, closure);
  }
  for (const bool later : {false, true}) {
    const auto last = odometry_.lower_bound(*ends[later].rbegin());
    for (auto edge = odometry_.lower_bound(*ends[later].begin()); edge != last; ++edge) {
      if (closure_of(values_of, order_, edge->second).later <= *ends[later].rbegin())
        ways.add_odometry(values_of, edge->second, later);
    }
  }
  if (!ways.is_whole()) return std::numeric_limits<double>::infinity();
  ways.bring_together();
  try {
    return optimize(ways.graph(), algorithm_, solver_, {}).final_chi2;
  } catch (const InputError&) {
    return std::numeric_limits<double>::infinity();  // alone they determine no solution
  }
}

}  // namespace waymark::detail
