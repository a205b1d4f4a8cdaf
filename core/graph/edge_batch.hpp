/// Edge batches: all edges of one type in one contiguous array. A pass needs one virtual
/// call per type.
///
/// Batches belong to their graph; graph.hpp says how long references and spans are valid. Several
/// threads may call const functions at the same time. Precondition of all functions: an edge number
/// is below size().
#pragma once

#include <compare>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include <waymark/core/base/detail/large_array.hpp>
#include <waymark/core/base/export.hpp>
#include <waymark/core/base/sight.hpp>
#include <waymark/core/graph/edge.hpp>
#include <waymark/core/graph/loss.hpp>

namespace WAYMARK_EXPORT waymark {

/// The place of the product of two Jacobians of an edge in the normal matrix: a column-major block
/// at values[offset]. `stride` is the distance between columns. If it is negative, the first vertex
/// is the column of the block.
struct BlockTarget {
  std::uint32_t offset = 0;
  std::int32_t stride = 0;
};

/// Names an edge of a graph: its batch and its place in the batch. It is valid until vertices
/// are removed.
struct EdgePlace {
  std::size_t batch = 0;
  std::size_t edge = 0;
  friend auto operator<=>(const EdgePlace&, const EdgePlace&) = default;
};

/// Edges [first, last) of a batch.
struct EdgeRange {
  std::uint32_t first = 0;
  std::uint32_t last = 0;
};

/// The targets of all edges of a batch, computed once per structure. An edge of K vertices has K
/// places in the gradient and K (K + 1) / 2 blocks; the pair (k, l <= k) is at k (k + 1) / 2 +
/// l. Held vertices point to a scratch area after the numbers, so that the kernels need no
/// branch for them.
///
/// The edges are split into chunks. Different chunks write to disjoint places, so they can run at
/// the same time. Only the last chunk writes anywhere; it runs after all others. Chunks do not
/// depend on the number of threads, so sums do not either.
struct Scatter {
  LargeArray<std::uint32_t> gradient;
  LargeArray<BlockTarget> blocks;
  std::vector<EdgeRange> ranges;
  /// begin of each chunk in `ranges`, and the end of the last one
  std::vector<std::size_t> chunk{0};
};

/// The values that a pass over the edges reads.
struct ValueView {
  const double* values = nullptr;         ///< numbers of all vertices
  const std::int64_t* offsets = nullptr;  ///< begin of each vertex in `values`
};

/// The output of the linearisation: H += J^T (w Omega + second-order term of the loss,
/// robust_information.hpp) J and g += w J^T Omega e. For the evidence (evidence.hpp) H += J^T
/// min(w, evidence_weight) Omega J.
struct NormalView {
  double* hessian = nullptr;
  double* gradient = nullptr;
  double evidence_weight = 0;  ///< 0: H is for optimisation steps
};

/// The output of a pass that adds up, for each component of the graph, what its edges observe of
/// rigid motions.
struct RigidMotionView {
  /// The place of a component. A turn is about the centre by 1 / extent radians.
  struct Place {
    Eigen::Vector2d centre = Eigen::Vector2d::Zero();
    double extent = 1;
  };
  const std::int32_t* component = nullptr;  ///< per vertex; -1: the vertex is held or does not move
  const Place* places = nullptr;            ///< per component
  Eigen::Matrix3d* information = nullptr;   ///< per component; the pass adds to it
};

/// The vertices of all edges of a batch with fixed arity. The vertices of edge e begin `stride`
/// bytes after those of e - 1.
struct VertexTable {
  const VertexIndex* first = nullptr;
  std::size_t stride = 0;
  int arity = 0;  ///< 0: run-time arity; ask for each edge

  [[nodiscard]] std::span<const VertexIndex> operator[](std::size_t edge) const {
    const auto* bytes = reinterpret_cast<const char*>(first) + edge * stride;
    return {reinterpret_cast<const VertexIndex*>(bytes), static_cast<std::size_t>(arity)};
  }
};

class EdgeBatchBase {
 public:
  virtual ~EdgeBatchBase();
  [[nodiscard]] virtual std::unique_ptr<EdgeBatchBase> clone() const = 0;

  [[nodiscard]] virtual std::size_t size() const = 0;
  [[nodiscard]] virtual std::span<const VertexIndex> vertices(std::size_t edge) const = 0;
  [[nodiscard]] virtual int error_dimension(std::size_t edge) const = 0;

