#include <waymark/tools/live/estimator/guards/clock_relation.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

#include <waymark/core/base/detail/median.hpp>

namespace waymark::live {
namespace {

constexpr std::size_t kKeptFixes = 9;
constexpr std::size_t kFewestFixes = 3;
constexpr double kSpeaks = 2.5;     // intervals
constexpr double kApart_s = 60;     // no fix is later than that, or earlier
constexpr std::size_t kSteady = 5;  // fixes in a row that are apart alike
constexpr double kAlike_s = 0.5;    // a backlog that comes at once is no such row

void keep_newest(double value, std::deque<double>& values) {
  values.push_back(value);
  if (values.size() > kKeptFixes) values.pop_front();
}

double median_of_newest(const std::deque<double>& values) {
  return upper_median(std::vector<double>(values.begin(), values.end()));
}

}  // namespace

void ClockRelation::take_fix(int source, Stamp fix, Stamp odometry) {
  ++since_odometry_;
  Receiver& receiver = receivers_[source];
  judge_apart(receiver, fix, odometry);
  if (receiver.newest && fix <= *receiver.newest &&
      std::abs(seconds_between(fix, *receiver.newest)) < kApart_s)
    return;  // out of order
  const double interval_s = receiver.newest ? seconds_between(*receiver.newest, fix) : 0;
  if (interval_s > 0 && interval_s < kApart_s) keep_newest(interval_s, receiver.intervals_s);
  receiver.newest = fix;
  receiver.odometry = odometry;
  const double lateness_s = seconds_between(fix, odometry);
  if (std::abs(lateness_s) < kApart_s) keep_newest(lateness_s, receiver.lateness_s);
}

void ClockRelation::judge_apart(const Receiver& before, Stamp fix, Stamp odometry) {
  const double late_s = seconds_between(fix, odometry);
  if (std::abs(late_s) <= kApart_s) {
    apart_ = 0;
    return;
  }
  const bool moves = before.newest && *before.newest < fix && before.odometry < odometry;
  if (apart_ > 0 && moves && std::abs(late_s + apart_s_) > kAlike_s) apart_ = 0;
  if (apart_ == 0 || moves) ++apart_;
  apart_s_ = -late_s;
}

std::optional<double> ClockRelation::usual_lateness_s(int source) const {
  const auto known = receivers_.find(source);
  if (known == receivers_.end() || known->second.lateness_s.size() < kFewestFixes) return std::nullopt;
  return median_of_newest(known->second.lateness_s);
}

std::optional<double> ClockRelation::next_fix_within_s(Stamp odometry) const {
  std::optional<double> shortest;
  for (const auto& [source, receiver] : receivers_) {
    if (receiver.intervals_s.size() < kFewestFixes || receiver.lateness_s.size() < kFewestFixes) continue;
    const double interval_s = median_of_newest(receiver.intervals_s);
    if (seconds_between(receiver.odometry, odometry) > kSpeaks * interval_s) continue;
    shortest = shortest ? std::min(*shortest, interval_s) : interval_s;
  }
  return shortest;
}

std::optional<double> ClockRelation::apart_s() const {
  return apart_ >= kSteady ? std::optional(apart_s_) : std::nullopt;
}

void ClockRelation::forget() {
  receivers_.clear();
  apart_ = 0;
}

}  // namespace waymark::live
