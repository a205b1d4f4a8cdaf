#include <waymark/types_se2/start/detail/sightings.hpp>

#include <algorithm>

#include <waymark/types_se2/vertex_se2.hpp>

namespace waymark {
namespace {

/// Reads the sightings of edges, whatever their types.
class SightingReader {
 public:
  explicit SightingReader(const Graph& graph) : graph_(graph), values_(graph.values()) {}

  /// Appends the sighting of an edge, if it is one.
  void read(const EdgeBatchBase& batch, std::size_t edge, std::vector<Sighting>& out) {
    const std::optional<Sight> sight = batch.sight(edge);
    const auto vertices = batch.vertices(edge);
    if (!sight || !sight->way.allFinite() || vertices.size() < 2) return;
    if (graph_.vertex_type(vertices[0]).tag != VertexSe2::kTag) return;
    if (graph_.vertex_type(vertices[1]).tag != VertexXy::kTag) return;
    Sighting seen{.from = vertices[0], .to = vertices[1], .sight = *sight};
    if (sight->has_place()) seen.position_weight = weight(batch, edge, seen);
    out.push_back(seen);
  }

 private:
  /// Returns the mean information per axis about the point, in its place as seen from a pose at the origin.
  double weight(const EdgeBatchBase& batch, std::size_t edge, const Sighting& seen) {
    const Eigen::Vector2d place = seen.sight.place();
    std::fill_n(value(seen.from), 3, 0.0);
    std::copy_n(place.data(), 2, value(seen.to));
    batch.linearize_edge(edge, {values_.data(), graph_.offsets().data()}, error_, jacobians_);
    return 0.5 * (jacobians_[1].transpose() * batch.information(edge) * jacobians_[1]).trace();
  }

  double* value(VertexIndex v) { return values_.data() + graph_.offsets()[static_cast<std::size_t>(v)]; }

  const Graph& graph_;
  std::vector<double> values_;
  Eigen::VectorXd error_;
  std::vector<Eigen::MatrixXd> jacobians_;
};

}  // namespace

std::vector<Sighting> planar_sightings(const Graph& graph) {
  std::vector<Sighting> sightings;
  SightingReader reader(graph);
  for (std::size_t b = 0; b < graph.batch_count(); ++b) {
    const EdgeBatchBase& batch = graph.batch(b);
    if (batch.size() == 0 || !batch.sight(0)) continue;
    for (std::size_t e = 0; e < batch.size(); ++e) reader.read(batch, e, sightings);
  }
  return sightings;
}

}  // namespace waymark
