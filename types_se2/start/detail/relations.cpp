#include <waymark/types_se2/start/detail/relations.hpp>

#include <cmath>
#include <optional>

#include <Eigen/LU>

#include <waymark/types_se2/edge_gnss.hpp>
#include <waymark/types_se2/edge_se2.hpp>
#include <waymark/types_se2/g2o_edges.hpp>
#include <waymark/types_se2/start/detail/sightings.hpp>

namespace waymark {
namespace {

double position_weight(const Eigen::MatrixXd& information) {
  return 0.5 * (information(0, 0) + information(1, 1));
}

Relation relative_pose(std::span<const VertexIndex> v, const std::vector<double>& fields,
                       const Eigen::MatrixXd& information) {
  return {.from = v[0],
          .to = v[1],
          .translation = {fields[0], fields[1]},
          .turn = fields[2],
          .position_weight = position_weight(information),
          .heading_weight = information(2, 2)};
}

Relation gnss_position(std::span<const VertexIndex> v, const std::vector<double>& fields,
                       const Eigen::MatrixXd& information) {
  return {.from = v[0],
          .to = v[1],
          .translation = {fields[0], fields[1]},
          .lever = {fields[2], fields[3]},
          .position_weight = position_weight(information)};
}

Relation pose_prior(std::span<const VertexIndex> v, const std::vector<double>& fields,
                    const Eigen::MatrixXd& information) {
  return {.to = v[0],
          .translation = {fields[0], fields[1]},
          .turn = fields[2],
          .position_weight = position_weight(information),
          .heading_weight = information(2, 2)};
}

Relation position_prior(std::span<const VertexIndex> v, const std::vector<double>& fields,
                        const Eigen::MatrixXd& information) {
  return {.to = v[0], .translation = {fields[0], fields[1]}, .position_weight = position_weight(information)};
}

using ReadFields = Relation (*)(std::span<const VertexIndex>, const std::vector<double>&,
                                const Eigen::MatrixXd&);

/// Returns the function that reads the fields of a known type; null for other types.
ReadFields known_type(const std::string& tag) {
  if (tag == EdgeSe2::kTag || tag == EdgeSe2Log::kTag) return relative_pose;
  // Types that extend this one (by a delay, by biases) keep its first vertices and fields.
  if (tag.starts_with(EdgeGnssPosition::kTag)) return gnss_position;
  if (tag == EdgePriorSe2::kTag) return pose_prior;
  if (tag == EdgePriorSe2Xy::kTag || tag == EdgePriorXy::kTag) return position_prior;
  return nullptr;
}

/// Finds the motion at which the error of an edge vanishes, whatever its type.
class MotionFinder {
 public:
  explicit MotionFinder(const Graph& graph) : graph_(graph), values_(graph.values()) {}

  std::optional<Relation> find(const EdgeBatchBase& batch, std::size_t edge) {
    std::vector<std::size_t> poses;
    const auto vertices = batch.vertices(edge);
    for (std::size_t k = 0; k < vertices.size(); ++k) {
      if (graph_.vertex_type(vertices[k]).tag == VertexSe2::kTag) poses.push_back(k);
    }
    if (poses.size() != 2 || batch.error_dimension(edge) != 3) return std::nullopt;
    Relation relation{.from = vertices[poses[0]], .to = vertices[poses[1]]};
    place(relation.from, Eigen::Vector3d::Zero());
    Eigen::Vector3d seen = Eigen::Vector3d::Zero();
    for (int k = 0; k < kIterations; ++k) {
      place(relation.to, seen);
      batch.linearize_edge(edge, {values_.data(), graph_.offsets().data()}, error_, jacobians_);
      if (error_.lpNorm<Eigen::Infinity>() < kResolution)
        return weighed(relation, seen, batch, edge, poses[1]);
      const Eigen::Matrix3d jacobian = jacobians_[poses[1]];
      const Eigen::Vector3d step = jacobian.inverse() * error_;
      if (!step.allFinite()) return std::nullopt;
      seen -= step;
    }
    return std::nullopt;
  }

 private:
  static constexpr int kIterations = 20;
  static constexpr double kResolution = 1e-12;

  void place(VertexIndex v, const Eigen::Vector3d& pose) {
    std::copy_n(pose.data(), 3, values_.data() + graph_.offsets()[static_cast<std::size_t>(v)]);
  }

  Relation weighed(Relation relation, const Eigen::Vector3d& seen, const EdgeBatchBase& batch,
                   std::size_t edge, std::size_t to) const {
    const Eigen::Matrix3d information = jacobians_[to].transpose() * batch.information(edge) * jacobians_[to];
    relation.translation = seen.head<2>();
    relation.turn = seen[2];
    relation.position_weight = position_weight(information);
    relation.heading_weight = information(2, 2);
    return relation;
  }

  const Graph& graph_;
  std::vector<double> values_;
  Eigen::VectorXd error_;
  std::vector<Eigen::MatrixXd> jacobians_;
};

}  // namespace

std::vector<Relation> planar_relations(const Graph& graph) {
  std::vector<Relation> relations;
  relations.reserve(graph.edge_count());
  std::optional<MotionFinder> finder;
  std::vector<double> fields;
  for (std::size_t b = 0; b < graph.batch_count(); ++b) {
    const EdgeBatchBase& batch = graph.batch(b);
    const ReadFields read = known_type(graph.edge_type(b).tag);
    for (std::size_t e = 0; e < batch.size(); ++e) {
      if (read != nullptr) {
        fields.clear();
        batch.fields(e, fields);
        relations.push_back(read(batch.vertices(e), fields, batch.information(e)));
        continue;
      }
      if (!finder) finder.emplace(graph);
      if (const auto relation = finder->find(batch, e)) relations.push_back(*relation);
    }
  }
  for (const Sighting& seen : planar_sightings(graph)) {
    if (!seen.sight.has_place()) continue;
    relations.push_back({.from = seen.from,
                         .to = seen.to,
                         .translation = seen.sight.place(),
                         .position_weight = seen.position_weight});
  }
  return relations;
}

}  // namespace waymark
