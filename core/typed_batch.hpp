/// EdgeBatch<E>: the contiguous records of one edge type and the kernels over them.
#pragma once

#include <array>
#include <utility>

#include <waymark/core/dual.hpp>
#include <waymark/core/edge_batch.hpp>

namespace waymark {

/// Error and Jacobian types of an edge of error dimension D.
template <int D>
using ErrorVector = Eigen::Matrix<double, D, 1>;
template <int D, int N>
using JacobianMatrix = Eigen::Matrix<double, D, N>;

template <Edge E>
class EdgeBatch final : public EdgeBatchBase {
 public:
  static constexpr int kArity = E::Vertices::kSize;
  static constexpr int kDimension = E::kErrorDimension;
  static constexpr int kPairs = kArity * (kArity + 1) / 2;
  template <int K>
  using VertexOf = typename E::Vertices::template Type<K>;
  using Indices = std::array<VertexIndex, kArity>;
  using Information = Eigen::Matrix<double, kDimension, kDimension, Eigen::DontAlign>;

  struct Record {
    E edge;
    Information information;
    Indices vertices;
  };

  [[nodiscard]] std::unique_ptr<EdgeBatchBase> clone() const override {
    return std::make_unique<EdgeBatch>(*this);
  }
  [[nodiscard]] std::size_t size() const override { return records_.size(); }
  [[nodiscard]] std::span<const VertexIndex> vertices(std::size_t i) const override {
    return records_[i].vertices;
  }
  [[nodiscard]] int error_dimension(std::size_t) const override { return kDimension; }
  [[nodiscard]] const Record& record(std::size_t i) const { return records_[i]; }

  void append(const E& edge, const Indices& vertices, const Information& information) {
    records_.push_back({edge, information, vertices});
  }

  void append(std::span<const VertexIndex> vertices, std::span<const VertexType* const>,
              std::span<const double> fields, const Eigen::MatrixXd& information) override {
    Record& record = records_.emplace_back();
    std::copy_n(vertices.begin(), kArity, record.vertices.begin());
    std::size_t next = 0;
    for (const auto& f : E::fields()) {
      double* data = f.data(record.edge);
      for (int i = 0; i < f.size; ++i) data[i] = fields[next++];
    }
    record.information = information;
  }

  void fields(std::size_t i, std::vector<double>& out) const override {
    E edge = records_[i].edge;
    for (const auto& f : E::fields()) {
      const double* data = f.data(edge);
      out.insert(out.end(), data, data + f.size);
    }
  }

  [[nodiscard]] Eigen::MatrixXd information(std::size_t i) const override { return records_[i].information; }

  [[nodiscard]] double chi2(const ValueView& view) const override {
    double sum = 0;
    const bool robust = has_loss();
    for (std::size_t i = 0; i < records_.size(); ++i) {
      const Record& record = records_[i];
      const ErrorVector<kDimension> e = error(record, view, std::make_index_sequence<kArity>());
      const double squared = e.dot(record.information * e);
      sum += robust ? evaluate_loss(i, squared).rho : squared;
    }
    return sum;
  }

  double linearize(const ValueView& view, const Scatter& scatter, const NormalView& normal) const override {
    double sum = 0;
    const bool robust = has_loss();
    const std::int64_t* gradient = scatter.gradient.data();
    const BlockTarget* blocks = scatter.blocks.data();
    for (std::size_t i = 0; i < records_.size(); ++i, gradient += kArity, blocks += kPairs) {
      const Record& record = records_[i];
      ErrorVector<kDimension> e;
      Jacobians jacobians;
      derive(record, view, e, jacobians);
      const double squared = e.dot(record.information * e);
      LossValue loss{squared, 1, 0};
      if (robust) loss = evaluate_loss(i, squared);
      sum += loss.rho;
      const Eigen::Matrix<double, kDimension, kDimension> weighted = loss.weight * record.information;
      add(jacobians, weighted, e, gradient, blocks, normal, std::make_index_sequence<kArity>());
    }
    return sum;
  }

  void linearize_edge(std::size_t i, const ValueView& view, Eigen::VectorXd& e,
                      std::vector<Eigen::MatrixXd>& out) const override {
    ErrorVector<kDimension> fixed;
    Jacobians jacobians;
    derive(records_[i], view, fixed, jacobians);
    e = fixed;
    to_dynamic(jacobians, out);
  }

