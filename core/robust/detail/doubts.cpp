#include <algorithm>
#include <cstddef>
#include <map>
#include <utility>

#include <waymark/core/robust/detail/doubts.hpp>
#include <waymark/core/robust/detail/ways.hpp>
#include <waymark/core/robust/edge_selection.hpp>
#include <waymark/core/robust/joining_edges.hpp>

namespace waymark::detail {
namespace {

// Makes candidates of trusted edges if a split without some of them is cheaper. @return it is
bool doubt_all(Splits& splits, const std::vector<EdgePlace>& doubted, const std::vector<EdgePlace>& outliers,
               const Verdict& verdict) {
  if (outliers.empty() || splits.interrupted()) return false;
  EdgeRoles before = splits.roles();
  splits.move_to_candidates(doubted);
  const double cost = splits.best().cost;
  splits.judge(united(outliers, verdict.outliers));
  splits.graph().set_values(splits.best().values);
  if (splits.best().cost < cost) return true;
  splits.set_roles(std::move(before));
  return false;
}

// Doubts the trusted edges on those ways that the others contradict most: one edge of the worst way, as good as
// any other of it, because without several ways at once nothing contradicts any of them, and then all.
// @return there is a cheaper split now
bool doubt_ways(Splits& splits, const Verdict& verdict) {
  const std::vector<std::vector<EdgePlace>> ways =
      by_way(splits.graph(), splits.roles().trusted, verdict.outliers);
  std::map<EdgePlace, std::size_t> way_of;  // by its first edge
  std::vector<EdgePlace> first;
  for (const std::vector<EdgePlace>& way : ways) {
    way_of[way.front()] = first.size();
    first.push_back(way.front());
  }
  std::vector<EdgePlace> accused;
  for (const auto& [gain, place] : splits.accusations(first, verdict)) {
    const std::vector<EdgePlace>& way = ways[way_of[place]];
    if (accused.empty() && doubt_all(splits, way, {place}, verdict)) return true;
    accused.insert(accused.end(), way.begin(), way.end());
  }
  std::sort(accused.begin(), accused.end());
  return doubt_all(splits, accused, accused, verdict);
}

}  // namespace

bool doubt_trusted(Splits& splits) {
  Graph& graph = splits.graph();
  const Verdict best = splits.best();
  graph.set_values(best.values);
  const std::vector<EdgePlace> accused =
      splits.most_accused(splits.contradicted(splits.roles().trusted), best);
  if (doubt_all(splits, accused, accused, best)) return true;
  graph.set_values(best.values);
  const bool are_closures_out = std::any_of(best.outliers.begin(), best.outliers.end(), [&](EdgePlace place) {
    return !splits.is_trusted(place) && graph.batch(place.batch).vertices(place.edge).size() == 2;
  });
  if (!are_closures_out && !splits.is_implausible(best)) return false;
  return doubt_ways(splits, best);
}

bool doubt_for_agreeing(Splits& splits) {
  const std::vector<EdgePlace> agreeing = splits.agreeing_outliers();
  if (agreeing.empty() || splits.interrupted()) return false;
  splits.graph().set_values(splits.best().values);
  const Verdict verdict = splits.optimize_without(difference(splits.best().outliers, agreeing));
  return doubt_ways(splits, verdict);
}

std::vector<EdgePlace> contradicted_inside(const Splits& splits) {
  std::vector<EdgePlace> kept = splits.roles().trusted;
  for (const EdgePlace place : splits.inside(splits.best())) {
    if (splits.is_trusted(place)) kept.push_back(place);
  }
  std::sort(kept.begin(), kept.end());
  return splits.contradicted(kept);
}

std::vector<EdgePlace> unconfirmed(const Splits& splits) {
  constexpr double kUnchecked = 1e-6;
  constexpr std::size_t kMostTried = 100;  // each takes a look at the whole graph
  std::vector<EdgePlace> result;
  const Graph& graph = splits.graph();
  const std::vector<EdgePlace>& outliers = splits.best().outliers;
  if (outliers.empty() || splits.interrupted()) return result;
  const std::vector<EdgePlace> members = splits.inside(splits.best());
  const std::vector<Innovation> innovation =
      innovations(graph, members, Membership::inside, without_edges(graph, outliers));
  std::size_t tried = 0;
  for (std::size_t i = 0; i < members.size() && tried < kMostTried; ++i) {
    if (!(innovation[i].squared <= kUnchecked)) continue;
    ++tried;
    const Graph parts = without_edges(graph, united(outliers, {members[i]}));
    if (!joining_edges(graph, outliers, parts).empty()) result.push_back(members[i]);
  }
  return result;
}

}  // namespace waymark::detail
