#include <waymark/tools/evaluation/weak_stretches.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include <fmt/format.h>

namespace waymark::evaluation {
namespace {

constexpr double kPart = 0.5;          // of the peak, down to which a stretch reaches
constexpr double kLeastPeak = 1.2;     // medians
constexpr double kLongestStep_s = 10;  // between neighbours of a stretch
constexpr double kShareToTell = 0.3;   // of the fixes of a stretch
constexpr double kUsualIntervals = 3;  // without a fix that is used
constexpr double kTimesUsual = 1.5;    // of a dilution of precision, or of the raw error

/// One epoch with a value.
struct ValueAt {
  std::size_t epoch = 0;
  double value = 0;
};

double median_of(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return sorted_median(values);
}

/// The usual values of a drive, for comparison.
struct Usual {
  double interval_s = kUndefined;  ///< between fixes that are used
  double hdop = kUndefined;
  double satellites = kUndefined;
  double raw_m = kUndefined;
  std::map<FixQuality, double> shares;
};

template <typename Value>
double median_over(std::span<const EpochResult> epochs, const Value& value) {
  std::vector<double> values;
  for (const EpochResult& epoch : epochs) {
    const std::optional<double> v = value(epoch);
    if (v) values.push_back(*v);
  }
  return median_of(std::move(values));
}

std::optional<double> hdop_of(const EpochResult& epoch) {
  return epoch.told.hdop > 0 ? std::optional(epoch.told.hdop) : std::nullopt;
}
std::optional<double> satellites_of(const EpochResult& epoch) {
  return epoch.told.satellites >= 0 ? std::optional<double>(epoch.told.satellites) : std::nullopt;
}
std::optional<double> raw_error_of(const EpochResult& epoch) {
  return epoch.gnss_offset_m ? std::optional(epoch.gnss_offset_m->norm()) : std::nullopt;
}

std::map<FixQuality, double> shares_of(std::span<const EpochResult> epochs) {
  std::map<FixQuality, double> shares;
  for (const EpochResult& epoch : epochs)
    shares[epoch.told.quality] += 1.0 / static_cast<double>(epochs.size());
  return shares;
}

Usual usual_of(std::span<const EpochResult> epochs) {
  std::vector<double> intervals;
  std::optional<Stamp> last;
  for (const EpochResult& epoch : epochs) {
    if (epoch.status != FixStatus::accepted) continue;
    if (last && epoch.stamp > *last) intervals.push_back(seconds_between(*last, epoch.stamp));
    last = epoch.stamp;
  }
  return {.interval_s = median_of(std::move(intervals)),
          .hdop = median_over(epochs, hdop_of),
          .satellites = median_over(epochs, satellites_of),
          .raw_m = median_over(epochs, raw_error_of),
          .shares = shares_of(epochs)};
}

/// Returns the longest time without a fix that is used, between the ones before and after a
/// stretch.
double longest_without_fix(std::span<const EpochResult> epochs, std::size_t begin, std::size_t end) {
  const auto used = [&](std::size_t i) { return epochs[i].status == FixStatus::accepted; };
  while (begin > 0 && !used(begin)) --begin;
  if (begin > 0) --begin;  // the gap before the stretch is part of it
  while (end + 1 < epochs.size() && !used(end)) ++end;
  Stamp last = epochs[begin].stamp;
  double longest = 0;
  for (std::size_t i = begin; i <= end; ++i) {
    if (!used(i) && i != end) continue;
    longest = std::max(longest, seconds_between(last, epochs[i].stamp));
    last = epochs[i].stamp;
  }
  return longest;
}

void tell_status(std::span<const EpochResult> part, std::vector<std::string>& reasons) {
  for (const auto& [status, word] :
       {std::pair{FixStatus::rejected, "rejected"}, std::pair{FixStatus::withheld, "withheld"}}) {
    const FixStatus wanted = status;
    const auto count = std::count_if(part.begin(), part.end(),
                                     [&](const EpochResult& epoch) { return epoch.status == wanted; });
    const double share = static_cast<double>(count) / static_cast<double>(part.size());
    if (share >= kShareToTell) reasons.push_back(fmt::format("{:.0f} % of the fixes {}", 100 * share, word));
  }
}

void tell_receiver(std::span<const EpochResult> part, const Usual& usual, std::vector<std::string>& reasons) {
  for (const auto& [quality, share] : shares_of(part)) {
    const bool poor = quality == FixQuality::single || quality == FixQuality::floating ||
                      quality == FixQuality::dead_reckoned;
    if (poor && share >= kShareToTell && share > kTimesUsual * usual.shares.at(quality))
      reasons.push_back(fmt::format("{:.0f} % of the fixes {}", 100 * share, to_string(quality)));
  }
  const double hdop = median_over(part, hdop_of);
  if (hdop > kTimesUsual * usual.hdop)
    reasons.push_back(fmt::format("HDOP {:.1f}, usually {:.1f}", hdop, usual.hdop));
  const double satellites = median_over(part, satellites_of);
  if (kTimesUsual * satellites < usual.satellites)
    reasons.push_back(fmt::format("{:.0f} satellites, usually {:.0f}", satellites, usual.satellites));
  const double raw = median_over(part, raw_error_of);
  if (raw > kTimesUsual * usual.raw_m)
    reasons.push_back(fmt::format("raw fixes off by {:.2f} m, usually {:.2f} m", raw, usual.raw_m));
}

std::vector<std::string> reasons_of(std::span<const EpochResult> epochs, std::size_t begin, std::size_t end,
                                    const Usual& usual) {
  std::vector<std::string> reasons;
  if (!epochs[begin].status) return reasons;  // no receiver
  const double gap = longest_without_fix(epochs, begin, end);
  if (gap > kUsualIntervals * usual.interval_s)
    reasons.push_back(fmt::format("no fix used for {:.0f} s", gap));
  const auto part = epochs.subspan(begin, end - begin + 1);
  tell_status(part, reasons);
  tell_receiver(part, usual, reasons);
  if (begin == 0) reasons.push_back("begin of the drive");
  if (end + 1 == epochs.size()) reasons.push_back("end of the drive");
  return reasons;
}

std::vector<ValueAt> values_of(std::span<const EpochResult> epochs, bool against_truth) {
  std::vector<ValueAt> values;
  for (std::size_t i = 0; i < epochs.size(); ++i) {
    const std::optional<double> value = !against_truth ? epochs[i].sigma_m()
                                        : epochs[i].fused_offset_m
                                            ? std::optional(epochs[i].fused_offset_m->norm())
                                            : std::nullopt;
    if (value && std::isfinite(*value)) values.push_back({i, *value});
  }
  return values;
}

}  // namespace

std::vector<WeakStretch> weak_stretches(std::span<const EpochResult> epochs, bool against_truth,
                                        std::size_t most) {
  const std::vector<ValueAt> values = values_of(epochs, against_truth);
  std::vector<double> plain;
  for (const ValueAt& at : values) plain.push_back(at.value);
  const double least = kLeastPeak * median_of(plain);
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return values[a].value > values[b].value; });
  const Usual usual = usual_of(epochs);
  std::vector<bool> taken(values.size());
  std::vector<WeakStretch> stretches;
  for (const std::size_t peak : order) {
    if (stretches.size() == most || !(values[peak].value >= least)) break;
    if (taken[peak]) continue;
    const double floor = std::max(kPart * values[peak].value, least);
    const auto goes_on = [&](std::size_t from, std::size_t to) {
      return !taken[to] && values[to].value > floor &&
             std::abs(seconds_between(epochs[values[from].epoch].stamp, epochs[values[to].epoch].stamp)) <=
                 kLongestStep_s;
    };
    std::size_t begin = peak;
    std::size_t end = peak;
    while (begin > 0 && goes_on(begin, begin - 1)) --begin;
    while (end + 1 < values.size() && goes_on(end, end + 1)) ++end;
    // What lies beside a worse stretch is its slope.
    const bool slope = (begin > 0 && taken[begin - 1]) || (end + 1 < values.size() && taken[end + 1]);
    double sum = 0;
    for (std::size_t k = begin; k <= end; ++k) {
      taken[k] = true;
      sum += values[k].value;
    }
    if (slope && (peak == begin || peak == end)) continue;
    const std::size_t count = end - begin + 1;
    stretches.push_back({epochs[values[begin].epoch].stamp, epochs[values[end].epoch].stamp,
                         epochs[values[peak].epoch].stamp, values[peak].value,
                         sum / static_cast<double>(count), count,
                         reasons_of(epochs, values[begin].epoch, values[end].epoch, usual)});
  }
  return stretches;
}

}  // namespace waymark::evaluation
