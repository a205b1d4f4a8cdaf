#include <waymark/tools/drive/estimation/latency.hpp>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <waymark/core/covariance/marginals.hpp>
#include <waymark/core/linear/block_cholesky.hpp>
#include <waymark/core/optimize/optimizer.hpp>
#include <waymark/core/system/gauge.hpp>
#include <waymark/tools/drive/model/build.hpp>
#include <waymark/types_se2/edge_gnss.hpp>

namespace waymark::drive {
namespace {

constexpr double kFixPeriod_s = 1;
constexpr double kNodePeriod_s = 0.25;
constexpr int kMostRounds = 10;
/// At 30 m/s and 0.5 rad/s the edge is then wrong by 0.2 mm.
constexpr double kSameOffset_s = 0.005;

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

std::optional<VertexIndex> time_offset_vertex(const Graph& graph,
                                              std::span<const formats::VertexRange> among) {
  for (VertexIndex v = 0; v < static_cast<VertexIndex>(graph.vertex_count()); ++v) {
    if (graph.vertex_type(v).tag != VertexTimeOffset::kTag || graph.fixed(v)) continue;
    for (const formats::VertexRange& range : among)
      if (graph.id(v) >= range.first && graph.id(v) <= range.last) return v;
  }
  return std::nullopt;
}

namespace {

/// The time offsets of the groups of a coarse drive, in the graph of one round.
struct Round {
  std::vector<AbsoluteGroup> groups;
  Graph graph;
  std::vector<std::optional<VertexIndex>> offsets;  ///< one for each group

  [[nodiscard]] bool estimates() const {
    return std::any_of(offsets.begin(), offsets.end(), [](const auto& offset) { return offset.has_value(); });
  }
};

Round begin_round(const CoarseDrive& coarse, const FusionSettings& settings, const TypeRegistry& registry) {
  BuiltGraph built = build_graph(coarse.drive, coarse.sensors, settings, registry);
  Round round{.groups = groups_of(coarse.drive, settings), .graph = std::move(built.graph), .offsets = {}};
  for (const AbsoluteGroup& group : round.groups)
    round.offsets.push_back(time_offset_vertex(round.graph, built.shares[group.name].vertices));
  return round;
}

/// Takes the offsets of a minimum. @returns how far the farthest one moved
double take_offsets(const Round& round, PlacedDrive& coarse) {
  double farthest_s = 0;
  for (std::size_t g = 0; g < round.groups.size(); ++g) {
    if (!round.offsets[g]) continue;
    const double offset_s = round.graph.value(*round.offsets[g])[0];
    for (const int source : round.groups[g].sources) {
      double& assumed_s = coarse.time_offsets_s[static_cast<std::size_t>(source)];
      farthest_s = std::max(farthest_s, std::abs(offset_s - assumed_s));
      assumed_s = offset_s;
    }
  }
  return farthest_s;
}

std::vector<std::optional<TimeOffset>> found_in(const Round& round, const FusionSettings& settings,
                                                const TypeRegistry& registry) {
  std::vector<std::optional<TimeOffset>> found(round.groups.size());
  for (std::size_t g = 0; g < round.groups.size(); ++g) {
    if (!round.offsets[g]) continue;
    const auto covariances = marginal_covariances(round.graph, std::vector{*round.offsets[g]});
    found[g] = TimeOffset{
        .value_s = round.graph.value(*round.offsets[g])[0],
        .sigma_s = std::sqrt(covariances[0](0, 0)),
        .prior_sigma_s = prior_sigma_of(for_absolute(settings, round.groups[g].name, registry), registry)};
  }
  return found;
}

}  // namespace

TimeOffsetSearch::TimeOffsetSearch(const PlacedDrive& placed, std::span<const PreparedSensor> sensors,
                                   const TypeRegistry& registry, const std::function<void()>& between)
    : coarse_(sample_of(coarsen(placed, sensors, kFixPeriod_s, kNodePeriod_s))),
      registry_(registry),
      between_(between) {}

std::vector<std::optional<TimeOffset>> TimeOffsetSearch::find(const FusionSettings& settings,
                                                              PlacedDrive& placed) {
  coarse_.drive.time_offsets_s = placed.time_offsets_s;
  const auto algorithm = registry_.make_algorithm("dogleg");
  BlockCholesky cholesky;
  StructuredSolver solver{cholesky};
  for (int count = 1;; ++count) {
    Round round = begin_round(coarse_, settings, registry_);
    if (!round.estimates()) return std::vector<std::optional<TimeOffset>>(round.groups.size());
    solver.build(round.graph, find_gauge(round.graph).held);
    optimize(round.graph, solver, *algorithm, {});
    if (between_) between_();
    keep_poses(round.graph, coarse_);
    const double moved_s = take_offsets(round, coarse_.drive);
    if (moved_s < kSameOffset_s || count == kMostRounds) {
      placed.time_offsets_s = coarse_.drive.time_offsets_s;
      return found_in(round, settings, registry_);
    }
  }
}

}  // namespace waymark::drive
