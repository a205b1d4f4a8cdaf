#include <waymark/tools/drive/estimation/latency.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
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

/// The time offsets of the groups of a coarse drive, in the graph of one round.
struct DelayRound {
  std::vector<AbsoluteGroup> groups;
  Graph graph;
  std::vector<std::optional<VertexIndex>> offsets;  ///< one for each group

  /// @return s, of a group that has one
  [[nodiscard]] double offset(std::size_t group) const { return graph.value(*offsets[group])[0]; }
  [[nodiscard]] bool estimates() const {
    return std::any_of(offsets.begin(), offsets.end(), [](const auto& offset) { return offset.has_value(); });
  }
};

namespace {

DelayRound begin_round(const CoarseDrive& coarse, const FusionSettings& settings,
                       const TypeRegistry& registry) {
  BuiltGraph built = build_graph(coarse.drive, coarse.sensors, settings, registry);
  DelayRound round{
      .groups = groups_of(coarse.drive, settings), .graph = std::move(built.graph), .offsets = {}};
  for (const AbsoluteGroup& group : round.groups)
    round.offsets.push_back(time_offset_vertex(round.graph, built.shares[group.name].vertices));
  return round;
}

/// Takes the offsets of a minimum. @returns how far the farthest one moved
double take_offsets(const DelayRound& round, PlacedDrive& coarse) {
  double farthest_s = 0;
  for (std::size_t g = 0; g < round.groups.size(); ++g) {
    if (!round.offsets[g]) continue;
    const double offset_s = round.offset(g);
    for (const int source : round.groups[g].sources) {
      double& assumed_s = coarse.time_offsets_s[static_cast<std::size_t>(source)];
      farthest_s = std::max(farthest_s, std::abs(offset_s - assumed_s));
      assumed_s = offset_s;
    }
  }
  return farthest_s;
}

std::vector<std::optional<TimeOffset>> found_in(const DelayRound& round, const FusionSettings& settings,
                                                const TypeRegistry& registry) {
  std::vector<std::optional<TimeOffset>> found(round.groups.size());
  for (std::size_t g = 0; g < round.groups.size(); ++g) {
    if (!round.offsets[g]) continue;
    const auto covariances = marginal_covariances(round.graph, std::vector{*round.offsets[g]});
    found[g] = TimeOffset{
        .value_s = round.offset(g),
        .sigma_s = std::sqrt(covariances[0](0, 0)),
        .prior_sigma_s = prior_sigma_of(for_absolute(settings, round.groups[g].name, registry), registry)};
  }
  return found;
}

}  // namespace

struct TimeOffsetSearch::Minimum {
  DelayRound round;
  double cost = 0;  ///< half chi2
};

TimeOffsetSearch::TimeOffsetSearch(const PlacedDrive& placed, std::span<const PreparedSensor> sensors,
                                   const TypeRegistry& registry, const std::function<void()>& between)
    : coarse_(sample_of(coarsen(placed, sensors, kFixPeriod_s, kNodePeriod_s))),
      registry_(registry),
      between_(between) {}

TimeOffsetSearch::Minimum TimeOffsetSearch::converge(const FusionSettings& settings,
                                                     CoarseDrive& coarse) const {
  const auto algorithm = registry_.make_algorithm("dogleg");
  BlockCholesky cholesky;
  StructuredSolver solver{cholesky};
  for (int count = 1;; ++count) {
    Minimum minimum{begin_round(coarse, settings, registry_)};
    DelayRound& round = minimum.round;
    if (!round.estimates()) return minimum;
    solver.build(round.graph, find_gauge(round.graph).held);
    minimum.cost = 0.5 * optimize(round.graph, solver, *algorithm, {}).final_chi2;
    if (between_) between_();
    keep_poses(round.graph, coarse);
    const double moved_s = take_offsets(round, coarse.drive);
    if (moved_s < kSameOffset_s || count == kMostRounds) return minimum;
  }
}

void TimeOffsetSearch::admit_slip(const FusionSettings& settings, Minimum minimum,
                                  std::vector<std::optional<TimeOffset>>& offsets) const {
  constexpr double kUsual_per_mps2 = 0.005;
  constexpr int kMostSteps = 8;
  constexpr double kReached = 0.25;
  constexpr double kLongest = 2;
  // In units of the usual slip, which is the deviation of its prior.
  double slip = 0;
  // The least cost is between these. Newton's steps alone leap to and fro: far from it heavy tails flatten the cost.
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  const auto minimum_with = [&](double units) {
    CoarseDrive slipped = coarse_;
    remove_slip(units * kUsual_per_mps2, slipped.drive);
    return converge(settings, slipped);
  };
  for (int count = 1;; ++count) {
    const Minimum less = minimum_with(slip - 1);
    const Minimum more = minimum_with(slip + 1);
    const double gradient = slip + 0.5 * (more.cost - less.cost);
    if (count == 1 && gradient > 0)
      return;  // wheels do not slip to the other side; an odometry that is late does
    const double curvature = 1 + std::max(0.0, less.cost - 2 * minimum.cost + more.cost);
    (gradient < 0 ? low : high) = slip;
    double step = std::clamp(-gradient / curvature, -kLongest, kLongest);
    if (slip + step <= low || slip + step >= high) step = 0.5 * ((step < 0 ? low : high) - slip);
    slip += step;
    if (std::abs(step) < kReached || count == kMostSteps) {
      for (std::size_t g = 0; g < offsets.size(); ++g) {
        if (!offsets[g]) continue;
        const double per_slip_s = 0.5 * (more.round.offset(g) - less.round.offset(g));
        offsets[g]->value_s = minimum.round.offset(g) + per_slip_s * step;
        offsets[g]->sigma_s = std::hypot(offsets[g]->sigma_s, per_slip_s / std::sqrt(curvature));
        offsets[g]->slip = {slip * kUsual_per_mps2, kUsual_per_mps2 / std::sqrt(curvature)};
      }
      return;
    }
    minimum = minimum_with(slip);
  }
}

TimeOffsetSearch::Minimum TimeOffsetSearch::reach(const FusionSettings& settings, PlacedDrive& placed) {
  coarse_.drive.time_offsets_s = placed.time_offsets_s;
  Minimum minimum = converge(settings, coarse_);
  placed.time_offsets_s = coarse_.drive.time_offsets_s;
  return minimum;
}

void TimeOffsetSearch::move(const FusionSettings& settings, PlacedDrive& placed) {
  (void)reach(settings, placed);
}

std::vector<std::optional<TimeOffset>> TimeOffsetSearch::find(const FusionSettings& settings,
                                                              PlacedDrive& placed) {
  Minimum minimum = reach(settings, placed);
  std::vector<std::optional<TimeOffset>> found = found_in(minimum.round, settings, registry_);
  const bool seems_late = std::any_of(
      found.begin(), found.end(), [](const auto& offset) { return offset && offset->odds_of_none() <= 1; });
  if (seems_late) admit_slip(settings, std::move(minimum), found);
  return found;
}

}  // namespace waymark::drive
