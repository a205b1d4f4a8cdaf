/// EdgeBatch<E>: the contiguous records of one edge type, and the kernels over them.
#pragma once

#include <array>
#include <string>
#include <utility>

#include <waymark/core/base/detail/processor.hpp>
#include <waymark/core/base/detail/unrolled.hpp>
#include <waymark/core/base/export.hpp>
#include <waymark/core/base/guard.hpp>
#include <waymark/core/graph/detail/edge_contract.hpp>
#include <waymark/core/graph/detail/robust_information.hpp>
#include <waymark/core/graph/dual.hpp>
#include <waymark/core/graph/edge_batch.hpp>

namespace WAYMARK_EXPORT waymark {

/// Error and Jacobian types of an edge of error dimension D.
template <int D>
using ErrorVector = Eigen::Matrix<double, D, 1>;
template <int D, int N>
using JacobianMatrix = Eigen::Matrix<double, D, N>;

template <Edge E>
class EdgeBatch final : public EdgeBatchBase {
  static_assert(sizeof(EdgeContract<E>) > 0);
  static constexpr bool kUsable = EdgeRules<E>::kKept;  // false: the contract has stopped the compiler

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
    std::array<double, kDimension*(kDimension + 1) / 2> information;  // lower triangle, row by row
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
  [[nodiscard]] VertexTable vertex_table() const override {
    return {records_.empty() ? nullptr : records_.front().vertices.data(), sizeof(Record), kArity};
  }

  void append(const E& edge, const Indices& vertices, const Information& information) {
    add_record({edge, triangle(information), vertices});
  }

  void append(std::span<const VertexIndex> vertices, std::span<const VertexType* const>,
              std::span<const double> fields, const Eigen::MatrixXd& information) override {
    Record record{};
    std::copy_n(vertices.begin(), kArity, record.vertices.begin());
    std::size_t next = 0;
    for (const auto& f : E::fields()) {
      double* data = f.data(record.edge);
      for (int i = 0; i < f.size; ++i) data[i] = fields[next++];
    }
    record.information = triangle(information);
    add_record(std::move(record));
  }

  void reserve(std::size_t edges) override { records_.reserve(edges); }

  void fields(std::size_t i, std::vector<double>& out) const override {
    for (const auto& f : E::fields()) {
      const double* data = f.read(records_[i].edge);
      out.insert(out.end(), data, data + f.size);
    }
  }

  [[nodiscard]] Eigen::MatrixXd information(std::size_t i) const override { return square(records_[i]); }

  [[nodiscard]] std::optional<Sight> sight(std::size_t i) const override {
    if constexpr (requires(const E& edge) { edge.sight(); }) {
      return guarded([&] { return this->name_in(E::kTag, i, "sight"); }, E::kTag,
                     [&] { return std::optional<Sight>(records_[i].edge.sight()); });
    } else {
      return std::nullopt;
    }
  }

  using EdgeBatchBase::chi2;
  [[nodiscard]] double chi2(const ValueView& view, EdgeRange range) const override {
    return this->named(E::kTag, view, range, [&] {
#if defined(__x86_64__)
      if (has_fused_multiply()) return chi2_fused(view, range);
#endif
      return chi2_range(view, range);
    });
  }

  double linearize(const ValueView& view, const Scatter& scatter, EdgeRange range,
                   const NormalView& normal) const override {
    return this->named(E::kTag, view, range, [&] {
#if defined(__x86_64__)
      if (has_fused_multiply()) return linearize_fused(view, scatter, range, normal);
#endif
      return has_loss() ? linearize_range<true>(view, scatter, range, normal)
                        : linearize_range<false>(view, scatter, range, normal);
    });
  }

  void linearize_edge(std::size_t i, const ValueView& view, Eigen::VectorXd& e,
                      std::vector<Eigen::MatrixXd>& out) const override {
    ErrorVector<kDimension> fixed;
    Jacobians jacobians;
    this->named(E::kTag, view, one_edge(i), [&] { derive(records_[i], view, fixed, jacobians); });
    e = fixed;
    to_dynamic(jacobians, out);
  }

