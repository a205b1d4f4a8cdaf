#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include <waymark/core/base/detail/index.hpp>
#include <waymark/core/graph/detail/weighed_edge.hpp>
#include <waymark/core/linear/dense_decompositions.hpp>
#include <waymark/core/system/detail/time_order.hpp>
#include <waymark/core/window/detail/front.hpp>
#include <waymark/core/window/window_solver.hpp>

namespace waymark {
using detail::at;

class WindowSolver::Elimination {
 public:
  explicit Elimination(Graph& graph) : graph_(graph) {}

  WindowSummary update(const WindowOptions& options);
  void restart() { fresh_ = true; }
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

  /// A front before a position, and the values that it refers to.
  struct Checkpoint {
    std::size_t position = 0;
    detail::Front::Saved front;
    std::vector<std::vector<double>> references;  // of its members
  };

  void choose_order();
  [[nodiscard]] std::size_t first_change(const std::vector<VertexIndex>& former) const;
  void collect_edges();
  void lay_out(std::size_t batch);
  bool eliminate(std::size_t first);
  void begin_at(std::size_t first);
  void keep_checkpoint(std::size_t position);
  void substitute(std::vector<double>& values);
  void assemble(const EdgeName& name);
  void assemble_prior(const EdgeName& name);
  [[nodiscard]] bool is_unknown(VertexIndex v) const { return position_of_[at(v)] >= 0; }
  [[nodiscard]] bool move(double chi2, double decrement, double safe, std::size_t first);

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
  std::vector<double> linearised_;        // values of all vertices where they were linearised
  std::vector<Checkpoint> checkpoints_;   // ascending
  std::vector<Checkpoint> boundaries_;    // where a step began that did not linearise everything
  std::vector<std::size_t> known_edges_;  // per batch, at the last step
  int partial_ = 0;                       // so many calls since everything was linearised
  bool fresh_ = true;                     // nothing is kept
  double chi2_ = 0;
  VertexIndex singular_{-1};
  int largest_front_ = 0;
};

void WindowSolver::Elimination::choose_order() {
  order_ = detail::time_order(graph_);
  position_of_.assign(graph_.vertex_count(), -1);
  for (std::size_t position = 0; position < order_.size(); ++position)
    position_of_[at(order_[position])] = static_cast<std::int32_t>(position);
  // The place in a step depends on the vertex alone: it stays when others are ordered before it.
  tangent_of_.resize(graph_.vertex_count());
  std::int32_t next = 0;
  for (std::size_t v = 0; v < graph_.vertex_count(); ++v) {
    tangent_of_[v] = next;
    next += graph_.vertex_type(static_cast<VertexIndex>(v)).tangent_size;
  }
  step_.assign(at(next), 0.0);
}

/// Returns the first position whose front is another one than at the last step.
std::size_t WindowSolver::Elimination::first_change(const std::vector<VertexIndex>& former) const {
  const auto same = std::mismatch(order_.begin(), order_.end(), former.begin(), former.end());
  auto first = static_cast<std::size_t>(same.first - order_.begin());
  for (std::size_t b = 0; b < graph_.batch_count(); ++b) {
    const std::size_t known = b < known_edges_.size() ? known_edges_[b] : 0;
    for_each_edge(
        graph_.batch(b),
        [&](std::span<const VertexIndex> vertices) {
          for (const VertexIndex v : vertices)
            if (is_unknown(v)) first = std::min(first, at(position_of_[at(v)]));
        },
        known);
  }
  return first;
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
  own_hessian_.resize(std::max(own_hessian_.size(), at(layout.dimension) * at(layout.dimension)));
  own_gradient_.resize(std::max(own_gradient_.size(), at(layout.dimension)));
}

// Linearises an edge into a matrix of its own, and adds this to the front.
void WindowSolver::Elimination::assemble(const EdgeName& name) {
  const EdgeBatchBase& batch = graph_.batch(name.batch);
  const std::span<const VertexIndex> vertices = batch.vertices(name.edge);
  const LocalLayout& layout = layouts_[name.batch];
  const int dimension = layout.dimension;
  std::fill_n(own_hessian_.data(), dimension * dimension, 0.0);
  std::fill_n(own_gradient_.data(), dimension, 0.0);
  chi2_ += batch.linearize(graph_.view(), layout.scatter, {name.edge, name.edge + 1},
                           {own_hessian_.data(), own_gradient_.data()});
  if (rows_.size() < vertices.size()) rows_.resize(vertices.size());
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
  const detail::WeighedEdge edge = detail::weigh(batch, name.edge, graph_.view());
  chi2_ += edge.loss.rho;
  const Eigen::MatrixXd information = edge.information();
  const Eigen::VectorXd pull = edge.pull();
  rows_.clear();
  for (const VertexIndex v : vertices)
    rows_.push_back(is_unknown(v) ? front_.row_of(v, graph_.vertex_type(v).tangent_size, tangent_of_[at(v)])
                                  : -1);
  for (std::size_t k = 0; k < vertices.size(); ++k) {
    if (rows_[k] < 0) continue;
    const Eigen::VectorXd gradient = edge.jacobians[k].transpose() * pull;
    front_.add_gradient(rows_[k], static_cast<int>(gradient.size()), gradient.data());
    const Eigen::MatrixXd left = edge.jacobians[k].transpose() * information;
    for (std::size_t l = 0; l <= k; ++l) {
      if (rows_[l] < 0) continue;
      const Eigen::MatrixXd block = left * edge.jacobians[l];
      front_.add_block(rows_[k], static_cast<int>(block.rows()), rows_[l], static_cast<int>(block.cols()),
                       block.data(), static_cast<int>(block.rows()));
    }
  }
}

void WindowSolver::Elimination::keep_checkpoint(std::size_t position) {
  Checkpoint& kept = checkpoints_.emplace_back();
  kept.position = position;
  kept.front = front_.save();
  for (const detail::Front::Member& member : kept.front.members) {
    const auto value = graph_.value(member.vertex);
    kept.references.emplace_back(value.begin(), value.end());
  }
}

/// Begins at a checkpoint at or before a position; at the first vertex if there is none.
void WindowSolver::Elimination::begin_at(std::size_t first) {
  while (!checkpoints_.empty() && checkpoints_.back().position > first) checkpoints_.pop_back();
  if (checkpoints_.empty()) {
    front_.clear();
    panels_.clear();
    boundaries_.clear();
    return;
  }
  const Checkpoint& begin = checkpoints_.back();
  while (!boundaries_.empty() && boundaries_.back().position >= begin.position) boundaries_.pop_back();
  boundaries_.push_back(begin);
  panels_.cut(begin.position);
  front_.restore(begin.front);
  // What was eliminated refers to the values of then.
  std::vector<double> moved(at(front_.dimension()));
  for (std::size_t m = 0; m < begin.front.members.size(); ++m) {
    const detail::Front::Member& member = begin.front.members[m];
    graph_.vertex_type(member.vertex)
        .local(begin.references[m].data(), graph_.value(member.vertex).data(), moved.data() + member.row);
  }
  front_.move_reference(moved);
}

bool WindowSolver::Elimination::eliminate(std::size_t first) {
  constexpr std::size_t kEvery = 16;
  begin_at(first);
  const std::size_t begin = panels_.size();
  chi2_ = 0;
  largest_front_ = 0;
  linearised_.resize(graph_.values().size());
  for (std::size_t position = begin; position < order_.size(); ++position) {
    const VertexIndex v = order_[position];
    if (position % kEvery == 0 && position > begin) keep_checkpoint(position);
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
    const auto value = graph_.value(v);
    std::copy(value.begin(), value.end(), linearised_.begin() + graph_.offsets()[at(v)]);
  }
  return true;
}

/// Computes the values at the minimum of the quadratic model. Each stretch that was linearised at a time of its
/// own continues from the values of the front where it ends.
void WindowSolver::Elimination::substitute(std::vector<double>& values) {
  std::size_t last = order_.size();
  for (std::size_t b = boundaries_.size() + 1; b-- > 0;) {
    const std::size_t first = b == 0 ? 0 : boundaries_[b - 1].position;
    panels_.solve(first, last, step_);
    for (std::size_t position = first; position < last; ++position) {
      const VertexIndex v = order_[position];
      const VertexType& type = graph_.vertex_type(v);
      const std::int64_t offset = graph_.offsets()[at(v)];
      std::copy_n(linearised_.begin() + offset, type.value_size, values.begin() + offset);
      type.retract(values.data() + offset, step_.data() + tangent_of_[at(v)]);
    }
    if (b == 0) break;
    const Checkpoint& boundary = boundaries_[b - 1];
    for (std::size_t m = 0; m < boundary.front.members.size(); ++m) {
      const detail::Front::Member& member = boundary.front.members[m];
      graph_.vertex_type(member.vertex)
          .local(boundary.references[m].data(), values.data() + graph_.offsets()[at(member.vertex)],
                 step_.data() + member.step);
    }
    last = first;
  }
}

// Takes the step, or a part of it that decreases chi2. A step that promises little is taken as it is.
bool WindowSolver::Elimination::move(double chi2, double decrement, double safe, std::size_t first) {
  constexpr int kHalvings = 10;
  before_ = graph_.values();
  std::vector<double> moved = before_;
  substitute(moved);
  graph_.set_values(moved);
  if (decrement < safe || (first == 0 && graph_.chi2() <= chi2)) return true;
  if (first > 0) {
    // A step that linearised only a part does not know chi2.
    if (graph_.chi2() < std::numeric_limits<double>::infinity()) return true;
    graph_.set_values(before_);
    return false;
  }
  double share = 0.5;
  for (int halving = 0; halving < kHalvings; ++halving, share *= 0.5) {
    moved = before_;
    for (const VertexIndex v : order_) {
      const VertexType& type = graph_.vertex_type(v);
      std::vector<double> delta(step_.begin() + tangent_of_[at(v)],
                                step_.begin() + tangent_of_[at(v)] + type.tangent_size);
      for (double& number : delta) number *= share;
      type.retract(moved.data() + graph_.offsets()[at(v)], delta.data());
    }
    graph_.set_values(moved);
    if (graph_.chi2() <= chi2) return true;
  }
  graph_.set_values(before_);
  return false;
}

WindowSummary WindowSolver::Elimination::update(const WindowOptions& options) {
  const std::vector<VertexIndex> former = std::exchange(order_, {});
  choose_order();
  collect_edges();
  layouts_.resize(graph_.batch_count());
  for (std::size_t b = 0; b < graph_.batch_count(); ++b) lay_out(b);
  const bool partly = !fresh_ && partial_ < options.partial_updates;
  partial_ = partly ? partial_ + 1 : 0;
  std::size_t first = partly ? first_change(former) : 0;
  fresh_ = true;                          // until it is done
  constexpr double kLargeDecrement = 50;  // then all values move so far that all edges are linearised anew
  WindowSummary summary;
  for (int iteration = 0; iteration < options.max_iterations; ++iteration) {
    if (!eliminate(first)) {
      summary.solved = false;
      summary.singular = singular_;
      return summary;
    }
    const std::size_t begin = boundaries_.empty() ? 0 : boundaries_.back().position;
    summary.solved = true;
    summary.chi2 = chi2_;
    summary.decrement = panels_.decrement(begin);
    if (!std::isfinite(summary.decrement) || !move(chi2_, summary.decrement, options.safe_decrement, begin))
      return summary;
    ++summary.iterations;
    summary.converged = summary.decrement <= options.decrement_tolerance;
    if (summary.converged) break;
    if (summary.decrement > kLargeDecrement) first = 0;
  }
  known_edges_.clear();
  for (std::size_t b = 0; b < graph_.batch_count(); ++b) known_edges_.push_back(graph_.batch(b).size());
  fresh_ = false;
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

void WindowSolver::restart() {
  elimination_->restart();
}

WindowTail WindowSolver::tail(VertexIndex first) const {
  return elimination_->tail(first);
}

int WindowSolver::largest_front() const {
  return elimination_->largest_front();
}

}  // namespace waymark