  void differentiate_edge(std::size_t i, const ValueView& view, Eigen::VectorXd& e,
                          std::vector<Eigen::MatrixXd>& out) const override {
    ErrorVector<kDimension> fixed;
    Jacobians jacobians;
    differentiate(records_[i], view, fixed, jacobians, std::make_index_sequence<kArity>());
    e = fixed;
    to_dynamic(jacobians, out);
  }

  void add_rigid_information(const ValueView& view, const RigidMotionView& motion) const override {
    for (const Record& record : records_) {
      ErrorVector<kDimension> e;
      Jacobians jacobians;
      derive(record, view, e, jacobians);
      Eigen::Matrix<double, kDimension, 3> moved = Eigen::Matrix<double, kDimension, 3>::Zero();
      const std::int32_t component =
          add_motion(record, jacobians, motion, moved, std::make_index_sequence<kArity>());
      if (component >= 0) motion.information[component] += moved.transpose() * record.information * moved;
    }
  }

 private:
  template <typename Sequence>
  struct JacobianTuple;
  template <std::size_t... K>
  struct JacobianTuple<std::index_sequence<K...>> {
    using Type = std::tuple<JacobianMatrix<kDimension, VertexOf<K>::kTangentSize>...>;
  };
  using Jacobians = typename JacobianTuple<std::make_index_sequence<kArity>>::Type;

  template <std::size_t K>
  static const double* value(const Record& record, const ValueView& view) {
    return view.values + view.offsets[record.vertices[K]];
  }

  template <std::size_t K>
  static auto load(const Record& record, const ValueView& view) {
    static constexpr std::array<double, VertexOf<K>::kTangentSize> kZero{};
    return VertexOf<K>::template at<double>(value<K>(record, view), kZero.data());
  }

  template <std::size_t... K>
  static ErrorVector<kDimension> error(const Record& record, const ValueView& view,
                                       std::index_sequence<K...>) {
    return record.edge.template error<double>(load<K>(record, view)...);
  }

  static void derive(const Record& record, const ValueView& view, ErrorVector<kDimension>& e,
                     Jacobians& jacobians) {
    derive_impl(record, view, e, jacobians, std::make_index_sequence<kArity>());
  }

  template <std::size_t... K>
  static void derive_impl(const Record& record, const ValueView& view, ErrorVector<kDimension>& e,
                          Jacobians& jacobians, std::index_sequence<K...> sequence) {
    if constexpr (requires {
                    record.edge.linearize(load<K>(record, view)..., e, std::get<K>(jacobians)...);
                  }) {
      record.edge.linearize(load<K>(record, view)..., e, std::get<K>(jacobians)...);
    } else {
      differentiate(record, view, e, jacobians, sequence);
    }
  }

  /// Offset of vertex K's tangent among the edge's derivative lanes.
  template <std::size_t K>
  static constexpr int lane() {
    return []<std::size_t... L>(std::index_sequence<L...>) {
      return (0 + ... + VertexOf<L>::kTangentSize);
    }
    (std::make_index_sequence<K>());
  }

  using Scalar = Dual<E::Vertices::kTangentSize>;

  template <std::size_t K>
  static auto load_dual(const Record& record, const ValueView& view) {
    std::array<Scalar, VertexOf<K>::kTangentSize> delta;
    for (int i = 0; i < VertexOf<K>::kTangentSize; ++i)
      delta[static_cast<std::size_t>(i)] = Scalar::variable(0, lane<K>() + i);
    return VertexOf<K>::template at<Scalar>(value<K>(record, view), delta.data());
  }

  template <std::size_t... K>
  static void differentiate(const Record& record, const ValueView& view, ErrorVector<kDimension>& e,
                            Jacobians& jacobians, std::index_sequence<K...>) {
    const Eigen::Matrix<Scalar, kDimension, 1> dual =
        record.edge.template error<Scalar>(load_dual<K>(record, view)...);
    for (int row = 0; row < kDimension; ++row) {
      e[row] = dual[row].value;
      ((std::get<K>(jacobians).row(row) =
            dual[row].derivative.matrix().template segment<VertexOf<K>::kTangentSize>(lane<K>()).transpose()),
       ...);
    }
  }