  void add_rigid_information(const ValueView& view, const RigidMotionView& motion) const override {
    for (const Record& record : records_) {
      if (is_blind(record, motion)) continue;
      ErrorVector<kDimension> e;
      Jacobians jacobians;
      Eigen::Matrix<double, kDimension, 3> moved = Eigen::Matrix<double, kDimension, 3>::Zero();
      std::int32_t component = -1;
      this->named(E::kTag, view, one_edge(static_cast<std::size_t>(&record - records_.data())), [&] {
        derive(record, view, e, jacobians);
        component = add_motion(record, view, jacobians, motion, moved, std::make_index_sequence<kArity>());
      });
      if (component >= 0) motion.information[component] += moved.transpose() * square(record) * moved;
    }
  }

 private:
  static EdgeRange one_edge(std::size_t edge) {
    return {static_cast<std::uint32_t>(edge), static_cast<std::uint32_t>(edge + 1)};
  }

  void remove_records(std::span<const char> gone, std::span<const VertexIndex> new_index) override {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < records_.size(); ++i) {
      if (gone[i] != 0) continue;
      Record& record = records_[kept++];
      record = records_[i];
      for (VertexIndex& v : record.vertices) v = new_index[static_cast<std::size_t>(v)];
    }
    records_.resize(kept);
  }

  using Triangle = std::array<double, kDimension*(kDimension + 1) / 2>;

  template <typename Derived>
  static Triangle triangle(const Eigen::MatrixBase<Derived>& matrix) {
    Triangle lower;
    std::size_t next = 0;
    for (int r = 0; r < kDimension; ++r) {
      for (int c = 0; c <= r; ++c) lower[next++] = matrix(r, c);
    }
    return lower;
  }

  /// Appends an edge after its prepare(). One that throws there does not enter.
  void add_record(Record record) {
    if constexpr (requires { record.edge.prepare(); })
      guarded([&] { return this->name_in(E::kTag, records_.size(), "prepare"); }, E::kTag,
              [&] { record.edge.prepare(); });
    records_.push_back(std::move(record));
  }

  static Information square(const Record& record) {
    Information full;
    std::size_t next = 0;
    for (int r = 0; r < kDimension; ++r) {
      for (int c = 0; c <= r; ++c) full(r, c) = full(c, r) = record.information[next++];
    }
    return full;
  }

  /// Returns Omega x for every column of x.
  template <int N>
  [[gnu::always_inline]] static JacobianMatrix<kDimension, N> times(const Triangle& information,
                                                                    const JacobianMatrix<kDimension, N>& x) {
    const auto entry = [&](int row, int column) __attribute__((always_inline)) {
      const int high = row > column ? row : column;
      const int low = row > column ? column : row;
      return information[static_cast<std::size_t>(high * (high + 1) / 2 + low)];
    };
    JacobianMatrix<kDimension, N> product;
    unrolled<0, N>([&](int c) __attribute__((always_inline)) {
      unrolled<0, kDimension>([&](int r) __attribute__((always_inline)) {
        double sum = entry(r, 0) * x(0, c);
        unrolled<1, kDimension>([&](int k) __attribute__((always_inline)) { sum += entry(r, k) * x(k, c); });
        product(r, c) = sum;
      });
    });
    return product;
  }

  [[gnu::always_inline]] double chi2_range(const ValueView& view, EdgeRange range) const {
    double sum = 0;
    const bool robust = has_loss();
    for (std::size_t i = range.first; i < range.last; ++i) {
      const Record& record = records_[i];
      const ErrorVector<kDimension> e = error(record, view, std::make_index_sequence<kArity>());
      const double squared = e.dot(times(record.information, e));
      sum += robust ? evaluate_loss(i, squared).rho : squared;
    }
    return sum;
  }

#if defined(__x86_64__)
  // Computes the same, compiled for processors with fused multiply-add.
  [[gnu::target("avx2,fma")]] double chi2_fused(const ValueView& view, EdgeRange range) const {
    return chi2_range(view, range);
  }
  [[gnu::target("avx2,fma")]] double linearize_fused(const ValueView& view, const Scatter& scatter,
                                                     EdgeRange range, const NormalView& normal) const {
    return has_loss() ? linearize_range<true>(view, scatter, range, normal)
                      : linearize_range<false>(view, scatter, range, normal);
  }
#endif

