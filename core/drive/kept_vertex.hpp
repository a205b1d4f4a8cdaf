/// A vertex that a model finds again when its drive grows.
#pragma once

#include <optional>

#include <waymark/core/base/export.hpp>
#include <waymark/core/graph/graph.hpp>

namespace WAYMARK_EXPORT waymark {

/// Keeps a vertex by its id. Its index changes when earlier vertices leave the graph.
class KeptVertex {
 public:
  /// Returns the vertex, or -1 if none is kept or it has left the graph. O(1).
  [[nodiscard]] VertexIndex in(const Graph& graph) const { return id_ ? graph.find(*id_).value_or(-1) : -1; }

  /// Returns the vertex. If there is none, it is made first. @param make returns its index
  template <typename Make>
  VertexIndex in_or(Graph& graph, const Make& make) {
    const VertexIndex known = in(graph);
    return known >= 0 ? known : keep(make(), graph);
  }

  /// Keeps this vertex from now on, and returns it.
  VertexIndex keep(VertexIndex vertex, const Graph& graph) {
    id_ = graph.id(vertex);
    return vertex;
  }

 private:
  std::optional<VertexId> id_;
};

}  // namespace waymark
