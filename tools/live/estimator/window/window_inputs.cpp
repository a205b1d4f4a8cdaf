#include <waymark/tools/live/estimator/window/window_inputs.hpp>

#include <algorithm>
#include <iterator>

namespace waymark::live {
namespace {

template <typename Input>
bool forget(WindowInputs::Inputs<Input>& inputs, Stamp moment, std::size_t kept) {
  bool any = false;
  while (inputs.size() > kept && stamp_of(inputs.front().input) < moment) {
    inputs.pop_front();
    any = true;
  }
  return any;
}

}  // namespace

void WindowInputs::correct(std::span<const StampedPose> poses) {
  if (poses.empty()) return;
  auto node = std::lower_bound(
      nodes_.begin(), nodes_.end(), poses.front().stamp,
      [](const Numbered<NodeInput>& known, Stamp stamp) { return known.input.stamp < stamp; });
  for (const StampedPose& pose : poses) {
    while (node != nodes_.end() && node->input.stamp < pose.stamp) ++node;
    if (node == nodes_.end()) return;
    if (node->input.stamp == pose.stamp) node->input.pose = pose.pose;
  }
}

void WindowInputs::forget_before(Stamp moment) {
  if (!forget(nodes_, moment, 2)) return;
  before_ = {};
  (void)forget(fixes_, moment, 0);
  (void)forget(readings_, moment, 0);
  (void)forget(ways_, moment, 0);
}

void WindowInputs::remove(const UnusedSources& unused) {
  std::erase_if(fixes_, [&](const Numbered<ClaimedFix>& fix) {
    return unused.receivers.contains(fix.input.fix.source);
  });
  std::erase_if(
      ways_, [&](const Numbered<MeasuredWay>& way) { return unused.odometries.contains(way.input.source); });
}

bool WindowInputs::has_nodes_of(const UnusedSources& unused) const {
  if (nodes_.empty()) return false;
  return std::any_of(std::next(nodes_.begin()), nodes_.end(), [&](const Numbered<NodeInput>& node) {
    return !node.input.interval.bridged && unused.odometries.contains(node.input.giver);
  });
}

PlacedStretch WindowInputs::stretch() const {
  PlacedStretch stretch;
  for (const auto& [number, node] : nodes_) {
    if (!stretch.stamps.empty()) {
      stretch.intervals.push_back(node.interval);
      stretch.givers.push_back(node.giver);
    }
    stretch.stamps.push_back(node.stamp);
    stretch.poses.push_back(node.pose);
  }
  for (const auto& [number, fix] : fixes_)
    if (!stretch.stamps.empty() && stretch.stamps.front() <= fix.fix.stamp) stretch.fixes.push_back(fix.fix);
  for (const auto& [number, way] : ways_)
    if (!stretch.stamps.empty() && stretch.stamps.front() <= way.from) stretch.ways.push_back(way);
  std::stable_sort(stretch.fixes.begin(), stretch.fixes.end(),
                   [](const Fix& a, const Fix& b) { return a.stamp < b.stamp; });
  std::stable_sort(stretch.ways.begin(), stretch.ways.end(),
                   [](const MeasuredWay& a, const MeasuredWay& b) { return a.to < b.to; });
  return stretch;
}

}  // namespace waymark::live
