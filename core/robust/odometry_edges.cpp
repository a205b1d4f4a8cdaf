#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>

#include <waymark/core/base/detail/index.hpp>
#include <waymark/core/base/detail/median.hpp>
#include <waymark/core/robust/detail/id_order.hpp>
#include <waymark/core/robust/odometry_edges.hpp>

namespace waymark {
namespace {

using detail::at;

/// The vertices of one type in the order of their ids, and which of them edges join.
class Numbering {
 public:
  explicit Numbering(std::vector<std::int64_t> ids) : ids_(std::move(ids)) {
    for (std::vector<char>& joined : joined_) joined.assign(ids_.size(), 0);
  }

  /// @param first, second places in the order, first < second
  void join(std::size_t first, std::size_t second) {
    if (second - first <= kMostInterleaved) joined_[second - first - 1][first] = 1;
  }

  /// Call it when all are joined.
  void count() {
    for (std::size_t k = 0; k < kMostInterleaved; ++k) {
      counts_[k].assign(1, 0);
      for (const char joined : joined_[k]) counts_[k].push_back(counts_[k].back() + joined);
    }
  }

  /// Tells whether the second one continues the drive of the first one.
  [[nodiscard]] bool continues(std::size_t first, std::size_t second) const {
    const std::size_t step = second - first;
    return step <= kMostInterleaved && step == step_at(first) && !is_leap(first, step);
  }

 private:
  static constexpr std::size_t kMostInterleaved = 8;  // drives
  static constexpr std::size_t kNear = 25;            // pairs before, and as many behind
  static constexpr std::uint64_t kLeap = 10;

  struct Range {
    std::size_t begin;
    std::size_t end;
  };

  /// Returns the pairs of this step near one.
  [[nodiscard]] Range near(std::size_t first, std::size_t step) const {
    const std::size_t pairs = ids_.size() - std::min(ids_.size(), step);
    return {std::min(pairs, first - std::min(first, kNear)), std::min(pairs, first + kNear + 1)};
  }

  /// Returns which later one most are joined to, the nearest if that is true for several; 0: none.
  [[nodiscard]] std::size_t step_at(std::size_t first) const {
    for (std::size_t step = 1; step <= kMostInterleaved; ++step) {
      const auto [begin, end] = near(first, step);
      const std::size_t joined = counts_[step - 1][end] - counts_[step - 1][begin];
      if (joined > 0 && 2 * joined >= end - begin) return step;
    }
    return 0;
  }

  /// Returns by how much the ids differ, which an int64 may not hold.
  [[nodiscard]] std::uint64_t difference(std::size_t first, std::size_t step) const {
    return static_cast<std::uint64_t>(ids_[first + step]) - static_cast<std::uint64_t>(ids_[first]);
  }

  [[nodiscard]] bool is_leap(std::size_t first, std::size_t step) const {
    const std::uint64_t own = difference(first, step);
    if (own <= step) return false;
    std::vector<std::uint64_t> usual;
    std::size_t similar = 0;
    std::size_t joined = 0;  // of the similar ones
    const auto [begin, end] = near(first, step);
    for (std::size_t other = begin; other < end; ++other) {
      if (other == first) continue;
      const bool is_joined = joined_[step - 1][other] != 0;
      const std::uint64_t its = difference(other, step);
      if (is_joined) usual.push_back(its);
      if (its < own / 2) continue;
      ++similar;
      joined += is_joined;
    }
    if (!usual.empty() && own / kLeap <= upper_median(usual)) return false;
    return similar < 2 || 2 * joined < similar;
  }

  std::vector<std::int64_t> ids_;
  std::array<std::vector<char>, kMostInterleaved> joined_;         // by step - 1 and the first one
  std::array<std::vector<std::size_t>, kMostInterleaved> counts_;  // the same up to the first one
};

/// The order of all poses.
class Drives {
 public:
  explicit Drives(const Graph& graph)
      : graph_(graph), sequence_(graph.vertex_count(), -1), place_(graph.vertex_count(), 0) {
    for (const std::vector<VertexIndex>& sequence : detail::sequences_by_id(graph)) {
      if (graph.vertex_type(sequence.front()).position == nullptr) continue;
      std::vector<std::int64_t> ids;
      for (const VertexIndex v : sequence) {
        sequence_[at(v)] = static_cast<std::int32_t>(numberings_.size());
        place_[at(v)] = ids.size();
        ids.push_back(to_number(graph.id(v)));
      }
      numberings_.emplace_back(std::move(ids));
    }
  }

  void join(EdgePlace place) {
    if (const auto pair = pair_of(place)) numberings_[pair->sequence].join(pair->first, pair->second);
  }

  void count() {
    for (Numbering& numbering : numberings_) numbering.count();
  }

  [[nodiscard]] bool is_odometry(EdgePlace place) const {
    const auto pair = pair_of(place);
    return pair && pair->is_free && numberings_[pair->sequence].continues(pair->first, pair->second);
  }

 private:
  struct Pair {
    std::size_t sequence;
    std::size_t first;  // places in it
    std::size_t second;
    bool is_free;  // of fixed vertices
  };

  /// Returns the two poses of which the edge determines one from the other.
  [[nodiscard]] std::optional<Pair> pair_of(EdgePlace place) const {
    const EdgeBatchBase& batch = graph_.batch(place.batch);
    std::array<VertexIndex, 2> placed{};
    std::size_t count = 0;
    for (const VertexIndex v : batch.vertices(place.edge)) {
      if (sequence_[at(v)] < 0) continue;
      if (count == 2) return std::nullopt;
      placed[count++] = v;
    }
    if (count != 2 || sequence_[at(placed[0])] != sequence_[at(placed[1])]) return std::nullopt;
    if (batch.error_dimension(place.edge) < graph_.vertex_type(placed[0]).tangent_size) return std::nullopt;
    const auto [first, second] = std::minmax(place_[at(placed[0])], place_[at(placed[1])]);
    return Pair{at(sequence_[at(placed[0])]), first, second,
                !graph_.fixed(placed[0]) && !graph_.fixed(placed[1])};
  }

  const Graph& graph_;
  std::vector<std::int32_t> sequence_;  // of each vertex; -1: it has no place in the plane
  std::vector<std::size_t> place_;      // in its sequence
  std::vector<Numbering> numberings_;
};

}  // namespace

std::vector<EdgePlace> odometry_edges(const Graph& graph) {
  Drives drives(graph);
  const auto each = [&](const auto& visit) {
    for (std::size_t b = 0; b < graph.batch_count(); ++b)
      for (std::size_t e = 0; e < graph.batch(b).size(); ++e) visit(EdgePlace{b, e});
  };
  const auto is_prior = [&](EdgePlace place) {
    return graph.edge_type(place.batch).arity == EdgeType::kRuntimeArity;
  };
  each([&](EdgePlace place) {
    if (!is_prior(place)) drives.join(place);
  });
  drives.count();
  std::vector<EdgePlace> result;
  each([&](EdgePlace place) {
    if (is_prior(place) || drives.is_odometry(place)) result.push_back(place);
  });
  return result;
}

}  // namespace waymark
