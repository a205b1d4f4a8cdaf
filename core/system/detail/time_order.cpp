#include <waymark/core/system/detail/time_order.hpp>

#include <algorithm>
#include <limits>
#include <optional>
#include <span>

#include <waymark/core/base/detail/index.hpp>

namespace waymark::detail {
namespace {

constexpr Stamp kFirst{std::numeric_limits<std::int64_t>::min()};
constexpr Stamp kLast{std::numeric_limits<std::int64_t>::max()};

/// What the order of a vertex depends on.
struct Moment {
  Stamp own = kFirst;
  Stamp last = kFirst;  // of the neighbours
  bool has_place = false;
  bool at_its_time = false;
  bool has_edge = false;
};

std::vector<Moment> moments_of(const Graph& graph) {
  std::vector<Moment> moments(graph.vertex_count());
  for (std::size_t v = 0; v < moments.size(); ++v) {
    const auto vertex = static_cast<VertexIndex>(v);
    Moment& moment = moments[v];
    moment.has_place = graph.vertex_type(vertex).position != nullptr;
    const std::optional<Stamp> stamp = graph.stamp(vertex);
    if (stamp) moment.own = *stamp;
    moment.at_its_time = moment.has_place && stamp;
    if (!stamp && !moment.has_place && !graph.fixed(vertex)) moment.own = kLast;
    moment.last = moment.own;
  }
  for (std::size_t b = 0; b < graph.batch_count(); ++b) {
    for_each_edge(graph.batch(b), [&](std::span<const VertexIndex> vertices) {
      Stamp last = kFirst;
      for (const VertexIndex v : vertices) {
        Moment& moment = moments[at(v)];
        moment.has_edge = true;
        if (moment.own != kLast) last = std::max(last, moment.own);
      }
      for (const VertexIndex v : vertices) {
        Moment& moment = moments[at(v)];
        if (!moment.at_its_time) moment.last = std::max(moment.last, last);
      }
    });
  }
  return moments;
}

}  // namespace

std::vector<VertexIndex> time_order(const Graph& graph) {
  const std::vector<Moment> moments = moments_of(graph);
  std::vector<VertexIndex> order;
  order.reserve(moments.size());
  for (std::size_t v = 0; v < moments.size(); ++v) {
    const auto vertex = static_cast<VertexIndex>(v);
    if (moments[v].has_edge && !graph.fixed(vertex)) order.push_back(vertex);
  }
  // Of one time, vertices with a place come first: the states go on to the next pose.
  const auto before = [&](VertexIndex a, VertexIndex b) {
    const Moment& one = moments[at(a)];
    const Moment& other = moments[at(b)];
    if (one.last != other.last) return one.last < other.last;
    return one.has_place != other.has_place ? one.has_place : a < b;
  };
  if (!std::is_sorted(order.begin(), order.end(), before)) std::sort(order.begin(), order.end(), before);
  return order;
}

}  // namespace waymark::detail