  /// Appends an edge, given its vertices with their types, its fields in schema order, and its full
  /// information matrix.
  virtual void append(std::span<const VertexIndex> vertices, std::span<const VertexType* const> types,
                      std::span<const double> fields, const Eigen::MatrixXd& information) = 0;
  /// Reserves memory for this many edges in all. It only affects speed.
  virtual void reserve(std::size_t) {}
  /// Removes edges, and renumbers the vertices of the others. Their order, numbers and losses stay.
  /// @param gone per edge: not zero removes it
  /// @param new_index per vertex: its new index, >= 0 for every vertex of an edge that stays
  void remove(std::span<const char> gone, std::span<const VertexIndex> new_index);
  /// Appends the numbers of an edge to `out`, in schema order.
  virtual void fields(std::size_t edge, std::vector<double>& out) const = 0;
  [[nodiscard]] virtual Eigen::MatrixXd information(std::size_t edge) const = 0;

  /// Returns where an edge saw its second vertex from its first one, if the type tells.
  [[nodiscard]] virtual std::optional<Sight> sight(std::size_t) const { return std::nullopt; }

  /// Returns the vertices of all edges at once. Empty for run-time arity.
  [[nodiscard]] virtual VertexTable vertex_table() const { return {}; }

  /// Returns the sum of rho(e^T Omega e) over a range of edges. It is not finite if an
  /// error is not.
  [[nodiscard]] virtual double chi2(const ValueView& view, EdgeRange range) const = 0;
  [[nodiscard]] double chi2(const ValueView& view) const {
    return chi2(view, {0, static_cast<std::uint32_t>(size())});
  }
  /// Adds a range of edges to the normal equations, and returns its chi2.
  virtual double linearize(const ValueView& view, const Scatter& scatter, EdgeRange range,
                           const NormalView& normal) const = 0;
  /// Computes the error and Jacobians of one edge (one matrix per vertex), without information and
  /// loss. It is for checks and tests.
  virtual void linearize_edge(std::size_t edge, const ValueView& view, Eigen::VectorXd& error,
                              std::vector<Eigen::MatrixXd>& jacobians) const = 0;
  /// Adds (sum_k J_k T_k)^T Omega (sum_k J_k T_k) to the component of each edge. T_k are the rigid
  /// motions of its vertices (Vertex: rigid_motion).
  virtual void add_rigid_information(const ValueView& view, const RigidMotionView& motion) const = 0;

  /// Sets the loss of every edge that has no loss of its own.
  void set_loss(Loss loss) { batch_loss_ = std::move(loss); }
  void set_loss(std::size_t edge, Loss loss);
  /// Returns the loss of an edge; null: none (rho(s) = s).
  [[nodiscard]] const Loss* loss(std::size_t edge) const;
  [[nodiscard]] const Loss* batch_loss() const { return batch_loss_.evaluate ? &batch_loss_ : nullptr; }

 protected:
  /// Runs a pass over edges. If one of them throws, it is named by its type and its number.
  template <typename Pass>
  auto named(std::string_view tag, const ValueView& view, EdgeRange range, const Pass& pass) const {
    try {
      return pass();
    } catch (...) {
      throw_edge_error(tag, view, range);
    }
  }

  /// Returns "EDGE_X number 3: sight", for messages about a function of an edge.
  static std::string name_in(std::string_view tag, std::size_t edge, std::string_view function);

  EdgeBatchBase() = default;
  EdgeBatchBase(const EdgeBatchBase&) = default;
  EdgeBatchBase& operator=(const EdgeBatchBase&) = default;

  [[nodiscard]] bool has_loss() const { return batch_loss_.evaluate != nullptr || !edge_loss_.empty(); }
  [[nodiscard]] LossValue evaluate_loss(std::size_t edge, double squared) const;

 private:
  /// Finds the edge that throws again, and throws a PluginError that names it.
  [[noreturn]] void throw_edge_error(std::string_view tag, const ValueView& view, EdgeRange range) const;
  /// Does the work of remove(), except for the losses.
  virtual void remove_records(std::span<const char> gone, std::span<const VertexIndex> new_index) = 0;

  Loss batch_loss_;
  std::vector<Loss> losses_;  // the losses of single edges, each stored once
  std::vector<std::int32_t>
      // per edge an index into losses_; -1: the loss of the batch; empty: no edge has its own
      edge_loss_;
};

/// Calls visit(vertices) for every edge of a batch, in order.
template <typename Visit>
void for_each_edge(const EdgeBatchBase& batch, Visit visit, std::size_t first = 0) {
  const VertexTable table = batch.vertex_table();
  if (table.arity > 0) {
    for (std::size_t e = first; e < batch.size(); ++e) visit(table[e]);
  } else {
    for (std::size_t e = first; e < batch.size(); ++e) visit(batch.vertices(e));
  }
}

}  // namespace waymark
