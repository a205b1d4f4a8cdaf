#include <waymark/tools/drive/estimation/coarse.hpp>

#include <cmath>
#include <map>

namespace waymark::drive {
namespace {

std::vector<std::size_t> kept_fixes(const std::vector<Fix>& fixes, double period_s) {
  std::map<int, Stamp> last;
  std::vector<std::size_t> kept;
  for (std::size_t i = 0; i < fixes.size(); ++i) {
    if (fixes[i].status != FixStatus::accepted) continue;
    const auto before = last.find(fixes[i].source);
    if (before != last.end() && seconds_between(before->second, fixes[i].stamp) < 0.9 * period_s) continue;
    last[fixes[i].source] = fixes[i].stamp;
    kept.push_back(i);
  }
  return kept;
}

/// Adds the part that follows.
void merge(Interval& whole, const Interval& part) {
  const double dt = whole.dt_s + part.dt_s;
  const auto change = [](double mean, double before, double next, double after) {
    return next + 0.5 * after - (mean - 0.5 * before);
  };
  whole.speed_change_mps =
      change(whole.speed_mps, whole.speed_change_mps, part.speed_mps, part.speed_change_mps);
  whole.yaw_rate_change_radps = change(whole.yaw_rate_radps, whole.yaw_rate_change_radps, part.yaw_rate_radps,
                                       part.yaw_rate_change_radps);
  whole.speed_mps = (whole.speed_mps * whole.dt_s + part.speed_mps * part.dt_s) / dt;
  whole.yaw_rate_radps = (whole.yaw_rate_radps * whole.dt_s + part.yaw_rate_radps * part.dt_s) / dt;
  whole.dt_s = dt;
}

}  // namespace

PlacedDrive coarsen(const PlacedDrive& placed, double fix_period_s, double node_period_s) {
  const Timeline& timeline = placed.timeline;
  const std::vector<std::size_t> kept = kept_fixes(placed.fixes, fix_period_s);
  std::vector<char> needed(timeline.stamps.size(), 0);
  for (const std::size_t fix : kept) needed[timeline.fix_node[fix]] = 1;

  PlacedDrive coarse;
  coarse.gate = placed.gate;
  coarse.receivers = placed.receivers;
  coarse.time_offsets_s = placed.time_offsets_s;
  coarse.odometry_name = placed.odometry_name;
  coarse.relative = placed.relative;
  coarse.standstill_mps = placed.standstill_mps;
  coarse.gap_noise_factor = placed.gap_noise_factor;
  std::vector<std::size_t> coarse_node(timeline.stamps.size(), 0);
  const auto add_node = [&](std::size_t node) {
    coarse_node[node] = coarse.timeline.stamps.size();
    coarse.timeline.stamps.push_back(timeline.stamps[node]);
    coarse.start.poses.push_back(placed.start.poses[node]);
  };
  const auto stands = [&](const Interval& i) { return std::abs(i.speed_mps) < placed.standstill_mps; };
  add_node(0);
  Interval open = timeline.intervals.front();
  for (std::size_t i = 1; i < timeline.intervals.size(); ++i) {
    const Interval& next = timeline.intervals[i];
    const bool alike = stands(open) == stands(next) && open.bridged == next.bridged;
    if (alike && needed[i] == 0 && open.dt_s + next.dt_s <= node_period_s) {
      merge(open, next);
      continue;
    }
    coarse.timeline.intervals.push_back(open);
    add_node(i);
    open = next;
  }
  coarse.timeline.intervals.push_back(open);
  add_node(timeline.intervals.size());

  for (const std::size_t i : kept) {
    const std::size_t node = coarse_node[timeline.fix_node[i]];
    coarse.timeline.fix_node.push_back(node);
    coarse.fixes.push_back(placed.fixes[i]);
    coarse.fixes.back().vertex = vertex_of(node);
  }
  if (!coarse.relative.empty()) coarse.runs = motion_runs(coarse.timeline, coarse.relative, coarse.fixes);
  return coarse;
}

}  // namespace waymark::drive
