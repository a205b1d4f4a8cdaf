/// Edge batches: all edges of one type in one contiguous array; one virtual call per type and pass.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <Eigen/Core>

#include <waymark/core/edge.hpp>
#include <waymark/core/loss.hpp>

namespace waymark {

/// Where the product of two Jacobians of an edge goes in the normal matrix: a column-major block at
/// values[offset] with the given stride between columns. `transposed`: the first vertex is the block's
/// column.
struct BlockTarget {
  std::int64_t offset = 0;
  std::int32_t stride = 0;
  bool transposed = false;
};

/// The targets of all edges of a batch, made once per structure. Per edge of K vertices: K places in the
/// gradient and K (K + 1) / 2 blocks, pair (k, l <= k) at k (k + 1) / 2 + l. Held vertices point to a scratch
/// area behind the numbers, so that the kernels have no branch for them.
struct Scatter {
  std::vector<std::int64_t> gradient;
  std::vector<BlockTarget> blocks;
};

/// What a pass over the edges reads.
struct ValueView {
  const double* values = nullptr;         ///< all vertices' numbers
  const std::int64_t* offsets = nullptr;  ///< start of each vertex in `values`
};

/// What linearisation adds to: H += w J^T Omega J, g += w J^T Omega e.
struct NormalView {
  double* hessian = nullptr;
  double* gradient = nullptr;
};

/// Per vertex: how it moves under the three rigid motions (Graph::rigid_motions), 3 columns at offset 3 *
/// tangent.
struct RigidMotionView {
  const double* columns = nullptr;
  const std::int64_t* offsets = nullptr;     ///< -1: the vertex is held or does not move
  const std::int32_t* components = nullptr;  ///< per vertex
  Eigen::Matrix3d* information = nullptr;    ///< per component, added to
};

class EdgeBatchBase {
 public:
  virtual ~EdgeBatchBase();
  [[nodiscard]] virtual std::unique_ptr<EdgeBatchBase> clone() const = 0;

  [[nodiscard]] virtual std::size_t size() const = 0;
  [[nodiscard]] virtual std::span<const VertexIndex> vertices(std::size_t edge) const = 0;
  [[nodiscard]] virtual int error_dimension(std::size_t edge) const = 0;

  /// Appends an edge from its numbers: vertices with their types, fields in schema order, full information
  /// matrix.
  virtual void append(std::span<const VertexIndex> vertices, std::span<const VertexType* const> types,
                      std::span<const double> fields, const Eigen::MatrixXd& information) = 0;
  /// The numbers of an edge, in schema order, appended to `out`.
  virtual void fields(std::size_t edge, std::vector<double>& out) const = 0;
  [[nodiscard]] virtual Eigen::MatrixXd information(std::size_t edge) const = 0;

  /// Sum of rho(e^T Omega e). Non-finite when an error is.
  [[nodiscard]] virtual double chi2(const ValueView& view) const = 0;
  /// Adds the batch's part to the normal equations and returns its chi2.
  virtual double linearize(const ValueView& view, const Scatter& scatter, const NormalView& normal) const = 0;
  /// One edge's error and Jacobians (one matrix per vertex), without information and loss: for checks and
  /// tests.
  virtual void linearize_edge(std::size_t edge, const ValueView& view, Eigen::VectorXd& error,
                              std::vector<Eigen::MatrixXd>& jacobians) const = 0;
  /// The same by dual numbers even where the type has a linearize(...) of its own.
  virtual void differentiate_edge(std::size_t edge, const ValueView& view, Eigen::VectorXd& error,
                                  std::vector<Eigen::MatrixXd>& jacobians) const = 0;
  /// Adds (sum_k J_k T_k)^T Omega (sum_k J_k T_k) to the component of each edge: what it knows of rigid
  /// motions.
  virtual void add_rigid_information(const ValueView& view, const RigidMotionView& motion) const = 0;

  /// The loss of every edge that has none of its own.
  void set_loss(Loss loss) { batch_loss_ = std::move(loss); }
  void set_loss(std::size_t edge, Loss loss);
  /// The loss of an edge; null: none (rho(s) = s).
  [[nodiscard]] const Loss* loss(std::size_t edge) const;
  [[nodiscard]] const Loss* batch_loss() const { return batch_loss_.evaluate ? &batch_loss_ : nullptr; }

 protected:
  EdgeBatchBase() = default;
  EdgeBatchBase(const EdgeBatchBase&) = default;
  EdgeBatchBase& operator=(const EdgeBatchBase&) = default;

  [[nodiscard]] bool has_loss() const { return batch_loss_.evaluate != nullptr || !edge_loss_.empty(); }
  [[nodiscard]] LossValue evaluate_loss(std::size_t edge, double squared) const;

 private:
  Loss batch_loss_;
  std::vector<Loss> losses_;  // those attached to single edges, each once
  std::vector<std::int32_t>
      edge_loss_;  // per edge an index into losses_, -1: the batch's; empty: none attached
};

}  // namespace waymark
