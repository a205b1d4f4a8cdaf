#include <waymark/tools/drive/estimation/latency.hpp>

#include <cmath>
#include <vector>

#include <waymark/core/covariance/marginals.hpp>
#include <waymark/core/linear/block_cholesky.hpp>
#include <waymark/core/optimize/optimizer.hpp>
#include <waymark/core/system/gauge.hpp>
#include <waymark/tools/drive/estimation/coarse.hpp>
#include <waymark/tools/drive/model/build.hpp>
#include <waymark/types_se2/edge_gnss.hpp>

namespace waymark::drive {
namespace {

constexpr double kFixPeriod_s = 1;
constexpr double kNodePeriod_s = 0.25;
constexpr int kMostRounds = 10;
/// At 30 m/s and 0.5 rad/s the edge is then wrong by 0.2 mm.
constexpr double kSettled_s = 0.005;

/// Takes the poses of the nodes, the first vertices of the graph.
void keep_poses(const Graph& graph, std::vector<Eigen::Vector3d>& poses) {
  for (std::size_t node = 0; node < poses.size(); ++node) {
    const auto value = graph.value(static_cast<VertexIndex>(node));
    poses[node] = {value[0], value[1], value[2]};
  }
}

double prior_sigma_of(const FusionSettings& settings, const TypeRegistry& registry) {
  constexpr const char* kOption = "time_offset_sigma";
  const GnssModelingType& type = registry.gnss_modeling(settings.modeling);
  if (!has_option(type.options, kOption)) return 0;
  return CheckedOptions(type.name, settings.modeling_options, type.options).number(kOption);
}

}  // namespace

double TimeOffset::odds_of_none() const {
  return prior_sigma_s / sigma_s * std::exp(-0.5 * std::pow(value_s / sigma_s, 2));
}

std::optional<VertexIndex> time_offset_vertex(const Graph& graph) {
  for (VertexIndex v = 0; v < static_cast<VertexIndex>(graph.vertex_count()); ++v) {
    if (graph.vertex_type(v).tag == VertexTimeOffset::kTag && !graph.fixed(v)) return v;
  }
  return std::nullopt;
}

std::optional<TimeOffset> assume_time_offset(PlacedDrive& placed, const FusionSettings& settings,
                                             const TypeRegistry& registry) {
  PlacedDrive coarse = coarsen(placed, kFixPeriod_s, kNodePeriod_s);
  const auto algorithm = registry.make_algorithm("dogleg");
  BlockCholesky cholesky;
  StructuredSolver solver{cholesky};
  TimeOffset found;
  for (int round = 0; round < kMostRounds; ++round) {
    Graph graph = build_graph(coarse, {}, settings, registry).graph;
    const std::optional<VertexIndex> offset = time_offset_vertex(graph);
    if (!offset) return std::nullopt;
    solver.build(graph, find_gauge(graph).held);
    optimize(graph, solver, *algorithm, {});
    const double moved_s = graph.value(*offset)[0] - coarse.time_offset_s;
    coarse.time_offset_s += moved_s;
    if (std::abs(moved_s) < kSettled_s || round + 1 == kMostRounds) {
      found.sigma_s = std::sqrt(marginal_covariances(graph, std::vector{*offset})[0](0, 0));
      break;
    }
    keep_poses(graph, coarse.start.poses);
  }
  placed.time_offset_s = coarse.time_offset_s;
  found.value_s = coarse.time_offset_s;
  found.prior_sigma_s = prior_sigma_of(settings, registry);
  return found;
}

}  // namespace waymark::drive
