#include <waymark/tools/live/estimator/reckoning.hpp>

#include <algorithm>
#include <cmath>
#include <iterator>

#include <waymark/tools/drive/nodes/timeline.hpp>

namespace waymark::live {

Interval Reckoning::motion(std::size_t before, const OdometrySample& to) const {
  return drive::motion_between(nodes_[before].sample, to, grid_scale_, gap_s_,
                               before > 0 ? &nodes_[before - 1].sample : nullptr);
}

Reckoning::Node Reckoning::moved(const Node& from, const Interval& motion) const {
  Node to = from;
  if (motion.stands(standstill_mps_)) return to;
  const Eigen::Vector3d way(motion.speed_mps * motion.dt_s, 0, motion.yaw_rate_radps * motion.dt_s);
  to.pose = compose(to_pose(from.pose), se2_exp(way)).vector();
  to.way_m += std::abs(way[0]);
  return to;
}

void Reckoning::begin_with(const OdometrySample& sample, std::size_t giver) {
  nodes_.push_back({sample, giver});
}

Interval Reckoning::motion_to(const OdometrySample& sample) const {
  return motion(nodes_.size() - 1, sample);
}

Interval Reckoning::motion_to_node(std::size_t node) const {
  return motion(node - 1, nodes_[node].sample);
}

void Reckoning::add(const OdometrySample& sample, std::size_t giver, const Interval& motion) {
  Node next = moved(nodes_.back(), motion);
  next.sample = sample;
  next.giver = giver;
  nodes_.push_back(next);
}

Reckoning::Node Reckoning::at(Stamp stamp) const {
  const auto after = std::lower_bound(nodes_.begin(), nodes_.end(), stamp,
                                      [](const Node& of, Stamp moment) { return of.sample.stamp < moment; });
  if (after == nodes_.end()) return nodes_.back();
  if (after == nodes_.begin()) return *after;
  const Node& before = *std::prev(after);
  Interval part = motion(static_cast<std::size_t>(after - nodes_.begin()) - 1, after->sample);
  part.dt_s = seconds_between(before.sample.stamp, stamp);
  return moved(before, part);
}

void Reckoning::keep_last(double seconds) {
  const Stamp now = nodes_.back().sample.stamp;
  while (nodes_.size() > 2 && seconds_between(nodes_[1].sample.stamp, now) > seconds) nodes_.pop_front();
}

}  // namespace waymark::live
