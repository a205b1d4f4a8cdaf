#include <waymark/tools/drive/stamps/bursts.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include <fmt/format.h>

#include <waymark/core/base/detail/median.hpp>

namespace waymark::drive {
namespace {

constexpr std::size_t kFewestBursts = 20;
constexpr std::size_t kFewestReadings = 3;
constexpr double kLongestPeriods = 1.5;  // from burst to burst; beyond, those between are missing

/// Rows from `begin` to before `end`.
struct Burst {
  std::size_t begin = 0;
  std::size_t end = 0;

  [[nodiscard]] std::size_t size() const { return end - begin; }
};

/// Splits the rows where the stamps leave out more than half of a mean interval.
std::vector<Burst> split(const std::vector<Stamp>& stamps) {
  const double mean_s =
      seconds_between(stamps.front(), stamps.back()) / static_cast<double>(stamps.size() - 1);
  std::vector<Burst> bursts{{0, 1}};
  for (std::size_t i = 1; i < stamps.size(); ++i) {
    if (std::abs(seconds_between(stamps[i - 1], stamps[i])) > 0.5 * mean_s) bursts.push_back({i, i});
    bursts.back().end = i + 1;
  }
  return bursts;
}

/// Returns the median of what a function tells of each burst.
template <typename Tell>
double median_of(const std::vector<Burst>& bursts, std::size_t first, Tell tell) {
  std::vector<double> all;
  for (std::size_t i = first; i < bursts.size(); ++i) all.push_back(tell(i));
  return upper_median(std::move(all));
}

/// Tells whether nine of ten bursts are as a function tells of each.
template <typename Tell>
bool most(const std::vector<Burst>& bursts, std::size_t first, Tell tell) {
  std::size_t count = 0;
  for (std::size_t i = first; i < bursts.size(); ++i) count += tell(i);
  return 10 * count >= 9 * (bursts.size() - first);
}

/// Tells whether the readings of a column change within bursts as they do between them. What counts, such as
/// ticks of wheels, changes by more where bursts are missing.
bool change_within(const SensorTable& rows, std::size_t column, const std::vector<Burst>& bursts,
                   double period_s) {
  constexpr double kAddUp = 1.5;
  constexpr double kBetween = 2;
  double inside = 0, across = 0, between = 0;
  std::size_t insides = 0, acrosses = 0, betweens = 0;
  const auto add = [&](std::size_t a, std::size_t b, double& sum, std::size_t& count) {
    const double change = std::abs(rows.at(b, column) - rows.at(a, column));
    if (!std::isfinite(change)) return;
    sum += change;
    ++count;
  };
  for (std::size_t i = 0; i < bursts.size(); ++i) {
    for (std::size_t row = bursts[i].begin + 1; row < bursts[i].end; ++row)
      add(row - 1, row, inside, insides);
    add(bursts[i].begin, bursts[i].end - 1, across, acrosses);
    if (i > 0 && seconds_between(rows.stamps[bursts[i - 1].begin], rows.stamps[bursts[i].begin]) <
                     kLongestPeriods * period_s)
      add(bursts[i].begin - 1, bursts[i].begin, between, betweens);
  }
  if (insides == 0 || acrosses == 0 || betweens == 0) return false;
  inside /= static_cast<double>(insides);
  across /= static_cast<double>(acrosses);
  between /= static_cast<double>(betweens);
  return inside > 0 && across >= kAddUp * inside && between <= kBetween * inside;
}

/// Tells whether all stamps are whole multiples of a decimal unit that is the period, but for a stated
/// offset.
bool cut_off(const std::vector<Stamp>& stamps, double period_s) {
  for (std::int64_t unit = 1'000'000'000; unit >= 1'000'000; unit /= 10) {
    if (std::abs(period_s * 1e9 / static_cast<double>(unit) - 1) > 0.1) continue;
    return std::all_of(stamps.begin(), stamps.end(), [&](Stamp stamp) {
      return (stamp.nanoseconds - stamps.front().nanoseconds) % unit == 0;
    });
  }
  return false;
}

/// Spreads the readings of each burst evenly.
std::vector<Stamp> spread(const std::vector<Stamp>& stamps, const std::vector<Burst>& bursts,
                          const Bursts& found) {
  const auto stamp_of = [&](std::size_t i) {
    return found.are_cut_off ? stamps[bursts[i].begin] : stamps[bursts[i].end - 1];
  };
  std::vector<Stamp> result;
  for (std::size_t i = 0; i < bursts.size(); ++i) {
    const std::size_t size = bursts[i].size();
    const std::size_t from = found.are_cut_off ? i : i - 1;
    const bool has_neighbour = found.are_cut_off ? i > 0 && i + 1 < bursts.size() : i > 0;
    const double period_s = has_neighbour ? seconds_between(stamp_of(from), stamp_of(from + 1)) : 0;
    const bool is_whole = period_s > 0 && period_s < kLongestPeriods * found.period_s;
    const double step_s =
        is_whole ? period_s / static_cast<double>(size) : found.period_s / static_cast<double>(found.size);
    // A log begins within a period, and its first readings are the last ones of it.
    const double first_s = i == 0 && found.are_cut_off && size < found.size
                               ? step_s * static_cast<double>(found.size - size)
                               : 0;
    for (std::size_t k = 0; k < size; ++k) {
      const double after_s = found.are_cut_off ? first_s + step_s * static_cast<double>(k)
                                               : -step_s * static_cast<double>(size - 1 - k);
      result.push_back(stamp_of(i).later(after_s));
    }
  }
  return result;
}

}  // namespace

std::optional<Bursts> find_bursts(const SensorTable& rows) {
  constexpr double kRegular = 0.2;
  constexpr double kShort = 0.25;
  const std::vector<Stamp>& stamps = rows.stamps;
  if (stamps.size() < kFewestBursts * kFewestReadings || !std::is_sorted(stamps.begin(), stamps.end()) ||
      stamps.front() == stamps.back())
    return std::nullopt;
  const std::vector<Burst> bursts = split(stamps);
  if (bursts.size() < kFewestBursts || bursts.size() * kFewestReadings > stamps.size()) return std::nullopt;
  const auto size = [&](std::size_t i) { return static_cast<double>(bursts[i].size()); };
  const auto length = [&](std::size_t i) {
    return seconds_between(stamps[bursts[i].begin], stamps[bursts[i].end - 1]);
  };
  const auto period = [&](std::size_t i) {
    return seconds_between(stamps[bursts[i - 1].begin], stamps[bursts[i].begin]);
  };
  Bursts found{.size = static_cast<std::size_t>(median_of(bursts, 0, size)),
               .period_s = median_of(bursts, 1, period),
               .length_s = median_of(bursts, 0, length)};
  const auto usual = static_cast<double>(found.size);
  const bool is_regular =
      most(bursts, 0,
           [&](std::size_t i) { return std::abs(size(i) - usual) <= std::max(1.0, 0.1 * usual); }) &&
      most(bursts, 1,
           [&](std::size_t i) { return std::abs(period(i) - found.period_s) <= kRegular * found.period_s; });
  if (found.size < kFewestReadings || !is_regular ||
      found.length_s > kShort * found.period_s * (usual - 1) / usual)
    return std::nullopt;
  found.are_cut_off = cut_off(stamps, found.period_s);
  for (std::size_t column = 0; column < rows.columns && found.spread.empty(); ++column)
    if (change_within(rows, column, bursts, found.period_s)) found.spread = spread(stamps, bursts, found);
  return found;
}

std::string warning_of(const Bursts& bursts, const std::string& file, const std::string& readings) {
  const std::string what =
      bursts.are_cut_off
          ? fmt::format("{}: the stamps are cut off: {} {} share each of them, {:.3g} s apart", file,
                        bursts.size, readings, bursts.period_s)
          : fmt::format(
                "{}: bursts of {} {} come within {:.3g} s, every {:.3g} s, as if stamped when they arrive",
                file, bursts.size, readings, bursts.length_s, bursts.period_s);
  if (bursts.spread.empty())
    return fmt::format(
        "{}; their changes do not tell that they were measured between, so the stamps are kept, and there is a gap "
        "between bursts; log the stamps of the sensor",
        what);
  return fmt::format(
      "{}; they are spread evenly over the time {}, and a delay that they all have is left in: log the stamps of the "
      "sensor, or add what is told of the delay to 'time: {{offset}}'",
      what, bursts.are_cut_off ? "to the next stamp" : "since the burst before");
}

}  // namespace waymark::drive
