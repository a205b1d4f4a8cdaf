/// The structure of the normal equations of a graph: which vertices are unknowns, in which order they are
/// eliminated, the block pattern, and where each edge adds its part.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include <waymark/core/graph/edge_batch.hpp>
#include <waymark/core/graph/graph.hpp>
#include <waymark/core/linear/block_pattern.hpp>

namespace waymark {

class Structure {
 public:
  /// Makes the structure new: order, pattern, scatter offsets.
  /// @param held per vertex: not zero keeps it out of the unknowns (beside the graph's own fixed vertices)
  void build(const Graph& graph, std::span<const char> held);

  /// Follows a graph that has grown at its end: new vertices are ordered after the old ones (before dense
  /// columns) and the old order stays. Where each new edge has a new vertex and no column is dense, old
  /// columns and scatter offsets are kept and only new ones are made; otherwise the pattern is made again in
  /// the kept order.
  /// @param held as in build, for all vertices; it must not change for old ones.
  void extend(const Graph& graph, std::span<const char> held);

  /// Follows a graph that has lost vertices, and has since then at most gained edges among those that stayed
  /// (marginalisation priors). What stays keeps its order; old columns lose the rows that are gone and gain
  /// those the new edges need, without looking at the other edges. A block that no edge needs any more stays,
  /// as zeros, until one of its vertices goes.
  /// @param removal what Graph::remove_vertices said; the structure had followed the graph until then
  /// @param held as in build, for the vertices that stayed
  /// @throws UsageError where the structure had not followed the graph
  void remove(const Graph& graph, const Removal& removal, std::span<const char> held);

  [[nodiscard]] const BlockPattern& pattern() const { return pattern_; }
  [[nodiscard]] const Scatter& scatter(std::size_t batch) const { return scatters_[batch]; }
  /// Block column of a vertex, -1 where it is no unknown.
  [[nodiscard]] int column_of(VertexIndex v) const { return column_of_[static_cast<std::size_t>(v)]; }
  /// The vertex of a block column.
  [[nodiscard]] VertexIndex vertex_of(int column) const {
    return vertex_of_[static_cast<std::size_t>(column)];
  }
  /// Chunks of every scatter; the last is worked on alone, after the others.
  [[nodiscard]] int chunks() const { return chunks_; }
  /// Doubles to reserve for the matrix and the gradient: numbers plus a slot per chunk.
  [[nodiscard]] std::int64_t hessian_size() const { return pattern_.value_count() + chunks_ * slot_block_; }
  [[nodiscard]] std::int64_t gradient_size() const { return pattern_.dimension() + chunks_ * slot_row_; }
  /// Adds what the chunks gathered for dense columns in their slots, chunk by chunk, to its place.
  void add_slots(double* hessian, double* gradient) const;
  /// "natural", "leaves first" or "amd".
  [[nodiscard]] const std::string& ordering() const { return ordering_; }
  /// Number of block columns ordered last because they touch very many edges.
  [[nodiscard]] int dense_columns() const { return dense_columns_; }

 private:
  /// Vertices per chunk, by index: fixed, so that a growing graph keeps its chunks.
  static constexpr std::size_t kChunkVertices = 4096;

  void choose_unknowns(const Graph& graph, std::span<const char> held);
  void keep_order(const Graph& graph, std::span<const VertexIndex> old_order);
  void make_pattern(const Graph& graph, int first_column, std::span<const std::int64_t> begin,
                    std::span<const int> rows);
  void make_scatter(const Graph& graph, bool only_new);
  void move_scatter(const Graph& graph, const Removal& removal,
                    std::span<const std::optional<std::int64_t>> shifts);
  void retarget_held(const Graph& graph);
  static void add_to_ranges(std::uint32_t edge, std::vector<EdgeRange>& ranges);
  static void set_ranges(std::span<const std::vector<EdgeRange>> of_chunks, Scatter& scatter);
  void size_slots(const Graph& graph);
  [[nodiscard]] int chunk_of(std::span<const VertexIndex> vertices) const;
  [[nodiscard]] std::int64_t gradient_target(int chunk, int column) const;
  [[nodiscard]] BlockTarget target(int chunk, int first, int second) const;

  BlockPattern pattern_;
  std::vector<Scatter> scatters_;
  std::vector<std::size_t> scattered_edges_;  // per batch: edges that have their offsets
  std::vector<int> column_of_;
  std::vector<VertexIndex> vertex_of_;
  int dense_columns_ = 0;
  int chunks_ = 1;
  int scratch_ = 0;     // rows of the largest vertex, where any is held
  int dense_size_ = 0;  // scalar rows of all dense columns
  std::int64_t slot_block_ = 0;
  std::int64_t slot_row_ = 0;
  std::string ordering_ = "natural";
};

/// A fill-reducing order of a symmetric block pattern, and how it was found.
struct BlockOrder {
  std::vector<int> order;  ///< order[k] is the node eliminated as number k
  std::string method;      ///< "natural", "leaves first" or "amd"
};

/// Orders the columns 0..n-1 of an upper triangle (rows of column j: rows[begin[j]..begin[j + 1]), ascending,
/// without the diagonal). Columns marked dense go last. The others: in their natural order where it fills
/// little; or so that nodes with a single neighbour come just before it (GNSS nodes of a drive); else by
/// approximate minimum degree (Amestoy, Davis, Duff 1996) on the block graph.
[[nodiscard]] BlockOrder order_blocks(std::span<const std::int64_t> begin, std::span<const int> rows,
                                      std::span<const char> dense);

/// Off-diagonal blocks of the Cholesky factor in the natural order, leaving out what is marked, or -1 once
/// they exceed `limit`.
[[nodiscard]] std::int64_t count_fill(std::span<const std::int64_t> begin, std::span<const int> rows,
                                      std::span<const char> left_out, std::int64_t limit);

}  // namespace waymark
