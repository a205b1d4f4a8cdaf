#include <algorithm>
#include <cstddef>
#include <utility>

#include <waymark/core/base/error.hpp>
#include <waymark/core/robust/detail/consistent_edges.hpp>
#include <waymark/core/robust/edge_selection.hpp>

namespace waymark::detail {
namespace {

using Row = std::vector<char>;  // marks the edges that one is consistent with

// Returns the set that grows from one edge, which is always joined by the one that leaves most of the others possible.
std::vector<std::size_t> grown_set(const std::vector<Row>& agree, std::size_t seed) {
  std::vector<std::size_t> result = {seed};
  std::vector<std::size_t> possible;
  for (std::size_t i = 0; i < agree.size(); ++i)
    if (agree[seed][i] != 0) possible.push_back(i);
  while (!possible.empty()) {
    const auto left = [&](std::size_t i) {
      return std::count_if(possible.begin(), possible.end(), [&](std::size_t j) { return agree[i][j] != 0; });
    };
    std::vector<std::pair<std::ptrdiff_t, std::size_t>> by_left;
    for (const std::size_t i : possible) by_left.emplace_back(left(i), i);
    const std::size_t next = std::max_element(by_left.begin(), by_left.end())->second;
    result.push_back(next);
    std::erase_if(possible, [&](std::size_t i) { return agree[next][i] == 0; });
  }
  return result;
}

// Returns the largest of the sets that grow from each edge, the largest first; each is ascending.
std::vector<std::vector<std::size_t>> largest_sets(const std::vector<Row>& agree, std::size_t most) {
  std::vector<std::vector<std::size_t>> sets;
  for (std::size_t seed = 0; seed < agree.size(); ++seed) {
    sets.push_back(grown_set(agree, seed));
    std::sort(sets.back().begin(), sets.back().end());
  }
  std::sort(sets.begin(), sets.end(),
            [](const auto& a, const auto& b) { return a.size() != b.size() ? a.size() > b.size() : a < b; });
  sets.erase(std::unique(sets.begin(), sets.end()), sets.end());
  sets.resize(std::min(sets.size(), most));
  return sets;
}

// Marks those of the edges outside that agree with the others, and with what is inside, at its minimum.
Row agreeing_with(Splits& splits, const std::vector<EdgePlace>& outside,
                  const std::vector<EdgePlace>& asked) {
  (void)splits.optimize_without(outside);  // whose minimum the graph has now
  const Graph kept = without_edges(splits.graph(), outside);
  const std::vector<Innovation> innovation = innovations(splits.graph(), asked, Membership::outside, kept);
  Row result;
  for (std::size_t i = 0; i < asked.size(); ++i)
    result.push_back(innovation[i].squared <= splits.bound(asked[i]) ? 1 : 0);
  return result;
}

}  // namespace

std::vector<std::vector<EdgePlace>> consistent_edges(Splits& splits) {
  constexpr std::size_t kSets = 20;
  const std::vector<EdgePlace>& candidates = splits.roles().candidates;
  const std::vector<EdgePlace> outside = splits.without_joining(candidates);
  std::vector<Row> agree;
  try {
    const Row alone = agreeing_with(splits, outside, outside);
    const std::vector<double> of_trusted = splits.graph().values();
    for (std::size_t i = 0; i < outside.size(); ++i) {
      if (splits.interrupted()) return {};
      splits.graph().set_values(of_trusted);
      agree.emplace_back(outside.size(), 0);
      if (alone[i] == 0) continue;
      agree.back() = agreeing_with(splits, difference(outside, {outside[i]}), outside);
      agree.back()[i] = 0;
    }
  } catch (const InputError&) {
    return {};
  }
  for (std::size_t i = 0; i < agree.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      agree[i][j] = agree[j][i] = agree[i][j] != 0 && agree[j][i] != 0 ? 1 : 0;
  std::vector<std::vector<EdgePlace>> result;
  for (const std::vector<std::size_t>& set : largest_sets(agree, kSets)) {
    std::vector<EdgePlace> others = outside;
    for (const std::size_t i : set) std::erase(others, outside[i]);
    result.push_back(difference(candidates, others));
  }
  return result;
}

}  // namespace waymark::detail
