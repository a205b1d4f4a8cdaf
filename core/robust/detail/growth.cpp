#include <algorithm>
#include <cstddef>
#include <span>
#include <utility>

#include <waymark/core/base/error.hpp>
#include <waymark/core/robust/detail/growth.hpp>
#include <waymark/core/robust/edge_selection.hpp>
#include <waymark/core/system/gauge.hpp>

namespace waymark::detail {
namespace {

// Returns those outliers of a split that return next: of those that agree with the rest, the best known share.
// @param refused had returned, and were contradicted by others
std::vector<EdgePlace> returning(const Splits& splits, const Graph& graph, const Verdict& verdict,
                                 const std::vector<EdgePlace>& refused) {
  constexpr std::size_t kShare = 10;
  constexpr double kTogether = 2;  // of the looseness, between the first and the last that return at a time
  const std::vector<EdgePlace>& out = verdict.outliers;
  const std::vector<Innovation> innovation =
      innovations(graph, out, Membership::outside, without_edges(graph, out));
  std::vector<std::pair<double, EdgePlace>> agreeing;
  for (std::size_t i = 0; i < out.size(); ++i) {
    if (innovation[i].squared <= splits.bound(out[i]) &&
        !std::binary_search(refused.begin(), refused.end(), out[i]))
      agreeing.emplace_back(innovation[i].looseness, out[i]);
  }
  std::sort(agreeing.begin(), agreeing.end());
  agreeing.resize((agreeing.size() + kShare - 1) / kShare);
  std::vector<EdgePlace> result;
  for (const auto& [looseness, place] : agreeing)
    if (!(looseness > agreeing.front().first + kTogether)) result.push_back(place);
  return result;
}

}  // namespace

bool may_be_grown(const Splits& splits, const Graph& first) {
  const std::vector<char> held = find_gauge(first, PartlyAnchored::hold_vertex).held;
  if (std::none_of(held.begin(), held.end(), [](char mark) { return mark != 0; })) return true;
  const Graph& graph = splits.graph();
  const std::vector<EdgePlace>& candidates = splits.roles().candidates;
  return std::all_of(candidates.begin(), candidates.end(), [&](EdgePlace place) {
    const std::span<const VertexIndex> vertices = graph.batch(place.batch).vertices(place.edge);
    return std::count_if(vertices.begin(), vertices.end(), [&](VertexIndex v) { return !graph.fixed(v); }) >
           1;
  });
}

std::optional<std::vector<EdgePlace>> grown_from(Splits& splits, std::vector<EdgePlace> out) {
  constexpr int kMaxSplits = 1000;
  const Graph& graph = splits.graph();
  out = splits.without_joining(out);
  if (!may_be_grown(splits, without_edges(graph, out))) return std::nullopt;
  Verdict cheapest;
  std::vector<EdgePlace> refused;
  for (int split = 0; split < kMaxSplits; ++split) {
    Verdict verdict;
    try {
      verdict = splits.optimize_without(out);
    } catch (const InputError&) {
      break;  // the remaining edges determine no solution
    }
    if (splits.interrupted()) break;
    verdict.cost = splits.cost_by_edges(verdict);  // growing lowers both costs
    if (verdict.cost < cheapest.cost) cheapest = verdict;
    const std::vector<EdgePlace> back = returning(splits, graph, verdict, refused);
    if (back.empty()) break;
    for (const EdgePlace place : back) std::erase(out, place);
    const std::vector<EdgePlace> beyond = splits.beyond_bound(splits.inside(verdict));
    out = united(out, beyond);
    refused = united(refused, beyond);
  }
  splits.consider(std::move(cheapest));
  return out;
}

}  // namespace waymark::detail
