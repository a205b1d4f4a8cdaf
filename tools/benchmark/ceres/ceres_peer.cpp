// Only this file includes the headers of Ceres, because they are slow to compile.
#include <waymark/tools/benchmark/ceres/ceres_peer.hpp>

#include <array>
#include <chrono>
#include <map>
#include <memory>

#include <ceres/ceres.h>
#include <glog/logging.h>
#include <Eigen/Cholesky>

#include <waymark/core/base/error.hpp>
#include <waymark/core/system/gauge.hpp>
#include <waymark/core/system/held_marks.hpp>
#include <waymark/plugins/odometry/edge_odometry.hpp>
#include <waymark/types_se2/edge_gnss.hpp>
#include <waymark/types_se2/edge_se2.hpp>

// The dual number of Ceres keeps its value in another member than ours. The errors of types_se2
// find this overload by argument-dependent lookup.
namespace ceres {

template <int N>
Jet<double, N> wrap_angle(const Jet<double, N>& angle) {
  Jet<double, N> wrapped = angle;
  wrapped.a = waymark::wrap_angle(angle.a);
  return wrapped;
}

}  // namespace ceres

namespace waymark::benchmark {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

/// Returns R with R^T R = Omega, also for semidefinite Omega. Rows without information are zero.
Eigen::MatrixXd root_of(const Eigen::MatrixXd& omega) {
  const Eigen::LDLT<Eigen::MatrixXd> factor(omega);  // P^T L D L^T P
  // P as a matrix: from the right, Eigen 3.4 applies its swaps in the wrong order.
  const Eigen::MatrixXd p = factor.transpositionsP() * Eigen::MatrixXd::Identity(omega.rows(), omega.cols());
  const Eigen::MatrixXd upper = factor.matrixU();
  return factor.vectorD().cwiseMax(0).cwiseSqrt().asDiagonal() * (upper * p);
}

// ---- Costs of the edge types known here

template <Edge E, int K>
using VertexOf = typename E::Vertices::template Type<K>;

/// Returns a vertex in the form that errors take, at the parameters of Ceres.
template <Edge E, int K, typename T>
auto vertex_at(const T* parameters) {
  constexpr std::array<double, VertexOf<E, K>::kValueSize> kZero{};
  return VertexOf<E, K>::template at<T>(kZero.data(), parameters);
}

template <Edge E>
struct WeightedEdge {
  E edge;
  Eigen::Matrix<double, E::kErrorDimension, E::kErrorDimension> root;

  /// For automatic derivatives, by arity.
  template <typename T>
  bool operator()(const T* a, T* residual) const {
    return weigh<T>(edge.template error<T>(vertex_at<E, 0>(a)), residual);
  }
  template <typename T>
  bool operator()(const T* a, const T* b, T* residual) const {
    return weigh<T>(edge.template error<T>(vertex_at<E, 0>(a), vertex_at<E, 1>(b)), residual);
  }

