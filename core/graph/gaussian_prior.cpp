#include <utility>

#include <waymark/core/base/error.hpp>
#include <waymark/core/graph/detail/dense_edge.hpp>
#include <waymark/core/graph/gaussian_prior.hpp>
#include <waymark/core/linear/detail/information_root.hpp>

namespace waymark {

std::unique_ptr<EdgeBatchBase> GaussianPriorBatch::clone() const {
  return std::make_unique<GaussianPriorBatch>(*this);
}

int GaussianPriorBatch::error_dimension(std::size_t i) const {
  return static_cast<int>(records_[i].offset.size());
}

void GaussianPriorBatch::append(std::span<const VertexIndex> vertices,
                                std::span<const VertexType* const> types, std::span<const double> fields,
                                const Eigen::MatrixXd& information) {
  Record record;
  record.vertices.assign(vertices.begin(), vertices.end());
  std::size_t values = 0;
  std::size_t tangents = 0;
  for (const VertexType* type : types) {
    record.types.push_back(*type);
    values += static_cast<std::size_t>(type->value_size);
    tangents += static_cast<std::size_t>(type->tangent_size);
  }
  const auto dimension = static_cast<Eigen::Index>(tangents);
  if (fields.size() != values + tangents || information.rows() != dimension ||
      information.cols() != dimension) {
    throw UsageError("EDGE_GAUSSIAN_PRIOR: expected " + std::to_string(values) +
                     " reference values, an offset of " + std::to_string(tangents) +
                     " numbers and an information matrix of that size");
  }
  record.reference.assign(fields.begin(), fields.begin() + static_cast<std::ptrdiff_t>(values));
  record.offset = Eigen::Map<const Eigen::VectorXd>(fields.data() + values, dimension);
  record.information = information;
  add_record(std::move(record));
}

void GaussianPriorBatch::add_record(Record record) {
  record.first_gradient = 0;
  record.first_block = 0;
  if (!records_.empty()) {
    const Record& before = records_.back();
    const std::size_t arity = before.vertices.size();
    record.first_gradient = before.first_gradient + arity;
    record.first_block = before.first_block + arity * (arity + 1) / 2;
  }
  records_.push_back(std::move(record));
}

void GaussianPriorBatch::remove_records(std::span<const char> gone, std::span<const VertexIndex> new_index) {
  std::vector<Record> before = std::exchange(records_, {});
  for (std::size_t i = 0; i < before.size(); ++i) {
    if (gone[i] != 0) continue;
    for (VertexIndex& v : before[i].vertices) v = new_index[static_cast<std::size_t>(v)];
    add_record(std::move(before[i]));
  }
}

void GaussianPriorBatch::fields(std::size_t i, std::vector<double>& out) const {
  const Record& record = records_[i];
  out.insert(out.end(), record.reference.begin(), record.reference.end());
  out.insert(out.end(), record.offset.begin(), record.offset.end());
}

Eigen::VectorXd GaussianPriorBatch::error(const Record& record, const ValueView& view) {
  Eigen::VectorXd e(record.offset.size());
  const double* reference = record.reference.data();
  Eigen::Index row = 0;
  for (std::size_t k = 0; k < record.vertices.size(); ++k) {
    const VertexType& type = record.types[k];
    type.local(reference, view.values + view.offsets[record.vertices[k]], e.data() + row);
    reference += type.value_size;
    row += type.tangent_size;
  }
  return e - record.offset;
}

// Returns d local(r, x [+] delta) / d delta. It is exact if the chart is linear, as for all types
// of this project. A foreign manifold is differentiated by differences of fourth order; their step is long
// enough that the rounding of coordinates of some thousand metres stays below 1e-9.
Eigen::MatrixXd GaussianPriorBatch::jacobian(const Record& record, std::size_t vertex,
                                             const ValueView& view) {
  const VertexType& type = record.types[vertex];
  const int n = type.tangent_size;
  if (type.linear_chart) return Eigen::MatrixXd::Identity(n, n);
  const double* reference = record.reference.data();
  for (std::size_t k = 0; k < vertex; ++k) reference += record.types[k].value_size;
  const double* value = view.values + view.offsets[record.vertices[vertex]];
  const auto seen_at = [&](int column, double step) {
    std::vector<double> moved(value, value + type.value_size);
    Eigen::VectorXd delta = step * Eigen::VectorXd::Unit(n, column);
    type.retract(moved.data(), delta.data());
    type.local(reference, moved.data(), delta.data());
    return delta;
  };
  constexpr double kStep = 5e-4;
  Eigen::MatrixXd result(n, n);
  for (int column = 0; column < n; ++column) {
    const Eigen::VectorXd near = seen_at(column, kStep) - seen_at(column, -kStep);
    const Eigen::VectorXd far = seen_at(column, 2 * kStep) - seen_at(column, -2 * kStep);
    result.col(column) = (8 * near - far) / (12 * kStep);
  }
  return result;
}

double GaussianPriorBatch::chi2(const ValueView& view, EdgeRange range) const {
  double sum = 0;
  for (std::size_t i = range.first; i < range.last; ++i) {
    const Eigen::VectorXd e = error(records_[i], view);
    sum += evaluate_loss(i, e.dot(records_[i].information * e)).rho;
  }
  return sum;
}

double GaussianPriorBatch::linearize(const ValueView& view, const Scatter& scatter, EdgeRange range,
                                     const NormalView& normal) const {
  double sum = 0;
  Eigen::VectorXd e;
  std::vector<Eigen::MatrixXd> jacobians;
  for (std::size_t i = range.first; i < range.last; ++i) {
    const Record& record = records_[i];
    linearize_edge(i, view, e, jacobians);
    const LossValue loss = evaluate_loss(i, e.dot(record.information * e));
    sum += detail::add_dense_edge(e, jacobians, record.information, loss,
                                  scatter.gradient.data() + record.first_gradient,
                                  scatter.blocks.data() + record.first_block, normal);
  }
  return sum;
}

void GaussianPriorBatch::linearize_edge(std::size_t i, const ValueView& view, Eigen::VectorXd& e,
                                        std::vector<Eigen::MatrixXd>& jacobians) const {
  const Record& record = records_[i];
  e = error(record, view);
  jacobians.clear();
  Eigen::Index row = 0;
  for (std::size_t k = 0; k < record.vertices.size(); ++k) {
    const int n = record.types[k].tangent_size;
    jacobians.emplace_back(Eigen::MatrixXd::Zero(e.size(), n));
    jacobians.back().middleRows(row, n) = jacobian(record, k, view);
    row += n;
  }
}

void GaussianPriorBatch::add_rigid_information(const ValueView& view, const RigidMotionView& motion) const {
  Eigen::VectorXd e;
  std::vector<Eigen::MatrixXd> jacobians;
  for (std::size_t i = 0; i < records_.size(); ++i) {
    linearize_edge(i, view, e, jacobians);
    // In a prior without knowledge of its place, the information cancels only to rounding. Its root
    // is cleaned of rounding and cancels before it is squared.
    const Eigen::MatrixXd root = information_root(records_[i].information);
    Eigen::MatrixXd moved = Eigen::MatrixXd::Zero(root.rows(), 3);
    std::int32_t component = -1;
    for (std::size_t k = 0; k < jacobians.size(); ++k) {
      const VertexIndex vertex = records_[i].vertices[k];
      const std::int32_t own = motion.component[vertex];
      if (own < 0) continue;
      component = own;
      Eigen::MatrixXd columns(jacobians[k].cols(), 3);
      records_[i].types[k].rigid_motion(view.values + view.offsets[vertex], motion.places[own].centre,
                                        motion.places[own].extent, columns.data());
      moved += root * (jacobians[k] * columns);
    }
    if (component >= 0) motion.information[component] += moved.transpose() * moved;
  }
}

EdgeType gaussian_prior_type() {
  EdgeType type;
  type.tag = std::string(GaussianPriorBatch::kTag);
  type.form = "local";
  type.arity = EdgeType::kRuntimeArity;
  type.make_batch = [] { return std::make_unique<GaussianPriorBatch>(); };
  return type;
}

}  // namespace waymark
