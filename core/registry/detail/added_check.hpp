/// What a model adds to a graph must be usable: a single edge that is not can spoil a whole drive, and
/// nobody could tell then whose it is.
#pragma once

#include <string>
#include <vector>

#include <waymark/core/graph/graph.hpp>

namespace waymark::detail {

/// Looks at what is added to a graph after it was made.
class AddedCheck {
 public:
  explicit AddedCheck(const Graph& graph);

  /// Returns a sentence about the first added vertex or edge whose numbers are not finite, or whose
  /// information is not positive semidefinite; empty: there is none.
  [[nodiscard]] std::string flaw(const Graph& graph) const;

 private:
  [[nodiscard]] std::string flaw_of_vertices(const Graph& graph) const;
  [[nodiscard]] std::string flaw_of_edges(const Graph& graph, std::size_t batch) const;

  std::size_t vertices_ = 0;
  std::vector<std::size_t> edges_;  // per batch
};

}  // namespace waymark::detail
