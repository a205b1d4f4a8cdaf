#include <algorithm>
#include <cmath>
#include <utility>

#include <waymark/core/base/detail/median.hpp>
#include <waymark/core/drive/log_reader.hpp>
#include <waymark/core/drive/modeling.hpp>

namespace waymark {

OdometryModel::~OdometryModel() = default;
GnssModeling::~GnssModeling() = default;

std::vector<Eigen::Vector2d> GnssModeling::lasting_errors(std::span<const Fix>, const Graph&) const {
  return {};
}
SensorModel::~SensorModel() = default;
void SensorModel::check_drive(std::span<const Fix>, const SensorTable&) const {}

double median_accuracy(std::span<const Fix> fixes) {
  std::vector<double> ordered;
  ordered.reserve(fixes.size());
  for (const Fix& fix : fixes) {
    if (fix.status == FixStatus::accepted && fix.accuracy_claimed) ordered.push_back(fix.accuracy_m());
  }
  return ordered.empty() ? 0 : upper_median(std::move(ordered));
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
