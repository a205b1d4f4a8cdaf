#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include <waymark/core/base/detail/index.hpp>
#include <waymark/core/graph/detail/robust_information.hpp>
#include <waymark/core/linear/dense_decompositions.hpp>
#include <waymark/core/window/detail/front.hpp>
#include <waymark/core/window/detail/time_order.hpp>
#include <waymark/core/window/window_solver.hpp>

namespace waymark {
using detail::at;

class WindowSolver::Elimination {
 public:
  explicit Elimination(Graph& graph) : graph_(graph) {}

  WindowSummary update(const WindowOptions& options);
  [[nodiscard]] WindowTail tail(VertexIndex first) const;
  [[nodiscard]] int largest_front() const { return largest_front_; }

 private:
  /// Where the parts of an edge stand in a matrix of its own. It is the same for all edges of a batch.
  struct LocalLayout {
    Scatter scatter;
    std::vector<int> sizes;    // tangent size of each vertex
    std::vector<int> offsets;  // first row of each vertex
    int dimension = 0;

    /// Repeats the layout for at least this many edges.
    void cover(std::size_t edges) {
      const std::size_t arity = sizes.size();
      while (scatter.gradient.size() < edges * arity) {
        for (std::size_t k = 0; k < arity; ++k) {
          scatter.gradient.push_back(static_cast<std::uint32_t>(offsets[k]));
          for (std::size_t l = 0; l <= k; ++l)
            scatter.blocks.push_back(
                {static_cast<std::uint32_t>(offsets[k] + offsets[l] * dimension), dimension});
        }
      }
    }
  };

  struct EdgeName {
    std::uint32_t batch = 0;
    std::uint32_t edge = 0;
  };

  void choose_order();
  void collect_edges();
  void lay_out(std::size_t batch);
  bool eliminate();
  void assemble(const EdgeName& name);
  void assemble_prior(const EdgeName& name);
  [[nodiscard]] bool is_unknown(VertexIndex v) const { return position_of_[at(v)] >= 0; }
  [[nodiscard]] bool move(double chi2, double decrement);

