#include <waymark/tools/drive/model/motion_runs.hpp>

#include <algorithm>
#include <utility>

#include <waymark/tools/drive/logs/time_series.hpp>

namespace waymark::drive {
namespace {

/// Samples of one source without a gap between them.
using Segment = std::span<const OdometrySample>;

std::vector<Segment> segments_of(const PreparedOdometry& source) {
  const std::span<const OdometrySample> samples = source.samples;
  std::vector<Segment> segments;
  std::size_t begin = 0;
  for (std::size_t i = 1; i <= samples.size(); ++i) {
    const bool goes_on =
        i < samples.size() && seconds_between(samples[i - 1].stamp, samples[i].stamp) <= source.gap_s;
    if (goes_on) continue;
    if (i - begin >= 2) segments.push_back(samples.subspan(begin, i - begin));
    begin = i;
  }
  return segments;
}

/// Speed and yaw rate of a segment over time.
class Motion {
 public:
  explicit Motion(Segment segment)
      : samples_(segment.begin(), segment.end()),
        speed_(series_of(samples_, &OdometrySample::speed_mps)),
        yaw_rate_(series_of(samples_, &OdometrySample::yaw_rate_radps)),
        speed_integral_(speed_),
        yaw_rate_integral_(yaw_rate_) {}

  [[nodiscard]] Interval between(Stamp from, Stamp to, double grid_scale) const {
    Interval interval;
    interval.speed_mps = grid_scale * speed_integral_.mean(from, to);
    interval.yaw_rate_radps = yaw_rate_integral_.mean(from, to);
    interval.dt_s = seconds_between(from, to);
    interval.speed_change_mps =
        grid_scale * (speed_integral_.mean(to, to) - speed_integral_.mean(from, from));
    interval.yaw_rate_change_radps = yaw_rate_integral_.mean(to, to) - yaw_rate_integral_.mean(from, from);
    const auto before = [](const OdometrySample& sample, Stamp stamp) { return sample.stamp < stamp; };
    const auto next = std::lower_bound(samples_.begin(), samples_.end(), to, before);
    interval.turns_on_spot = next != samples_.end() && next->turns_on_spot;
    return interval;
  }

 private:
  std::vector<OdometrySample> samples_;
  TimeSeries speed_;
  TimeSeries yaw_rate_;
  SeriesIntegral speed_integral_;
  SeriesIntegral yaw_rate_integral_;
};

/// Which intervals of the timeline some source has measured.
class Coverage {
 public:
  explicit Coverage(const Timeline& timeline) : covered_(timeline.intervals.size(), 0) {}

  /// Tells whether a node has an interval that nobody has measured.
  [[nodiscard]] bool is_loose(std::size_t node) const {
    return (node > 0 && covered_[node - 1] == 0) || (node < covered_.size() && covered_[node] == 0);
  }
  /// Tells whether somebody has measured an interval at a node.
  [[nodiscard]] bool touches(std::size_t node) const {
    return (node > 0 && covered_[node - 1] != 0) || (node < covered_.size() && covered_[node] != 0);
  }
  [[nodiscard]] bool covers(std::size_t interval) const { return covered_[interval] != 0; }
  void add(const MotionRun& run) {
    for (std::size_t i = 1; i < run.nodes.size(); ++i)
      if (run.nodes[i] == run.nodes[i - 1] + 1) covered_[run.nodes[i - 1]] = 1;
  }

 private:
  std::vector<char> covered_;
};

/// Returns the nodes within a segment that a source joins.
std::vector<std::size_t> nodes_of(Segment segment, bool all, const std::vector<Stamp>& stamps,
                                  const Coverage& coverage) {
  const auto first = std::lower_bound(stamps.begin(), stamps.end(), segment.front().stamp);
  const auto end = std::upper_bound(first, stamps.end(), segment.back().stamp);
  std::vector<std::size_t> nodes;
  std::size_t sample = 0;
  for (auto at = first; at != end; ++at) {
    const auto node = static_cast<std::size_t>(at - stamps.begin());
    const auto away = [&](std::size_t n) {
      return n < stamps.size() ? std::abs(seconds_between(stamps[n], segment[sample].stamp)) : 1e300;
    };
    bool is_nearest = false;
    while (sample < segment.size() && away(node + 1) >= away(node)) {
      is_nearest = true;
      ++sample;
    }
    if (all || is_nearest || coverage.is_loose(node)) nodes.push_back(node);
  }
  return nodes;
}

/// Gives the intervals that no source has measured to the first one. The gap of the timeline may be that of
/// a slower source, so a silence that is long for the first one is bridged here.
/// @param gap_s of the first source
void add_bridges(const Timeline& timeline, const Coverage& coverage, double gap_s,
                 std::vector<MotionRun>& runs) {
  const std::size_t count = timeline.intervals.size();
  for (std::size_t k = 0; k < count;) {
    std::size_t end = k;
    while (end < count && !coverage.covers(end)) ++end;
    if (end == k) {
      ++k;
      continue;
    }
    const double silent_s = seconds_between(timeline.stamps[k], timeline.stamps[end]);
    MotionRun run{.source = 0, .nodes = {k}, .intervals = {}, .beside = {0}};
    for (; k < end; ++k) {
      run.nodes.push_back(k + 1);
      run.beside.push_back(0);
      Interval interval = timeline.intervals[k];
      if (!interval.bridged && silent_s > gap_s) {
        interval.bridged = true;
        interval.gap_s = silent_s;
      }
      run.intervals.push_back(interval);
    }
    runs.push_back(std::move(run));
  }
}

}  // namespace

std::vector<MotionRun> motion_runs(const Timeline& timeline, std::span<const PreparedOdometry> relative,
                                   std::span<const Fix> fixes) {
  std::vector<MotionRun> runs;
  Coverage coverage(timeline);
  for (std::size_t source = 0; source < relative.size(); ++source) {
    std::size_t nearest_fix = 0;
    for (const Segment segment : segments_of(relative[source])) {
      MotionRun run{.source = source,
                    .nodes = nodes_of(segment, source == 0, timeline.stamps, coverage),
                    .intervals = {}};
      if (run.nodes.size() < 2) continue;
      const Motion motion(segment);
      for (std::size_t i = 1; i < run.nodes.size(); ++i) {
        const Stamp from = timeline.stamps[run.nodes[i - 1]];
        const Stamp to = timeline.stamps[run.nodes[i]];
        run.intervals.push_back(motion.between(from, to, grid_scale_at(from, fixes, nearest_fix)));
      }
      for (const std::size_t node : run.nodes) run.beside.push_back(coverage.touches(node) ? 1 : 0);
      coverage.add(run);
      runs.push_back(std::move(run));
    }
  }
  if (!relative.empty()) add_bridges(timeline, coverage, relative.front().gap_s, runs);
  std::stable_sort(runs.begin(), runs.end(), [](const MotionRun& a, const MotionRun& b) {
    return std::pair(a.source, a.nodes.front()) < std::pair(b.source, b.nodes.front());
  });
  return runs;
}

}  // namespace waymark::drive
