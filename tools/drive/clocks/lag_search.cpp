#include <waymark/tools/drive/clocks/lag_search.hpp>

#include <algorithm>
#include <cmath>

#include <waymark/core/base/detail/median.hpp>
#include <waymark/tools/drive/clocks/common_motion.hpp>
#include <waymark/tools/drive/logs/time_series.hpp>

namespace waymark::drive {
namespace {

constexpr double kTick_s = 0.1;  // of the grid
constexpr double kStep_s = 0.5;  // of the search
constexpr std::size_t kMostReadings = 1500;
constexpr std::size_t kLeastReadings = 20;
constexpr double kLeastOverlap_s = 30;
constexpr double kLeastScore = 12;  // e^12 against chance: thousands of alignments are tried
constexpr double kLeastLead = 5;    // over an alignment elsewhere
constexpr double kElsewhere_s = 5;  // farther than the motion resembles itself
constexpr double kSoundCorrelation = 0.5;

}  // namespace

void LagSearch::Grid::add(double value) {
  integral.push_back(integral.back() + kTick_s * value);
}

double LagSearch::Grid::at(double time_s) const {
  const double tick = std::clamp(time_s / kTick_s, 0.0, static_cast<double>(integral.size() - 1));
  const auto before = std::min(static_cast<std::size_t>(tick), integral.size() - 2);
  const double share = tick - static_cast<double>(before);
  return integral[before] + share * (integral[before + 1] - integral[before]);
}

double LagSearch::Grid::mean(double from_s, double to_s) const {
  return (at(to_s) - at(from_s)) / (to_s - from_s);
}

LagSearch::LagSearch(const std::vector<OdometrySample>& odometry, const GnssMotion& speeds,
                     const GnssMotion& turns) {
  const Stamp first = odometry.front().stamp;
  length_s_ = seconds_between(first, odometry.back().stamp);
  const double silence_s =
      longest_silence_s(series_of(odometry, &OdometrySample::speed_mps), kLongestSilence_s);
  const auto ticks = static_cast<std::size_t>(std::max(1.0, std::floor(length_s_ / kTick_s)));
  std::size_t next = 0;
  for (std::size_t tick = 0; tick < ticks; ++tick) {
    const double middle_s = (static_cast<double>(tick) + 0.5) * kTick_s;
    while (next + 1 < odometry.size() && seconds_between(first, odometry[next + 1].stamp) <= middle_s) ++next;
    // The speed of a receiver has no sign.
    speed_.add(std::abs(odometry[next].speed_mps));
    yaw_rate_.add(odometry[next].yaw_rate_radps);
    const std::size_t after = std::min(next + 1, odometry.size() - 1);
    silent_.add(seconds_between(odometry[next].stamp, odometry[after].stamp) > silence_s ? 1 : 0);
  }
  add(speeds, first, speeds_);
  add(turns, first, turns_);
}

// Readings of a second: the motion changes no faster, and faster ones would repeat what they say.
void LagSearch::add(const GnssMotion& motion, Stamp first, std::vector<Reading>& readings) const {
  constexpr double kApart_s = 0.9;
  constexpr double kUsual = 2.5;
  std::vector<const Stretch*> spaced;
  for (const Stretch& stretch : motion.stretches)
    if (spaced.empty() || seconds_between(spaced.back()->from, stretch.from) >= kApart_s)
      spaced.push_back(&stretch);
  const std::size_t every = spaced.size() / kMostReadings + 1;
  std::vector<double> apart_s;
  for (std::size_t i = every; i < spaced.size(); i += every)
    apart_s.push_back(seconds_between(spaced[i - every]->from, spaced[i]->from));
  const double longest_s = apart_s.empty() ? 0 : kUsual * upper_median(apart_s);
  for (std::size_t i = 0; i < spaced.size(); i += every)
    readings.push_back({seconds_between(first, spaced[i]->from), seconds_between(first, spaced[i]->to),
                        spaced[i]->value, i > 0 && apart_s[i / every - 1] < longest_s});
}

double LagSearch::correlation(const Grid& grid, const std::vector<Reading>& readings, double late_s,
                              double& score) const {
  CommonMotion common;
  bool has_before = false;
  for (const Reading& reading : readings) {
    const double from_s = reading.from_s + late_s;
    const double to_s = reading.to_s + late_s;
    const bool is_known = from_s >= 0 && to_s <= length_s_ && !(silent_.mean(from_s, to_s) > 0);
    if (is_known) common.add(grid.mean(from_s, to_s), reading.value, has_before && reading.follows);
    has_before = is_known;
  }
  if (common.size() < kLeastReadings) return -1;
  score += common.score();
  return common.correlation();
}

std::optional<Lag> LagSearch::at(double late_s) const {
  Lag lag{.late_s = late_s};
  lag.speed_correlation = correlation(speed_, speeds_, late_s, lag.score);
  lag.turn_correlation = correlation(yaw_rate_, turns_, late_s, lag.score);
  return lag.speed_correlation > -1 || lag.turn_correlation > -1 ? std::optional(lag) : std::nullopt;
}

std::optional<Lag> LagSearch::best(double from_s, double to_s) const {
  std::optional<Lag> best;
  for (double late_s = std::ceil(from_s / kStep_s) * kStep_s; late_s <= to_s; late_s += kStep_s) {
    const std::optional<Lag> lag = at(late_s);
    if (lag && (!best || lag->score > best->score)) best = lag;
  }
  return best;
}

std::optional<Lag> LagSearch::find(double largest_s) const {
  if (speeds_.empty()) return std::nullopt;
  double from_s = kLeastOverlap_s - speeds_.back().to_s;
  double to_s = length_s_ - kLeastOverlap_s - speeds_.front().from_s;
  if (largest_s > 0) {
    from_s = std::max(from_s, -largest_s);
    to_s = std::min(to_s, largest_s);
  }
  const std::optional<Lag> found = best(from_s, to_s);
  if (!found || found->score < kLeastScore ||
      std::max(found->speed_correlation, found->turn_correlation) < kSoundCorrelation)
    return std::nullopt;
  const auto is_rival = [&](const std::optional<Lag>& other) {
    return other && other->score > found->score - kLeastLead;
  };
  if (is_rival(best(from_s, found->late_s - kElsewhere_s)) ||
      is_rival(best(found->late_s + kElsewhere_s, to_s)))
    return std::nullopt;
  return found;
}

}  // namespace waymark::drive