 private:
  template <typename T>
  bool weigh(const Eigen::Matrix<T, E::kErrorDimension, 1>& error, T* residual) const {
    for (int row = 0; row < E::kErrorDimension; ++row) {
      residual[row] = error[0] * root(row, 0);
      for (int i = 1; i < E::kErrorDimension; ++i) residual[row] += error[i] * root(row, i);
    }
    return true;
  }
};

/// A cost with the Jacobians that the edge type gives.
template <Edge E, typename Sequence>
class AnalyticCost;

template <Edge E, std::size_t... K>
class AnalyticCost<E, std::index_sequence<K...>> final
    : public ceres::SizedCostFunction<E::kErrorDimension, VertexOf<E, K>::kTangentSize...> {
 public:
  explicit AnalyticCost(WeightedEdge<E> weighted) : weighted_(std::move(weighted)) {}

  bool Evaluate(double const* const* parameters, double* residual, double** jacobians) const override {
    ErrorVector<kDimension> e;
    if (jacobians == nullptr) {
      e = weighted_.edge.template error<double>(vertex_at<E, K>(parameters[K])...);
    } else {
      std::tuple<JacobianMatrix<kDimension, VertexOf<E, K>::kTangentSize>...> exact;
      weighted_.edge.linearize(vertex_at<E, K>(parameters[K])..., e, std::get<K>(exact)...);
      (weigh(std::get<K>(exact), jacobians[K]), ...);
    }
    Eigen::Map<ErrorVector<kDimension>>{residual} = weighted_.root * e;
    return true;
  }

 private:
  static constexpr int kDimension = E::kErrorDimension;

  template <int N>
  void weigh(const JacobianMatrix<kDimension, N>& jacobian, double* out) const {
    if (out == nullptr) return;  // the vertex is fixed
    Eigen::Map<Eigen::Matrix<double, kDimension, N, N == 1 ? Eigen::ColMajor : Eigen::RowMajor>>{out} =
        weighted_.root * jacobian;
  }

  WeightedEdge<E> weighted_;
};

template <typename E>
concept HasLinearize = requires {
  &E::linearize;
};
// The Jacobians of this edge type are faster than the automatic ones (MEASUREMENTS.md), and Ceres
// is measured at its best.
static_assert(HasLinearize<EdgeSe2>);

template <Edge E, std::size_t... K>
std::unique_ptr<ceres::CostFunction> make_cost(WeightedEdge<E> weighted, std::index_sequence<K...>) {
  if constexpr (HasLinearize<E>) {
    return std::make_unique<AnalyticCost<E, std::index_sequence<K...>>>(std::move(weighted));
  } else {
    using Automatic =
        ceres::AutoDiffCostFunction<WeightedEdge<E>, E::kErrorDimension, VertexOf<E, K>::kTangentSize...>;
    return std::make_unique<Automatic>(new WeightedEdge<E>(std::move(weighted)));  // Ceres owns it
  }
}

template <Edge E>
std::unique_ptr<ceres::CostFunction> make_typed_cost(const EdgeBatchBase& batch, std::size_t i) {
  std::vector<double> numbers;
  batch.fields(i, numbers);
  WeightedEdge<E> weighted{E(), root_of(batch.information(i))};
  const double* next = numbers.data();
  for (const auto& field : E::fields()) {
    std::copy_n(next, field.size, field.data(weighted.edge));
    next += field.size;
  }
  if constexpr (requires { weighted.edge.prepare(); }) weighted.edge.prepare();
  return make_cost<E>(std::move(weighted), std::make_index_sequence<E::Vertices::kSize>());
}

// ---- Everything else

using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

bool is_addition(const VertexType& type) {
  return type.linear_chart && type.value_size == type.tangent_size;
}

/// Returns the derivative of a retraction by its step, at step 0: value size x tangent size. It is taken by
/// differences. Ceres multiplies what tangent_to_value() returns by it, so its rounding cancels.
RowMajor retraction_jacobian(const VertexType& type, const double* value) {
  constexpr double kStep = 1e-5;
  RowMajor jacobian(type.value_size, type.tangent_size);
  for (int k = 0; k < type.tangent_size; ++k) {
    std::array<std::vector<double>, 2> moved;
    for (const std::size_t side : {0U, 1U}) {
      std::vector<double> step(static_cast<std::size_t>(type.tangent_size), 0.0);
      step[static_cast<std::size_t>(k)] = side == 0 ? kStep : -kStep;
      moved[side].assign(value, value + type.value_size);
      type.retract(moved[side].data(), step.data());
    }
    for (int row = 0; row < type.value_size; ++row)
      jacobian(row, k) =
          (moved[0][static_cast<std::size_t>(row)] - moved[1][static_cast<std::size_t>(row)]) / (2 * kStep);
  }
  return jacobian;
}

/// Returns the left inverse of retraction_jacobian().
RowMajor tangent_to_value(const RowMajor& plus) {
  return (plus.transpose() * plus).ldlt().solve(plus.transpose());
}

/// The chart of a vertex type as a manifold of Ceres.
class ChartManifold final : public ceres::Manifold {
 public:
  explicit ChartManifold(const VertexType& type) : type_(type) {}
  [[nodiscard]] int AmbientSize() const override { return type_.value_size; }
  [[nodiscard]] int TangentSize() const override { return type_.tangent_size; }
  bool Plus(const double* x, const double* delta, double* moved) const override {
    std::copy_n(x, type_.value_size, moved);
    type_.retract(moved, delta);
    return true;
  }
  bool PlusJacobian(const double* x, double* jacobian) const override {
    Eigen::Map<RowMajor>(jacobian, type_.value_size, type_.tangent_size) = retraction_jacobian(type_, x);
    return true;
  }
  bool Minus(const double* y, const double* x, double* delta) const override {
    type_.local(x, y, delta);
    return true;
  }
  bool MinusJacobian(const double* x, double* jacobian) const override {
    Eigen::Map<RowMajor>(jacobian, type_.tangent_size, type_.value_size) =
        tangent_to_value(retraction_jacobian(type_, x));
    return true;
  }