  template <bool kRobust>
  [[gnu::always_inline]] double linearize_range(const ValueView& view, const Scatter& scatter,
                                                EdgeRange range, const NormalView& normal) const {
    double sum = 0;
    const std::uint32_t* gradient = scatter.gradient.data() + std::size_t{range.first} * kArity;
    const BlockTarget* blocks = scatter.blocks.data() + std::size_t{range.first} * kPairs;
    for (std::size_t i = range.first; i < range.last; ++i, gradient += kArity, blocks += kPairs) {
      const Record& record = records_[i];
      ErrorVector<kDimension> e;
      Jacobians jacobians;
      derive(record, view, e, jacobians);
      const auto add_part = [&](const Triangle& information, const ErrorVector<kDimension>& weighted_error)
          __attribute__((always_inline)) {
        if constexpr (carries()) {
          add_carried<VertexOf<0>>(record, view, jacobians, information, weighted_error, gradient, blocks,
                                   normal);
        } else {
          add(jacobians, information, weighted_error, gradient, blocks, normal,
              std::make_index_sequence<kArity>());
        }
      };
      const ErrorVector<kDimension> weighted_error = times(record.information, e);
      const double squared = e.dot(weighted_error);
      if constexpr (kRobust) {
        const LossValue loss = evaluate_loss(i, squared);
        sum += loss.rho;
        const Information linearized =
            normal.evidence_weight > 0
                ? Information(std::min(loss.weight, normal.evidence_weight) * square(record))
                : Information(robust_information(loss, squared, square(record), e));
        add_part(triangle(linearized), loss.weight * weighted_error);
      } else {
        sum += squared;
        add_part(record.information, weighted_error);
      }
    }
    return sum;
  }

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
  [[gnu::always_inline]] static auto load(const Record& record, const ValueView& view) {
    static constexpr std::array<double, VertexOf<K>::kTangentSize> kZero{};
    return VertexOf<K>::template at<double>(value<K>(record, view), kZero.data());
  }

  template <std::size_t... K>
  [[gnu::always_inline]] static ErrorVector<kDimension> error(const Record& record, const ValueView& view,
                                                              std::index_sequence<K...>) {
    if constexpr (kUsable) {
      return record.edge.template error<double>(load<K>(record, view)...);
    } else {
      return {};
    }
  }

  [[gnu::always_inline]] static void derive(const Record& record, const ValueView& view,
                                            ErrorVector<kDimension>& e, Jacobians& jacobians) {
    derive_impl(record, view, e, jacobians, std::make_index_sequence<kArity>());
  }

  template <std::size_t... K>
  [[gnu::always_inline]] static void derive_impl(const Record& record, const ValueView& view,
                                                 ErrorVector<kDimension>& e, Jacobians& jacobians,
                                                 std::index_sequence<K...> sequence) {
    if constexpr (requires {
                    record.edge.linearize(load<K>(record, view)..., e, std::get<K>(jacobians)...);
                  }) {
      record.edge.linearize(load<K>(record, view)..., e, std::get<K>(jacobians)...);
    } else {
      differentiate(record, view, e, jacobians, sequence);
    }
  }