  Graph& graph_;
  std::vector<VertexIndex> order_;         // in order of elimination
  std::vector<std::int32_t> position_of_;  // per vertex; -1: no unknown
  std::vector<std::int32_t> tangent_of_;   // per vertex: its first number in step_
  std::vector<LocalLayout> layouts_;       // per batch
  std::vector<EdgeName> edges_;            // by the position where they are assembled
  std::vector<std::size_t> edges_begin_;   // per position, and the end
  std::vector<int> rows_;                  // of the vertices of an edge in the front; -1: not in it
  std::vector<double> own_hessian_;
  std::vector<double> own_gradient_;
  detail::Front front_;
  detail::FrontPanels panels_;
  std::vector<double> step_;
  std::vector<double> before_;
  double chi2_ = 0;
  VertexIndex singular_{-1};
  int largest_front_ = 0;
};

void WindowSolver::Elimination::choose_order() {
  order_ = detail::time_order(graph_);
  position_of_.assign(graph_.vertex_count(), -1);
  tangent_of_.assign(graph_.vertex_count(), -1);
  std::int32_t next = 0;
  for (std::size_t position = 0; position < order_.size(); ++position) {
    const VertexIndex v = order_[position];
    position_of_[at(v)] = static_cast<std::int32_t>(position);
    tangent_of_[at(v)] = next;
    next += graph_.vertex_type(v).tangent_size;
  }
  step_.assign(at(next), 0.0);
}

void WindowSolver::Elimination::collect_edges() {
  edges_begin_.assign(order_.size() + 1, 0);
  std::vector<std::int32_t> firsts;
  for (std::size_t b = 0; b < graph_.batch_count(); ++b) {
    for_each_edge(graph_.batch(b), [&](std::span<const VertexIndex> vertices) {
      std::int32_t first = std::numeric_limits<std::int32_t>::max();
      for (const VertexIndex v : vertices)
        if (is_unknown(v)) first = std::min(first, position_of_[at(v)]);
      firsts.push_back(first);
      if (at(first) < order_.size()) ++edges_begin_[at(first) + 1];
    });
  }
  for (std::size_t p = 0; p < order_.size(); ++p) edges_begin_[p + 1] += edges_begin_[p];
  edges_.resize(edges_begin_.back());
  std::vector<std::size_t> next(edges_begin_.begin(), edges_begin_.end() - 1);
  std::size_t k = 0;
  for (std::size_t b = 0; b < graph_.batch_count(); ++b) {
    for (std::size_t e = 0; e < graph_.batch(b).size(); ++e, ++k) {
      if (at(firsts[k]) >= order_.size()) continue;
      edges_[next[at(firsts[k])]++] = {static_cast<std::uint32_t>(b), static_cast<std::uint32_t>(e)};
    }
  }
}

void WindowSolver::Elimination::lay_out(std::size_t b) {
  const EdgeBatchBase& batch = graph_.batch(b);
  if (batch.size() == 0 || batch.vertex_table().arity == 0) return;
  LocalLayout& layout = layouts_[b];
  if (layout.sizes.empty()) {
    for (const VertexIndex v : batch.vertices(0)) {
      layout.sizes.push_back(graph_.vertex_type(v).tangent_size);
      layout.offsets.push_back(layout.dimension);
      layout.dimension += layout.sizes.back();
    }
  }
  layout.cover(batch.size());
}

// Linearises an edge into a matrix of its own, and adds this to the front.
void WindowSolver::Elimination::assemble(const EdgeName& name) {
  const EdgeBatchBase& batch = graph_.batch(name.batch);
  const std::span<const VertexIndex> vertices = batch.vertices(name.edge);
  const LocalLayout& layout = layouts_[name.batch];
  const int dimension = layout.dimension;
  own_hessian_.assign(at(dimension) * at(dimension), 0.0);
  own_gradient_.assign(at(dimension), 0.0);
  chi2_ += batch.linearize(graph_.view(), layout.scatter, {name.edge, name.edge + 1},
                           {own_hessian_.data(), own_gradient_.data()});
  rows_.resize(vertices.size());
  for (std::size_t k = 0; k < vertices.size(); ++k)
    rows_[k] = is_unknown(vertices[k])
                   ? front_.row_of(vertices[k], layout.sizes[k], tangent_of_[at(vertices[k])])
                   : -1;
  for (std::size_t k = 0; k < vertices.size(); ++k) {
    if (rows_[k] < 0) continue;
    front_.add_gradient(rows_[k], layout.sizes[k], own_gradient_.data() + layout.offsets[k]);
    for (std::size_t l = 0; l <= k; ++l) {
      if (rows_[l] < 0) continue;
      front_.add_block(rows_[k], layout.sizes[k], rows_[l], layout.sizes[l],
                       own_hessian_.data() + layout.offsets[k] + layout.offsets[l] * dimension, dimension);
    }
  }
}

// The same for an edge of any number of vertices.
void WindowSolver::Elimination::assemble_prior(const EdgeName& name) {
  const EdgeBatchBase& batch = graph_.batch(name.batch);
  const std::span<const VertexIndex> vertices = batch.vertices(name.edge);
  Eigen::VectorXd e;
  std::vector<Eigen::MatrixXd> jacobians;
  batch.linearize_edge(name.edge, graph_.view(), e, jacobians);
  const Eigen::MatrixXd omega = batch.information(name.edge);
  const double squared = e.dot(omega * e);
  const Loss* loss = batch.loss(name.edge);
  const LossValue value = loss == nullptr ? LossValue{squared, 1, 0} : loss->at(squared);
  chi2_ += value.rho;
  const Eigen::MatrixXd information = robust_information(value, squared, omega, e);
  const Eigen::VectorXd weighted = value.weight * (omega * e);
  rows_.clear();
  for (const VertexIndex v : vertices)
    rows_.push_back(is_unknown(v) ? front_.row_of(v, graph_.vertex_type(v).tangent_size, tangent_of_[at(v)])
                                  : -1);
  for (std::size_t k = 0; k < vertices.size(); ++k) {
    if (rows_[k] < 0) continue;
    const Eigen::VectorXd gradient = jacobians[k].transpose() * weighted;
    front_.add_gradient(rows_[k], static_cast<int>(gradient.size()), gradient.data());
    const Eigen::MatrixXd left = jacobians[k].transpose() * information;
    for (std::size_t l = 0; l <= k; ++l) {
      if (rows_[l] < 0) continue;
      const Eigen::MatrixXd block = left * jacobians[l];
      front_.add_block(rows_[k], static_cast<int>(block.rows()), rows_[l], static_cast<int>(block.cols()),
                       block.data(), static_cast<int>(block.rows()));
    }
  }
}

bool WindowSolver::Elimination::eliminate() {
  front_.clear();
  panels_.clear();
  chi2_ = 0;
  largest_front_ = 0;
  for (std::size_t position = 0; position < order_.size(); ++position) {
    const VertexIndex v = order_[position];
    for (std::size_t e = edges_begin_[position]; e < edges_begin_[position + 1]; ++e) {
      if (graph_.batch(edges_[e].batch).vertex_table().arity > 0) {
        assemble(edges_[e]);
      } else {
        assemble_prior(edges_[e]);
      }
    }
    largest_front_ = std::max(largest_front_, front_.dimension());
    if (!front_.eliminate(v, panels_)) {
      singular_ = v;
      return false;
    }
  }
  return true;
}

// Takes the step, or a part of it that decreases chi2. A step that promises little is taken as it is.
bool WindowSolver::Elimination::move(double chi2, double decrement) {
  constexpr double kSmall = 1e-2;
  constexpr int kHalvings = 10;
  before_ = graph_.values();
  std::vector<double> moved;
  double share = 1;
  for (int halving = 0; halving <= kHalvings; ++halving, share *= 0.5) {
    moved = before_;
    for (const VertexIndex v : order_) {
      const VertexType& type = graph_.vertex_type(v);
      double* delta = step_.data() + tangent_of_[at(v)];
      if (halving > 0)
        for (int i = 0; i < type.tangent_size; ++i) delta[i] *= 0.5;
      type.retract(moved.data() + graph_.offsets()[at(v)], delta);
    }
    graph_.set_values(std::move(moved));
    if (decrement < kSmall || graph_.chi2() <= chi2) return true;
  }
  graph_.set_values(before_);
  return false;
}

WindowSummary WindowSolver::Elimination::update(const WindowOptions& options) {
  choose_order();
  collect_edges();
  layouts_.resize(graph_.batch_count());
  for (std::size_t b = 0; b < graph_.batch_count(); ++b) lay_out(b);
  WindowSummary summary;
  for (int iteration = 0; iteration < options.max_iterations; ++iteration) {
    if (!eliminate()) {
      summary.solved = false;
      summary.singular = singular_;
      return summary;
    }
    summary.solved = true;
    summary.chi2 = chi2_;
    summary.decrement = panels_.decrement();
    panels_.solve(step_);
    if (!std::isfinite(summary.decrement) || !move(chi2_, summary.decrement)) return summary;
    ++summary.iterations;
    summary.converged = summary.decrement <= options.decrement_tolerance;
    if (summary.converged) break;
  }
  return summary;
}

WindowTail WindowSolver::Elimination::tail(VertexIndex first) const {
  WindowTail tail;
  if (at(first) >= position_of_.size() || !is_unknown(first)) return tail;
  const std::size_t begin = at(position_of_[at(first)]);
  tail.vertices.assign(order_.begin() + static_cast<std::ptrdiff_t>(begin), order_.end());
  const Eigen::MatrixXd root = panels_.triangle(begin);
  const Eigen::MatrixXd inverse =
      root.triangularView<Eigen::Upper>().solve(Eigen::MatrixXd::Identity(root.rows(), root.cols()));
  tail.covariance = inverse * inverse.transpose();
  return tail;
}

WindowSolver::WindowSolver(Graph& graph) : elimination_(std::make_unique<Elimination>(graph)) {}
WindowSolver::~WindowSolver() = default;

WindowSummary WindowSolver::update(const WindowOptions& options) {
  return elimination_->update(options);
}

WindowTail WindowSolver::tail(VertexIndex first) const {
  return elimination_->tail(first);
}

int WindowSolver::largest_front() const {
  return elimination_->largest_front();
}

}  // namespace waymark