 private:
  VertexType type_;
};

/// Any other edge, through the interface of its batch: one virtual call and some allocations
/// per evaluation.
class GenericCost final : public ceres::CostFunction {
 public:
  /// @param scratch values of the whole graph; only one cost at a time may use it (one thread)
  GenericCost(const Graph& graph, const EdgeBatchBase& batch, std::size_t edge, std::vector<double>& scratch)
      : graph_(graph),
        batch_(batch),
        edge_(edge),
        scratch_(scratch),
        root_(root_of(batch.information(edge))) {
    set_num_residuals(batch.error_dimension(edge));
    for (const VertexIndex v : batch.vertices(edge))
      mutable_parameter_block_sizes()->push_back(graph.vertex_type(v).value_size);
  }

  bool Evaluate(double const* const* parameters, double* residual, double** jacobians) const override {
    const auto vertices = batch_.vertices(edge_);
    const std::vector<std::int64_t>& offsets = graph_.offsets();
    for (std::size_t k = 0; k < vertices.size(); ++k) {
      std::copy_n(parameters[k], parameter_block_sizes()[k],
                  scratch_.begin() + offsets[static_cast<std::size_t>(vertices[k])]);
    }
    Eigen::VectorXd e;
    std::vector<Eigen::MatrixXd> exact;
    batch_.linearize_edge(edge_, {scratch_.data(), offsets.data()}, e, exact);
    Eigen::Map<Eigen::VectorXd>(residual, num_residuals()) = root_ * e;
    for (std::size_t k = 0; jacobians != nullptr && k < vertices.size(); ++k) {
      if (jacobians[k] == nullptr) continue;
      const VertexType& type = graph_.vertex_type(vertices[k]);
      Eigen::Map<RowMajor> out(jacobians[k], num_residuals(), parameter_block_sizes()[k]);
      if (is_addition(type)) {
        out = root_ * exact[k];
      } else {
        out = root_ * exact[k] * tangent_to_value(retraction_jacobian(type, parameters[k]));
      }
    }
    return true;
  }

 private:
  const Graph& graph_;
  const EdgeBatchBase& batch_;
  std::size_t edge_;
  std::vector<double>& scratch_;
  Eigen::MatrixXd root_;
};

/// Our loss in the form that Ceres needs: rho, rho', rho''.
class LossAdapter final : public ceres::LossFunction {
 public:
  explicit LossAdapter(Loss loss) : loss_(std::move(loss)) {}
  void Evaluate(double squared, double out[3]) const override {
    const LossValue value = loss_.evaluate(squared, loss_.scale);
    out[0] = value.rho;
    out[1] = value.weight;
    out[2] = value.curvature;
  }

 private:
  Loss loss_;
};

// ---- The problem

/// A tag has only one meaning, so the tag chooses the cost.
using CostMaker = std::unique_ptr<ceres::CostFunction> (*)(const EdgeBatchBase&, std::size_t);
CostMaker typed_cost(std::string_view tag) {
  static const std::map<std::string_view, CostMaker> makers = {
      {EdgeSe2::kTag, &make_typed_cost<EdgeSe2>},
      {EdgeSe2Log::kTag, &make_typed_cost<EdgeSe2Log>},
      {plugins::odometry::EdgeSe2Odometry::kTag, &make_typed_cost<plugins::odometry::EdgeSe2Odometry>},
      {plugins::odometry::EdgeSe2Standstill::kTag, &make_typed_cost<plugins::odometry::EdgeSe2Standstill>},
      {EdgeGnssPosition::kTag, &make_typed_cost<EdgeGnssPosition>},
      {EdgePriorSe2::kTag, &make_typed_cost<EdgePriorSe2>},
      {EdgeSe2Xy::kTag, &make_typed_cost<EdgeSe2Xy>},
  };
  const auto found = makers.find(tag);
  return found == makers.end() ? nullptr : found->second;
}

class CeresProblem {
 public:
  explicit CeresProblem(const Graph& graph) : graph_(graph), values_(graph.values()), scratch_(values_) {
    for (std::size_t b = 0; b < graph.batch_count(); ++b) add_batch(graph.batch(b), graph.edge_type(b).tag);
    hold(find_gauge(graph).held);
  }

  [[nodiscard]] ceres::Problem& problem() { return problem_; }
  [[nodiscard]] const std::vector<double>& values() const { return values_; }
  [[nodiscard]] const std::vector<std::string>& notes() const { return notes_; }

 private:
  double* block(VertexIndex v) { return values_.data() + graph_.offsets()[static_cast<std::size_t>(v)]; }

  void add_batch(const EdgeBatchBase& batch, const std::string& tag) {
    const CostMaker typed = typed_cost(tag);
    std::vector<double*> blocks;
    for (std::size_t i = 0; i < batch.size(); ++i) {
      blocks.clear();
      for (const VertexIndex v : batch.vertices(i)) blocks.push_back(block_with_chart(v));
      auto cost =
          typed != nullptr ? typed(batch, i) : std::make_unique<GenericCost>(graph_, batch, i, scratch_);
      const Loss* loss = batch.loss(i);
      problem_.AddResidualBlock(cost.release(), loss == nullptr ? nullptr : new LossAdapter(*loss), blocks);
    }
    if (typed == nullptr && batch.size() > 0) {
      notes_.push_back("the peer evaluates " + std::to_string(batch.size()) + " edges " + tag +
                       " with a generic, slow cost function: do not compare its time");
    }
  }

