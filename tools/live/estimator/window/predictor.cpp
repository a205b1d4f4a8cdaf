#include <waymark/tools/live/estimator/window/predictor.hpp>

#include <algorithm>

#include <Eigen/Cholesky>

#include <waymark/core/graph/detail/weighed_edge.hpp>

namespace waymark::live {
namespace {

/// Tells whether the edges determine all of the vertices.
bool is_determined(const Eigen::LDLT<Eigen::MatrixXd>& factor) {
  return factor.info() == Eigen::Success && factor.vectorD().minCoeff() > 0;
}

}  // namespace

/// Quadratic model over the known vertices and the new ones.
struct Predictor::Joint {
  std::vector<VertexIndex> vertices;
  std::vector<Eigen::Index> rows;
  Eigen::MatrixXd information;
  Eigen::VectorXd gradient;

  [[nodiscard]] Eigen::Index row_of(VertexIndex v) const {
    const auto found = std::find(vertices.begin(), vertices.end(), v);
    return found == vertices.end() ? -1 : rows[static_cast<std::size_t>(found - vertices.begin())];
  }
  Eigen::Index add(const Graph& graph, VertexIndex v) {
    const Eigen::Index row = information.rows();
    const Eigen::Index size = graph.vertex_type(v).tangent_size;
    vertices.push_back(v);
    rows.push_back(row);
    information.conservativeResizeLike(Eigen::MatrixXd::Zero(row + size, row + size));
    gradient.conservativeResizeLike(Eigen::VectorXd::Zero(row + size));
    return row;
  }
};

void Predictor::begin(const Graph& graph, const WindowTail& tail, VertexIndex pose) {
  std::vector<Eigen::Index> own;
  std::vector<Eigen::Index> others;
  vertices_ = {graph.id(pose)};
  Eigen::Index row = 0;
  for (const VertexIndex v : tail.vertices) {
    const Eigen::Index size = graph.vertex_type(v).tangent_size;
    for (Eigen::Index i = 0; i < size; ++i) (v == pose ? own : others).push_back(row + i);
    if (v != pose) vertices_.push_back(graph.id(v));
    row += size;
  }
  std::vector<Eigen::Index> order = own;
  order.insert(order.end(), others.begin(), others.end());
  covariance_ = tail.covariance(order, order);
  keep_sizes(graph);
  mark(graph);
}

void Predictor::mark(const Graph& graph) {
  edges_.assign(graph.batch_count(), 0);
  for (std::size_t b = 0; b < graph.batch_count(); ++b) edges_[b] = graph.batch(b).size();
}

void Predictor::add_edge(const Graph& graph, std::size_t batch, std::size_t edge, Joint& joint) const {
  const detail::WeighedEdge weighed = detail::weigh(graph.batch(batch), edge, graph.view());
  const std::vector<Eigen::MatrixXd>& jacobians = weighed.jacobians;
  const Eigen::MatrixXd information = weighed.information();
  const Eigen::VectorXd pull = weighed.pull();
  const std::span<const VertexIndex> vertices = graph.batch(batch).vertices(edge);
  std::vector<Eigen::Index> rows;
  for (const VertexIndex v : vertices) rows.push_back(joint.row_of(v));
  for (std::size_t k = 0; k < vertices.size(); ++k) {
    if (rows[k] < 0) continue;
    const Eigen::MatrixXd left = jacobians[k].transpose() * information;
    joint.gradient.segment(rows[k], left.rows()) += jacobians[k].transpose() * pull;
    for (std::size_t l = 0; l < vertices.size(); ++l)
      if (rows[l] >= 0)
        joint.information.block(rows[k], rows[l], left.rows(), jacobians[l].cols()) += left * jacobians[l];
  }
}

bool Predictor::touches_unknown(const Graph& graph, EdgePlace edge, const Joint& joint) {
  const std::span<const VertexIndex> vertices = graph.batch(edge.batch).vertices(edge.edge);
  return std::any_of(vertices.begin(), vertices.end(),
                     [&](VertexIndex v) { return !graph.fixed(v) && joint.row_of(v) < 0; });
}

/// Leaves out states that have left the window, which happens if no solution came before.
void Predictor::forget_dropped(const Graph& graph) {
  std::vector<VertexId> kept;
  std::vector<Eigen::Index> rows;
  Eigen::Index row = 0;
  for (std::size_t k = 0; k < vertices_.size(); ++k) {
    const std::optional<VertexIndex> v = graph.find(vertices_[k]);
    const Eigen::Index size = sizes_[k];
    if (v) {
      kept.push_back(vertices_[k]);
      for (Eigen::Index i = 0; i < size; ++i) rows.push_back(row + i);
    }
    row += size;
  }
  if (kept.size() == vertices_.size()) return;
  covariance_ = covariance_(rows, rows).eval();
  vertices_ = std::move(kept);
  keep_sizes(graph);
}

void Predictor::keep_sizes(const Graph& graph) {
  sizes_.clear();
  for (const VertexId id : vertices_) sizes_.push_back(graph.vertex_type(*graph.find(id)).tangent_size);
}

void Predictor::follow(Graph& graph, VertexIndex pose) {
  forget_dropped(graph);
  Joint joint;
  const Eigen::Index known = covariance_.rows();
  for (const VertexId id : vertices_) joint.add(graph, *graph.find(id));
  joint.information.topLeftCorner(known, known) =
      covariance_.ldlt().solve(Eigen::MatrixXd::Identity(known, known));
  // Of the vertices of the new edges, the new ones join. How well others are known is not told here: an edge to one, a
  // landmark or the bias of a receiver, waits for the next solution, unless nothing else says where the pose is.
  const VertexIndex newest = pose;
  for (std::size_t b = 0; b < graph.batch_count(); ++b) {
    const std::size_t first = b < edges_.size() ? edges_[b] : 0;
    for_each_edge(
        graph.batch(b),
        [&](std::span<const VertexIndex> vertices) {
          for (const VertexIndex v : vertices)
            if (v >= newest && !graph.fixed(v) && joint.row_of(v) < 0) joint.add(graph, v);
        },
        first);
  }
  if (joint.row_of(pose) < 0) return;
  std::vector<EdgePlace> waiting;
  for (std::size_t b = 0; b < graph.batch_count(); ++b)
    for (std::size_t e = b < edges_.size() ? edges_[b] : 0; e < graph.batch(b).size(); ++e) {
      if (touches_unknown(graph, {b, e}, joint))
        waiting.push_back({b, e});
      else
        add_edge(graph, b, e, joint);
    }
  Eigen::LDLT<Eigen::MatrixXd> factor(joint.information);
  if (!is_determined(factor) && !waiting.empty()) {
    for (const EdgePlace edge : waiting) add_edge(graph, edge.batch, edge.edge, joint);
    factor.compute(joint.information);
  }
  if (!is_determined(factor)) {
    mark(graph);
    return;
  }
  const Eigen::MatrixXd all =
      factor.solve(Eigen::MatrixXd::Identity(joint.information.rows(), joint.information.rows()));
  const Eigen::VectorXd step = -(all * joint.gradient);
  std::vector<Eigen::Index> order;
  std::vector<VertexId> vertices;
  const auto keep = [&](std::size_t k) {
    const VertexIndex v = joint.vertices[k];
    vertices.push_back(graph.id(v));
    for (Eigen::Index i = 0; i < graph.vertex_type(v).tangent_size; ++i) order.push_back(joint.rows[k] + i);
  };
  for (std::size_t k = 0; k < joint.vertices.size(); ++k) {
    const VertexIndex v = joint.vertices[k];
    std::vector<double> value(graph.value(v).begin(), graph.value(v).end());
    graph.vertex_type(v).retract(value.data(), step.data() + joint.rows[k]);
    graph.set_value(v, value);
    if (v == pose) keep(k);
  }
  // The former pose is summed out: the next motion begins at the new one.
  for (std::size_t k = 0; k < joint.vertices.size(); ++k) {
    const VertexIndex v = joint.vertices[k];
    if (v != pose && graph.vertex_type(v).position == nullptr) keep(k);
  }
  covariance_ = all(order, order).eval();
  vertices_ = std::move(vertices);
  keep_sizes(graph);
  mark(graph);
}

void Predictor::settle(Graph& graph, VertexIndex first) const {
  Joint joint;
  for (auto v = first; v < static_cast<VertexIndex>(graph.vertex_count()); ++v)
    if (!graph.fixed(v)) joint.add(graph, v);
  for (std::size_t b = 0; b < graph.batch_count(); ++b)
    for (std::size_t e = b < edges_.size() ? edges_[b] : 0; e < graph.batch(b).size(); ++e)
      add_edge(graph, b, e, joint);
  const Eigen::LDLT<Eigen::MatrixXd> factor(joint.information);
  if (joint.vertices.empty() || factor.info() != Eigen::Success || !(factor.vectorD().minCoeff() > 0)) return;
  const Eigen::VectorXd step = factor.solve(-joint.gradient);
  for (std::size_t k = 0; k < joint.vertices.size(); ++k) {
    const VertexIndex v = joint.vertices[k];
    std::vector<double> value(graph.value(v).begin(), graph.value(v).end());
    graph.vertex_type(v).retract(value.data(), step.data() + joint.rows[k]);
    graph.set_value(v, value);
  }
}

Eigen::Matrix3d Predictor::covariance() const {
  if (covariance_.rows() < 3) return Eigen::Matrix3d::Zero();
  return covariance_.topLeftCorner<3, 3>();
}

}  // namespace waymark::live
