/// The structure of the normal equations of a graph: the unknown vertices, their order of
/// elimination, the block pattern, and the places where each edge adds its part.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include <waymark/core/base/export.hpp>
#include <waymark/core/graph/edge_batch.hpp>
#include <waymark/core/graph/graph.hpp>
#include <waymark/core/linear/block_pattern.hpp>

namespace WAYMARK_EXPORT waymark {

/// A fill-reducing order of a symmetric block pattern, and the method that found it.
struct BlockOrder {
  std::vector<int> order;  ///< node order[k] is eliminated as number k
  std::string method;      ///< "natural", "leaves first", "amd" or "time"
};

/// A coordinate of the tangent of an unknown vertex that keeps its value.
struct HeldCoordinate {
  int column = 0;      ///< block column of the vertex
  int coordinate = 0;  ///< of its tangent
};

/// It can be copied, owns all its data, and keeps no reference to the graph. Returned spans
/// and references are valid until the next build(), extend() or remove(). Any number of
/// threads may read it.
class Structure {
 public:
  /// Computes the structure anew: order, pattern, scatter offsets.
  /// @param held per vertex, a mark of held_marks.hpp: kWhollyHeld keeps it out of the unknowns (like the
  /// fixed vertices of the graph); one with some coordinates held stays among them
  /// @param growing the graph will grow at its end. States without a place (calibration) are then
  /// ordered last, however few edges they touch yet: eliminated before the poses that will join them,
  /// they would join all of these with each other.
  void build(const Graph& graph, std::span<const char> held, bool growing = false);

  /// Follows a graph that has grown at its end. New vertices are ordered after the old ones (but
  /// before dense columns), and the old order stays. If each new edge has a new vertex and no
  /// column is dense, old columns and scatter offsets are kept, and only new ones are computed.
  /// Otherwise the pattern is computed anew in the kept order.
  /// @param held as in build, for all vertices; it must not change for old ones
  void extend(const Graph& graph, std::span<const char> held);

  /// Follows a graph that has lost vertices. Since then it may only have gained edges among the
  /// remaining vertices (marginalisation priors). The rest keeps its order. Old columns lose
  /// the removed rows and gain those that the new edges need, without a pass over the other
  /// edges. A block that no edge needs any more stays, filled with zeros, until one of its
  /// vertices is removed.
  /// @param removal the result of Graph::remove_vertices; the structure had followed the
  /// graph until then
  /// @param held as in build, for the vertices that stayed
  /// @throws UsageError if the structure had not followed the graph
  void remove(const Graph& graph, const Removal& removal, std::span<const char> held);

  /// Tells whether it knows exactly the present vertices and edges of the graph.
  [[nodiscard]] bool follows(const Graph& graph) const;

  [[nodiscard]] const BlockPattern& pattern() const { return pattern_; }
  [[nodiscard]] const Scatter& scatter(std::size_t batch) const { return scatters_[batch]; }
  /// Returns the block column of a vertex, or -1 if it is no unknown.
  [[nodiscard]] int column_of(VertexIndex v) const { return column_of_[static_cast<std::size_t>(v)]; }
  /// Returns the vertex of a block column.
  [[nodiscard]] VertexIndex vertex_of(int column) const {
    return vertex_of_[static_cast<std::size_t>(column)];
  }
  /// Returns the coordinates of unknown vertices that are held, by column.
  [[nodiscard]] std::span<const HeldCoordinate> held_coordinates() const { return held_coordinates_; }
  /// Returns how many chunks every scatter has. The last one runs alone, after the others.
  [[nodiscard]] int chunks() const { return chunks_; }
  /// Returns how many doubles to reserve for the matrix and the gradient: the numbers plus a
  /// slot per chunk.
  [[nodiscard]] std::int64_t hessian_size() const { return pattern_.value_count() + chunks_ * slot_block_; }
  [[nodiscard]] std::int64_t gradient_size() const { return pattern_.dimension() + chunks_ * slot_row_; }
  /// Adds the sums that the chunks collected in their slots for dense columns to their places,
  /// chunk by chunk.
  void add_slots(double* hessian, double* gradient) const;
  /// Returns "natural", "leaves first", "amd" or "time".
  [[nodiscard]] const std::string& ordering() const { return ordering_; }
  /// Returns how many block columns are ordered last because they touch very many edges.
  [[nodiscard]] int dense_columns() const { return dense_columns_; }

 private:
  /// Vertices per chunk, by index. It is constant, so that a growing graph keeps its chunks.
  static constexpr std::size_t kChunkVertices = 4096;

  void choose_unknowns(const Graph& graph, std::span<const char> held);
  void collect_held_coordinates(const Graph& graph, std::span<const char> held);
  /// Takes the order of time if it needs less work.
  void prefer_time_order(const Graph& graph, std::span<const std::int64_t> begin, std::span<const int> rows,
                         std::span<const char> dense, BlockOrder& order) const;
  void keep_order(const Graph& graph, std::span<const VertexIndex> old_order);
  /// Tells whether the column of a vertex belongs to the last ones, whatever its degree.
  [[nodiscard]] bool comes_last(const Graph& graph, VertexIndex v) const;
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

  bool growing_ = false;
  BlockPattern pattern_;
  std::vector<Scatter> scatters_;
  std::vector<std::size_t> scattered_edges_;  // per batch: edges that have their offsets
  std::vector<int> column_of_;
  std::vector<VertexIndex> vertex_of_;
  std::vector<HeldCoordinate> held_coordinates_;
  int dense_columns_ = 0;
  int chunks_ = 1;
  int scratch_ = 0;     // rows of the largest vertex, if any is held
  int dense_size_ = 0;  // scalar rows of all dense columns
  std::int64_t slot_block_ = 0;
  std::int64_t slot_row_ = 0;
  std::string ordering_ = "natural";
};

/// Orders the columns 0..n-1 of an upper triangle (rows of column j: rows[begin[j]..begin[j + 1]),
/// ascending, without the diagonal). Columns marked dense come last. The other columns keep their
/// natural order if that has little fill. Otherwise nodes with a single neighbour are put just
/// before it, if that has little fill (GNSS nodes of a drive). Otherwise the order is approximate
/// minimum degree (Amestoy, Davis, Duff 1996) on the block graph; Structure::build then compares it
/// with the order of time.
[[nodiscard]] BlockOrder order_blocks(std::span<const std::int64_t> begin, std::span<const int> rows,
                                      std::span<const char> dense);

/// Counts the off-diagonal blocks of the Cholesky factor in the natural order, without marked
/// columns. Returns -1 if they exceed `limit`.
[[nodiscard]] std::int64_t count_fill(std::span<const std::int64_t> begin, std::span<const int> rows,
                                      std::span<const char> left_out, std::int64_t limit);

}  // namespace waymark
