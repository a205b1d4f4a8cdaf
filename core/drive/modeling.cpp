#include <algorithm>
#include <cmath>
#include <utility>

#include <waymark/core/base/detail/median.hpp>
#include <waymark/core/drive/log_reader.hpp>
#include <waymark/core/drive/modeling.hpp>
#include <waymark/core/graph/graph.hpp>

namespace waymark {

OdometryModel::~OdometryModel() = default;
GnssModeling::~GnssModeling() = default;

std::vector<ExpectedError> GnssModeling::lasting_errors(std::span<const Fix>, const Graph&) const {
  return {};
}

Eigen::Vector2d ExpectedError::mean(const Graph& graph) const {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (const Term& term : terms) {
    const auto value = graph.value(term.vertex);
    sum += term.factor * Eigen::Vector2d(value[0], value[1]);
  }
  return sum;
}

SensorModel::~SensorModel() = default;
void SensorModel::check_drive(std::span<const Fix>, const SensorTable&) const {}
std::vector<RoughPosition> SensorModel::rough_positions(const SensorTable&) const {
  return {};
}

SolutionKind kind_of(FixQuality quality) {
  if (quality == FixQuality::fixed) return SolutionKind::fixed;
  return quality == FixQuality::floating ? SolutionKind::floating : SolutionKind::code;
}

double ClaimedAccuracies::of(SolutionKind kind) const {
  const auto at = static_cast<std::size_t>(kind);
  const double claim_m = median_m[at].value_or(0);
  return claim_m > 0 || kinds() < 2 ? claim_m : stand_in_m[at];
}

double ClaimedAccuracies::reference_m() const {
  const auto coarsest = std::find_if(median_m.begin(), median_m.end(), [](const auto& m) { return m; });
  return coarsest == median_m.end() ? 0 : of(static_cast<SolutionKind>(coarsest - median_m.begin()));
}

int ClaimedAccuracies::kinds() const {
  return static_cast<int>(std::count_if(median_m.begin(), median_m.end(), [](const auto& m) { return m; }));
}

ClaimedAccuracies claimed_accuracies(std::span<const Fix> fixes) {
  ClaimedAccuracies claimed;
  std::array<std::vector<double>, 3> claims;
  std::array<std::vector<double>, 3> stand_ins;
  for (const Fix& fix : fixes) {
    if (fix.status != FixStatus::accepted) continue;
    const auto kind = static_cast<std::size_t>(kind_of(fix.told.quality));
    claimed.median_m[kind] = 0;
    (fix.accuracy_claimed ? claims : stand_ins)[kind].push_back(fix.accuracy_m());
  }
  for (std::size_t kind = 0; kind < claims.size(); ++kind) {
    if (!claims[kind].empty()) claimed.median_m[kind] = upper_median(std::move(claims[kind]));
    if (!stand_ins[kind].empty()) claimed.stand_in_m[kind] = upper_median(std::move(stand_ins[kind]));
  }
  return claimed;
}

std::optional<NodeInTime> nearest_node(const DriveNodes& nodes, Stamp moment, double tolerance_s) {
  if (nodes.stamps.empty()) return std::nullopt;
  const auto after = std::lower_bound(nodes.stamps.begin(), nodes.stamps.end(), moment);
  auto node = static_cast<std::size_t>(after - nodes.stamps.begin());
  if (after == nodes.stamps.end()) {
    --node;
  } else if (node > 0 &&
             seconds_between(nodes.stamps[node - 1], moment) < seconds_between(moment, nodes.stamps[node])) {
    --node;
  }
  const double ahead = seconds_between(nodes.stamps[node], moment);
  const bool outside = moment < nodes.stamps.front() || moment > nodes.stamps.back();
  if (outside && std::abs(ahead) > tolerance_s) return std::nullopt;
  return NodeInTime{node, ahead};
}

const Interval& motion_at(const DriveNodes& nodes, std::size_t node) {
  return nodes.intervals[std::min(node, nodes.intervals.size() - 1)];
}

MotionFromNode motion_from_node(const DriveNodes& nodes, const NodeInTime& moment) {
  const double t = moment.ahead_s;
  const bool after = t > 0;
  const bool beyond = after ? moment.node + 1 == nodes.stamps.size() : moment.node == 0;
  const Interval& interval = motion_at(nodes, after || beyond ? moment.node : moment.node - 1);
  const Eigen::Vector3d mean(interval.speed_mps, 0, interval.yaw_rate_radps);
  const Eigen::Vector3d change(interval.speed_change_mps, 0, interval.yaw_rate_change_radps);
  const double end = after != beyond ? -0.5 : 0.5;  // of the interval at which the node is
  const double share = beyond ? 0 : t / interval.dt_s;
  return {t * (mean + (end + 0.5 * share) * change), mean + (end + share) * change};
}

}  // namespace waymark