  /// Returns the numbers of a vertex. If its retraction is no plain addition, Ceres knows its chart.
  double* block_with_chart(VertexIndex v) {
    const VertexType& type = graph_.vertex_type(v);
    if (is_addition(type) || problem_.HasParameterBlock(block(v))) return block(v);
    const auto [chart, is_new] = charts_.try_emplace(type.tag, nullptr);
    if (is_new) chart->second = std::make_unique<ChartManifold>(type);
    problem_.AddParameterBlock(block(v), type.value_size, chart->second.get());
    return block(v);
  }

  void hold(const std::vector<char>& held) {
    for (std::size_t i = 0; i < graph_.vertex_count(); ++i) {
      const auto v = static_cast<VertexIndex>(i);
      if (held[i] != 0 && !is_wholly_held(held[i]))
        throw InputError("the peer cannot hold single coordinates of vertex " + to_string(graph_.id(v)) +
                         ", which is anchored in part: FIX one vertex");
      if ((held[i] != 0 || graph_.fixed(v)) && problem_.HasParameterBlock(block(v)))
        problem_.SetParameterBlockConstant(block(v));
    }
  }

  const Graph& graph_;
  std::vector<double> values_;
  std::vector<double> scratch_;
  std::vector<std::string> notes_;
  std::map<std::string, std::unique_ptr<ceres::Manifold>> charts_;  // outlives the problem
  ceres::Problem problem_{[] {
    ceres::Problem::Options options;
    options.manifold_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
    return options;
  }()};
};

/// Stops Ceres at Ctrl-C.
class CancelCallback final : public ceres::IterationCallback {
 public:
  explicit CancelCallback(const std::atomic<bool>* cancel) : cancel_(cancel) {}
  ceres::CallbackReturnType operator()(const ceres::IterationSummary&) override {
    return cancel_ != nullptr && *cancel_ ? ceres::SOLVER_ABORT : ceres::SOLVER_CONTINUE;
  }

 private:
  const std::atomic<bool>* cancel_;
};

ceres::Solver::Options solver_options(const CeresOptions& options) {
  ceres::Solver::Options made;
  made.trust_region_strategy_type =
      options.method == CeresMethod::dogleg ? ceres::DOGLEG : ceres::LEVENBERG_MARQUARDT;
  made.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  made.num_threads = 1;
  made.max_num_iterations = options.max_iterations;
  made.function_tolerance = options.function_tolerance;
  made.logging_type = ceres::SILENT;
  return made;
}

}  // namespace

RunOutcome optimize_with_ceres(Graph& graph, const CeresOptions& options) {
  // Ceres's message about a failed factorisation is in its summary
  FLAGS_minloglevel = google::GLOG_FATAL;
  RunOutcome outcome;
  const auto setup_begin = Clock::now();
  CeresProblem problem(graph);
  outcome.setup_seconds = seconds_since(setup_begin);

  ceres::Solver::Options solver = solver_options(options);
  CancelCallback cancel(options.cancel);
  solver.callbacks.push_back(&cancel);
  ceres::Solver::Summary summary;
  const auto begin = Clock::now();
  ceres::Solve(solver, &problem.problem(), &summary);
  outcome.total_seconds = seconds_since(begin);

  outcome.initial_chi2 = 2 * summary.initial_cost;  // Ceres's cost is half of chi2
  outcome.structure_seconds = summary.preprocessor_time_in_seconds;
  outcome.linearize_seconds =
      summary.residual_evaluation_time_in_seconds + summary.jacobian_evaluation_time_in_seconds;
  outcome.solve_seconds = summary.linear_solver_time_in_seconds;
  // the first entry is the initial guess
  outcome.iterations = std::max(0, static_cast<int>(summary.iterations.size()) - 1);
  outcome.converged = summary.termination_type == ceres::CONVERGENCE;
  outcome.message = summary.message;
  outcome.solver_description =
      ceres::SparseLinearAlgebraLibraryTypeToString(summary.sparse_linear_algebra_library_type);
  outcome.notes = problem.notes();
  graph.set_values(problem.values());
  outcome.final_chi2 = graph.chi2();
  return outcome;
}

std::string ceres_version() {
  return std::string("Ceres ") + CERES_VERSION_STRING;
}

}  // namespace waymark::benchmark
