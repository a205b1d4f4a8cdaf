#include <algorithm>
#include <cmath>
#include <cstdlib>

#include <waymark/core/base/detail/index.hpp>
#include <waymark/core/graph/detail/robust_information.hpp>
#include <waymark/core/system/normal_equations.hpp>

namespace waymark {
namespace {

using detail::at;

/// A held coordinate has so many times the information that the edges give it: its sigma is a millionth.
constexpr double kHeldInformation = 1e12;

}  // namespace

NormalEquations::NormalEquations(const Graph& graph, const Structure& structure)
    : graph_(graph), structure_(structure) {}

template <typename Work>
double NormalEquations::sum_over_chunks(const Work& work) const {
  const int last = structure_.chunks() - 1;
  sums_.assign(at(last) + 1, 0.0);
  const auto one_chunk = [&](int chunk) {
    double sum = 0;
    for (std::size_t b = 0; b < graph_.batch_count(); ++b) {
      const Scatter& scatter = structure_.scatter(b);
      for (auto r = scatter.chunk[at(chunk)]; r < scatter.chunk[at(chunk) + 1]; ++r) {
        sum += work(b, scatter.ranges[r]);
      }
    }
    sums_[at(chunk)] = sum;
  };
  run_parallel(pool_, last, one_chunk);
  one_chunk(last);
  double total = 0;
  for (const double sum : sums_) total += sum;
  return total;
}

double NormalEquations::linearize_edges(const ValueView& view, std::span<const double> evidence_weights) {
  hessian_.assign(at(structure_.hessian_size()), 0.0);
  gradient_.assign(at(structure_.gradient_size()), 0.0);
  diagonal_known_ = false;
  return sum_over_chunks([&](std::size_t batch, EdgeRange range) {
    const NormalView normal{hessian_.data(), gradient_.data(),
                            evidence_weights.empty() ? 0 : evidence_weights[batch]};
    return graph_.batch(batch).linearize(view, structure_.scatter(batch), range, normal);
  });
}

double NormalEquations::linearize(const std::vector<double>& values,
                                  std::span<const double> evidence_weights) {
  const double chi2 = linearize_edges({values.data(), graph_.offsets().data()}, evidence_weights);
  structure_.add_slots(hessian_.data(), gradient_.data());
  hold_coordinates();
  return chi2;
}

double NormalEquations::linearize_with_concave_terms(const std::vector<double>& values) {
  const ValueView view{values.data(), graph_.offsets().data()};
  const double chi2 = linearize_edges(view, {});
  for (std::size_t b = 0; b < graph_.batch_count(); ++b) add_concave_terms(b, view);
  structure_.add_slots(hessian_.data(), gradient_.data());
  hold_coordinates();
  return chi2;
}

/// Returns the place in hessian() of the diagonal element of a held coordinate.
std::size_t NormalEquations::place_of(const HeldCoordinate& held) const {
  const BlockPattern& p = pattern();
  const int height = p.height[at(held.column)];
  const int row = height - p.size[at(held.column)] + held.coordinate;
  return at(p.value[at(held.column)] + std::int64_t{held.coordinate} * height + row);
}

void NormalEquations::hold_coordinates() {
  for (const HeldCoordinate& held : structure_.held_coordinates()) {
    double own = 0;  // what the edges know of it; where they know nothing, of the others of its vertex
    for (int k = 0; k < pattern().size[at(held.column)]; ++k)
      own = std::max(own, hessian_[place_of({held.column, k})]);
    double& information = hessian_[place_of(held)];
    information = kHeldInformation * (information > 0 ? information : own);
  }
}

double NormalEquations::log_of_held_information() const {
  double sum = 0;
  for (const HeldCoordinate& held : structure_.held_coordinates()) sum += std::log(hessian_[place_of(held)]);
  return sum;
}

void NormalEquations::add_concave_terms(std::size_t batch, const ValueView& view) {
  const EdgeBatchBase& edges = graph_.batch(batch);
  const auto arity = at(edges.vertex_table().arity);
  const std::size_t pairs = arity * (arity + 1) / 2;
  Eigen::VectorXd error;
  std::vector<Eigen::MatrixXd> jacobians;
  for (std::size_t e = 0; arity > 0 && e < edges.size(); ++e) {
    const Loss* loss = edges.loss(e);
    if (loss == nullptr) continue;
    edges.linearize_edge(e, view, error, jacobians);
    const Eigen::VectorXd along = edges.information(e) * error;
    const double squared = error.dot(along);
    const LossValue value = loss->at(squared);
    const bool is_left_out = value.curvature < 0 && curvature_factor(value, squared) == 1;
    if (!is_left_out) continue;
    const BlockTarget* block = structure_.scatter(batch).blocks.data() + e * pairs;
    for (std::size_t k = 0; k < arity; ++k) {
      const Eigen::VectorXd left = 2 * value.curvature * (jacobians[k].transpose() * along);
      for (std::size_t l = 0; l <= k; ++l, ++block) {
        const Eigen::VectorXd right = jacobians[l].transpose() * along;
        const bool turned = block->stride < 0;
        const Eigen::VectorXd& rows = turned ? right : left;
        const Eigen::VectorXd& columns = turned ? left : right;
        Eigen::Map<Eigen::MatrixXd, 0, Eigen::OuterStride<>>(
            hessian_.data() + block->offset, rows.size(), columns.size(),
            Eigen::OuterStride<>(std::abs(block->stride))) += rows * columns.transpose();
      }
    }
  }
}

double NormalEquations::chi2(const std::vector<double>& values) const {
  const ValueView view{values.data(), graph_.offsets().data()};
  return sum_over_chunks(
      [&](std::size_t batch, EdgeRange range) { return graph_.batch(batch).chi2(view, range); });
}

const Eigen::VectorXd& NormalEquations::diagonal() const {
  if (diagonal_known_) return diagonal_;
  const BlockPattern& p = pattern();
  diagonal_.resize(p.dimension());
  for (std::size_t j = 0; j < p.size.size(); ++j) {
    const int size = p.size[j];
    const int height = p.height[j];
    const double* block = hessian_.data() + p.value[j] + height - size;
    for (int c = 0; c < size; ++c, block += height + 1) diagonal_[p.start[j] + c] = *block;
  }
  diagonal_known_ = true;
  return diagonal_;
}

void NormalEquations::add_to_diagonal(const Eigen::VectorXd& extra, std::vector<double>& damped) const {
  const BlockPattern& p = pattern();
  damped.assign(hessian_.begin(), hessian_.begin() + p.value_count());
  for (int j = 0; j < p.columns(); ++j) {
    const int size = p.size[at(j)];
    const int height = p.height[at(j)];
    for (int c = 0; c < size; ++c) {
      damped[at(p.value[at(j)] + std::int64_t{c} * height + height - size + c)] += extra[p.start[at(j)] + c];
    }
  }
}

void NormalEquations::multiply(const Eigen::VectorXd& x, Eigen::VectorXd& y) const {
  const BlockPattern& p = pattern();
  y.setZero(p.dimension());
  using Block = Eigen::Map<const Eigen::MatrixXd, 0, Eigen::OuterStride<>>;
  for (int j = 0; j < p.columns(); ++j) {
    const int size = p.size[at(j)];
    const auto x_j = x.segment(p.start[at(j)], size);
    for (auto k = p.column[at(j)]; k < p.column[at(j) + 1]; ++k) {
      const int i = p.row[at(k)];
      const Block block(hessian_.data() + p.value[at(j)] + p.row_offset[at(k)], p.size[at(i)], size,
                        Eigen::OuterStride<>(p.height[at(j)]));
      y.segment(p.start[at(i)], p.size[at(i)]) += block * x_j;
      if (i != j)
        y.segment(p.start[at(j)], size) += block.transpose() * x.segment(p.start[at(i)], p.size[at(i)]);
    }
  }
}

void NormalEquations::retract(const std::vector<double>& values, const Eigen::VectorXd& step,
                              std::vector<double>& moved) const {
  if (moved.size() != values.size()) moved = values;  // vertices that are no unknowns never move
  const BlockPattern& p = pattern();
  for (int j = 0; j < p.columns(); ++j) {
    const VertexIndex v = structure_.vertex_of(j);
    const VertexType& type = graph_.vertex_type(v);
    const auto offset = at(graph_.offsets()[at(v)]);
    std::copy_n(values.data() + offset, type.value_size, moved.data() + offset);
    type.retract(moved.data() + offset, step.data() + p.start[at(j)]);
  }
}

VertexIndex NormalEquations::vertex_of_unknown(std::int64_t unknown) const {
  const auto& start = pattern().start;
  const auto after = std::upper_bound(start.begin(), start.end(), unknown);
  return structure_.vertex_of(static_cast<int>(after - start.begin()) - 1);
}

}  // namespace waymark