  template <std::size_t... K>
  static void add(const Jacobians& jacobians,
                  const Eigen::Matrix<double, kDimension, kDimension>& information,
                  const ErrorVector<kDimension>& e, const std::int64_t* gradient, const BlockTarget* blocks,
                  const NormalView& normal, std::index_sequence<K...>) {
    const ErrorVector<kDimension> weighted_error = information * e;
    (add_row<K>(jacobians, information, weighted_error, gradient, blocks, normal), ...);
  }

  template <std::size_t K>
  static void add_row(const Jacobians& jacobians,
                      const Eigen::Matrix<double, kDimension, kDimension>& information,
                      const ErrorVector<kDimension>& weighted_error, const std::int64_t* gradient,
                      const BlockTarget* blocks, const NormalView& normal) {
    constexpr int kSize = VertexOf<K>::kTangentSize;
    const auto& jacobian = std::get<K>(jacobians);
    Eigen::Map<Eigen::Matrix<double, kSize, 1>>(normal.gradient + gradient[K]) +=
        jacobian.transpose() * weighted_error;
    const Eigen::Matrix<double, kSize, kDimension> left = jacobian.transpose() * information;
    [&]<std::size_t... L>(std::index_sequence<L...>) {
      (add_block(left, std::get<L>(jacobians), blocks[K * (K + 1) / 2 + L], normal.hessian), ...);
    }
    (std::make_index_sequence<K + 1>());
  }

  // The block (k, l) is J_k^T Omega J_l; its place in the upper triangle is (l, k), unless k is ordered
  // first.
  template <typename Left, typename Jacobian>
  static void add_block(const Left& left, const Jacobian& jacobian, const BlockTarget& target,
                        double* hessian) {
    constexpr int kRows = Left::RowsAtCompileTime;
    constexpr int kColumns = Jacobian::ColsAtCompileTime;
    const Eigen::Matrix<double, kRows, kColumns> product = left * jacobian;
    // Column by column: a block of one row would be row-major to Eigen, whatever the stride says.
    double* place = hessian + target.offset;
    if (target.transposed) {
      for (int c = 0; c < kRows; ++c, place += target.stride)
        Eigen::Map<Eigen::Matrix<double, kColumns, 1>>{place} += product.row(c).transpose();
    } else {
      for (int c = 0; c < kColumns; ++c, place += target.stride)
        Eigen::Map<Eigen::Matrix<double, kRows, 1>>{place} += product.col(c);
    }
  }

  template <std::size_t... K>
  static std::int32_t add_motion(const Record& record, const Jacobians& jacobians,
                                 const RigidMotionView& motion, Eigen::Matrix<double, kDimension, 3>& moved,
                                 std::index_sequence<K...>) {
    std::int32_t component = -1;
    const auto add_one = [&]<std::size_t I>(std::integral_constant<std::size_t, I>) {
      const VertexIndex vertex = record.vertices[I];
      const std::int64_t offset = motion.offsets[vertex];
      if (offset < 0) return;
      component = motion.components[vertex];
      constexpr int kSize = VertexOf<I>::kTangentSize;
      moved +=
          std::get<I>(jacobians) * Eigen::Map<const Eigen::Matrix<double, kSize, 3>>(motion.columns + offset);
    };
    (add_one(std::integral_constant<std::size_t, K>()), ...);
    return component;
  }

  static void to_dynamic(const Jacobians& jacobians, std::vector<Eigen::MatrixXd>& out) {
    out.clear();
    std::apply([&](const auto&... jacobian) { (out.emplace_back(jacobian), ...); }, jacobians);
  }

  std::vector<Record> records_;
};

template <Edge E>
[[nodiscard]] EdgeType make_edge_type() {
  EdgeType type;
  type.tag = std::string(std::string_view(E::kTag));
  if constexpr (requires { E::kForm; }) type.form = std::string(std::string_view(E::kForm));
  type.arity = E::Vertices::kSize;
  type.error_dimension = E::kErrorDimension;
  [&]<std::size_t... K>(std::index_sequence<K...>) {
    (type.vertex_tags.emplace_back(std::string_view(E::Vertices::template Type<K>::kTag)), ...);
  }
  (std::make_index_sequence<E::Vertices::kSize>());
  for (const auto& f : E::fields()) type.fields.push_back({std::string(f.name), f.size});
  type.make_batch = [] { return std::make_unique<EdgeBatch<E>>(); };
  return type;
}

}  // namespace waymark