  /// Returns the offset of the tangent of vertex K among the derivative lanes of the edge.
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
    if constexpr (kUsable) {
      const Eigen::Matrix<Scalar, kDimension, 1> dual =
          record.edge.template error<Scalar>(load_dual<K>(record, view)...);
      for (int row = 0; row < kDimension; ++row) {
        e[row] = dual[row].value;
        ((std::get<K>(jacobians).row(row) = dual[row]
                                                .derivative.matrix()
                                                .template segment<VertexOf<K>::kTangentSize>(lane<K>())
                                                .transpose()),
         ...);
      }
    }
  }

  /// Tells whether J_0 = -J_1 T: a relative error between two vertices of a type with carry().
  static constexpr bool carries() {
    if constexpr (requires { requires E::kRelative; } && kArity == 2) {
      using V = VertexOf<0>;
      using Row = Eigen::Matrix<double, 1, V::kTangentSize>;
      return std::is_same_v<V, VertexOf<kArity - 1>> && requires(const double* value, Row& row) {
        V::template carry<1>(value, value, row);
      };
    } else {
      return false;
    }
  }

  /// Adds the same as add() if J_0 = -J_1 T. With P = J_1^T Omega J_1 the blocks are P, -P T and
  /// T^T P T. With q = J_1^T Omega e the gradient is q and -T^T q. T costs only a few operations.
  template <typename V>  // a template, so that types without carry() need not compile it
  [[gnu::always_inline]] static void add_carried(const Record& record, const ValueView& view,
                                                 const Jacobians& jacobians, const Triangle& information,
                                                 const ErrorVector<kDimension>& weighted_error,
                                                 const std::uint32_t* gradient, const BlockTarget* blocks,
                                                 const NormalView& normal) {
    constexpr int kSize = V::kTangentSize;
    using Block = Eigen::Matrix<double, kSize, kSize>;
    const auto& jacobian = std::get<kArity - 1>(jacobians);
    const double* from = value<0>(record, view);
    const double* to = value<kArity - 1>(record, view);
    Eigen::Matrix<double, 1, kSize> row;
    unrolled<0, kSize>([&](int c) __attribute__((always_inline)) {
      double sum = jacobian(0, c) * weighted_error[0];
      unrolled<1, kDimension>([&](int r) __attribute__((always_inline)) {
        sum += jacobian(r, c) * weighted_error[r];
      });
      row(0, c) = sum;
    });
    add_to<kSize>(
        normal.gradient + gradient[1], [&](int c) __attribute__((always_inline)) { return row(0, c); });
    V::template carry<1>(from, to, row);
    add_to<kSize>(
        normal.gradient + gradient[0], [&](int c) __attribute__((always_inline)) { return -row(0, c); });
    Block p;
    const JacobianMatrix<kDimension, kSize> left = times(information, jacobian);
    unrolled<0, kSize>([&](int c) __attribute__((always_inline)) {
      unrolled<0, kSize>([&](int r) __attribute__((always_inline)) {
        if (r < c) return;
        double sum = left(0, r) * jacobian(0, c);
        unrolled<1, kDimension>([&](int k)
                                    __attribute__((always_inline)) { sum += left(k, r) * jacobian(k, c); });
        p(r, c) = p(c, r) = sum;
      });
    });
    place_block(p, blocks[2], normal.hessian);
    V::template carry<kSize>(from, to, p);  // P T
    Block turned;
    unrolled<0, kSize>([&](int c) __attribute__((always_inline)) {
      unrolled<0, kSize>([&](int r) __attribute__((always_inline)) {
        turned(r, c) = p(c, r);
        p(c, r) = -p(c, r);
      });
    });
    place_block(p, blocks[1], normal.hessian);
    V::template carry<kSize>(from, to, turned);  // (P T)^T T
    place_block(turned, blocks[0], normal.hessian);
  }

  template <int N, typename Value>
  [[gnu::always_inline]] static void add_to(double* place, const Value& value_of) {
    unrolled<0, N>([&](int i) __attribute__((always_inline)) { place[i] += value_of(i); });
  }

  template <std::size_t... K>
  [[gnu::always_inline]] static void add(const Jacobians& jacobians, const Triangle& information,
                                         const ErrorVector<kDimension>& weighted_error,
                                         const std::uint32_t* gradient, const BlockTarget* blocks,
                                         const NormalView& normal, std::index_sequence<K...>) {
    (add_row<K>(jacobians, information, weighted_error, gradient, blocks, normal), ...);
  }

  template <std::size_t K>
  [[gnu::always_inline]] static void add_row(const Jacobians& jacobians, const Triangle& information,
                                             const ErrorVector<kDimension>& weighted_error,
                                             const std::uint32_t* gradient, const BlockTarget* blocks,
                                             const NormalView& normal) {
    constexpr int kSize = VertexOf<K>::kTangentSize;
    const auto& jacobian = std::get<K>(jacobians);
    double* place = normal.gradient + gradient[K];
    unrolled<0, kSize>([&](int c) __attribute__((always_inline)) {
      double sum = jacobian(0, c) * weighted_error[0];
      unrolled<1, kDimension>([&](int r) __attribute__((always_inline)) {
        sum += jacobian(r, c) * weighted_error[r];
      });
      place[c] += sum;
    });
    const JacobianMatrix<kDimension, kSize> left = times(information, jacobian);
    unrolled<0, static_cast<int>(K) + 1>([&](auto l) __attribute__((always_inline)) {
      constexpr std::size_t kOther = decltype(l)::value;
      add_block<K == kOther>(left, std::get<kOther>(jacobians), blocks[K * (K + 1) / 2 + kOther],
                             normal.hessian);
    });
  }

  // The block (k, l) is (Omega J_k)^T J_l. Its place in the upper triangle is (l, k), unless k is
  // ordered first.
  template <bool kDiagonal, typename Left, typename Jacobian>
  [[gnu::always_inline]] static void add_block(const Left& left, const Jacobian& jacobian,
                                               const BlockTarget& target, double* hessian) {
    constexpr int kRows = Left::ColsAtCompileTime;
    constexpr int kColumns = Jacobian::ColsAtCompileTime;
    Eigen::Matrix<double, kRows, kColumns> product;
    unrolled<0, kColumns>([&](int c) __attribute__((always_inline)) {
      unrolled<0, kRows>([&](int r) __attribute__((always_inline)) {
        if (kDiagonal && r < c) return;
        double sum = left(0, r) * jacobian(0, c);
        unrolled<1, kDimension>([&](int k)
                                    __attribute__((always_inline)) { sum += left(k, r) * jacobian(k, c); });
        product(r, c) = sum;
        if constexpr (kDiagonal) product(c, r) = sum;
      });
    });
    place_block(product, target, hessian);
  }

  template <int kRows, int kColumns>
  [[gnu::always_inline]] static void place_block(const Eigen::Matrix<double, kRows, kColumns>& block,
                                                 const BlockTarget& target, double* hessian) {
    double* place = hessian + target.offset;
    if (target.stride < 0) {
      unrolled<0, kRows>([&](int r) __attribute__((always_inline)) {
        add_to<kColumns>(
            place, [&](int c) __attribute__((always_inline)) { return block(r, c); });
        place -= target.stride;
      });
    } else {
      unrolled<0, kColumns>([&](int c) __attribute__((always_inline)) {
        add_to<kRows>(
            place, [&](int r) __attribute__((always_inline)) { return block(r, c); });
        place += target.stride;
      });
    }
  }

  /// Tells whether the edge cannot observe a rigid motion: all its vertices take part in the
  /// motion, and its type is relative.
  static bool is_blind(const Record& record, const RigidMotionView& motion) {
    if constexpr (requires { E::kRelative; }) {
      bool all_move = E::kRelative;
      for (const VertexIndex v : record.vertices) all_move = all_move && motion.component[v] >= 0;
      return all_move;
    } else {
      return false;
    }
  }

  template <std::size_t... K>
  static std::int32_t add_motion(const Record& record, const ValueView& view, const Jacobians& jacobians,
                                 const RigidMotionView& motion, Eigen::Matrix<double, kDimension, 3>& moved,
                                 std::index_sequence<K...>) {
    std::int32_t component = -1;
    const auto add_one = [&]<std::size_t I>(std::integral_constant<std::size_t, I>) {
      using V = VertexOf<I>;
      const std::int32_t own = motion.component[record.vertices[I]];
      if constexpr (requires { &V::rigid_motion; }) {
        if (own < 0) return;
        component = own;
        Eigen::Matrix<double, V::kTangentSize, 3> columns;
        detail::rigid_motion_guarded<V>(value<I>(record, view), motion.places[own].centre,
                                        motion.places[own].extent, columns.data());
        moved += std::get<I>(jacobians) * columns;
      }
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
    (type.vertex_sizes.push_back(
         {E::Vertices::template Type<K>::kValueSize, E::Vertices::template Type<K>::kTangentSize}),
     ...);
  }
  (std::make_index_sequence<E::Vertices::kSize>());
  if constexpr (requires { E::kRelative; }) type.relative = E::kRelative;
  for (const auto& f : E::fields()) type.fields.push_back({std::string(f.name), f.size});
  type.make_batch = [] { return std::make_unique<EdgeBatch<E>>(); };
  return type;
}

}  // namespace waymark
