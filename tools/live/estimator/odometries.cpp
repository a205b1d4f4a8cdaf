#include <waymark/tools/live/estimator/odometries.hpp>

#include <algorithm>

#include <waymark/tools/drive/logs/time_series.hpp>

namespace waymark::live {
namespace {

constexpr double kSecondsKept = 3;
constexpr std::size_t kLeastKept = 8;  // of a slow source

/// Returns the node nearest in time, the earlier of two.
Stamp nearest_stamp(std::span<const Stamp> nodes, Stamp moment) {
  const auto after = std::lower_bound(nodes.begin(), nodes.end(), moment);
  if (after == nodes.end()) return nodes.back();
  if (after == nodes.begin()) return *after;
  const Stamp before = *std::prev(after);
  return seconds_between(before, moment) <= seconds_between(moment, *after) ? before : *after;
}

}  // namespace

bool Odometries::take(std::size_t source, const OdometrySample& sample) {
  Source& own = sources_[source];
  if (!own.samples.empty() && sample.stamp <= own.samples.back().stamp) return false;
  const bool goes_on =
      !own.samples.empty() && seconds_between(own.samples.back().stamp, sample.stamp) <= own.silence_s;
  if (!goes_on) {
    own.samples.clear();
    own.begin = sample.stamp;
    own.joined.reset();
    own.asked.reset();
  }
  own.samples.push_back(sample);
  while (own.samples.size() > kLeastKept &&
         seconds_between(own.samples.front().stamp, sample.stamp) > kSecondsKept)
    own.samples.pop_front();
  const std::vector<OdometrySample> kept(own.samples.begin(), own.samples.end());
  own.silence_s = drive::longest_silence_s(drive::series_of(kept, &OdometrySample::speed_mps), gap_s_);
  return true;
}

bool Odometries::another_speaks(std::size_t source, Stamp now) const {
  return std::any_of(sources_.begin(), sources_.end(),
                     [&](const Source& other) { return &other != &sources_[source] && other.speaks(now); });
}

bool Odometries::covers(const Source& source, Stamp last, Stamp moment) const {
  return source.begin <= last && source.speaks(moment);
}

std::vector<OdometrySample> Odometries::nodes(std::size_t source, std::optional<Stamp> last) const {
  const Source& own = sources_[source];
  const OdometrySample& sample = own.samples.back();
  if (!last) return {sample};
  if (sample.stamp <= *last) return {};
  const bool covered = covers(own, *last, sample.stamp);
  for (std::size_t other = 0; other < sources_.size(); ++other) {
    if (other == source) continue;
    // One that has just begun leaves the nodes to any other; else to those before it.
    if ((other < source || !covered) && covers(sources_[other], *last, sample.stamp)) return {};
  }
  if (!covered) return {sample};  // nobody has measured what lies between
  const auto first =
      std::upper_bound(own.samples.begin(), own.samples.end(), *last,
                       [](Stamp moment, const OdometrySample& of) { return moment < of.stamp; });
  return {first, own.samples.end()};
}

void Odometries::made_node(std::size_t source, Stamp stamp) {
  sources_[source].joined = stamp;
  sources_[source].asked = stamp;
}

Interval Odometries::between(std::size_t source, Stamp from, Stamp to, double grid_scale) const {
  const std::deque<OdometrySample>& samples = sources_[source].samples;
  const auto later = [](Stamp moment, const OdometrySample& of) { return moment < of.stamp; };
  auto first = std::upper_bound(samples.begin(), samples.end(), from, later);
  if (first != samples.begin()) --first;
  auto end = std::upper_bound(first, samples.end(), to, later);
  if (end != samples.end()) ++end;
  const std::vector<OdometrySample> around(first, end);
  const drive::TimeSeries speed = drive::series_of(around, &OdometrySample::speed_mps);
  const drive::TimeSeries yaw_rate = drive::series_of(around, &OdometrySample::yaw_rate_radps);
  const drive::SeriesIntegral speeds(speed);
  const drive::SeriesIntegral yaw_rates(yaw_rate);
  Interval interval;
  interval.dt_s = seconds_between(from, to);
  interval.speed_mps = grid_scale * speeds.mean(from, to);
  interval.yaw_rate_radps = yaw_rates.mean(from, to);
  interval.speed_change_mps = grid_scale * (speeds.mean(to, to) - speeds.mean(from, from));
  interval.yaw_rate_change_radps = yaw_rates.mean(to, to) - yaw_rates.mean(from, from);
  return interval;
}

void Odometries::find_ways(std::size_t index, std::span<const Stamp> nodes, double grid_scale,
                           std::vector<MeasuredWay>& ways) {
  Source& own = sources_[index];
  for (const OdometrySample& sample : own.samples) {
    if (own.asked && sample.stamp <= *own.asked) continue;
    if (sample.stamp > nodes.back()) return;
    const Stamp node = nearest_stamp(nodes, sample.stamp);
    if (node > own.samples.back().stamp) return;  // the next sample tells the motion up to there
    own.asked = sample.stamp;
    if (node < own.begin || (own.joined && node <= *own.joined)) continue;
    if (own.joined && *own.joined >= std::max(own.begin, nodes.front()))
      ways.push_back({index, *own.joined, node, between(index, *own.joined, node, grid_scale)});
    own.joined = node;
  }
}

std::vector<MeasuredWay> Odometries::ways(std::span<const Stamp> nodes, std::size_t giver,
                                          double grid_scale) {
  std::vector<MeasuredWay> ways;
  for (std::size_t index = 0; index < sources_.size(); ++index)
    if (index != giver && !sources_[index].samples.empty()) find_ways(index, nodes, grid_scale, ways);
  return ways;
}

void Odometries::clear() {
  for (Source& source : sources_) source = {};
}

void put_nodes_first(drive::DriveDescription& description) {
  std::stable_partition(description.odometry.begin(), description.odometry.end(),
                        [](const drive::OdometryConfig& odometry) { return odometry.gives_nodes; });
}

}  // namespace waymark::live
