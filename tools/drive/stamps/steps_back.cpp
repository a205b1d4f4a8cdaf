#include <waymark/tools/drive/stamps/steps_back.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>

#include <fmt/format.h>

#include <waymark/core/base/detail/median.hpp>

namespace waymark::drive {
namespace {

constexpr double kFewestIntervals = 5;
constexpr double kGapIntervals = 4;
constexpr std::size_t kFewestRows = 20;
constexpr std::size_t kMostSteps = 10;

bool equal_rows(const SensorTable& rows, std::size_t a, std::size_t b) {
  for (std::size_t c = 0; c < rows.columns; ++c)
    if (rows.at(a, c) != rows.at(b, c)) return false;
  return rows.stamps[a] == rows.stamps[b];
}

/// The rows above a step, in the order of time.
class Past {
 public:
  Past(const SensorTable& rows, std::size_t step, const std::vector<char>& is_left_out) : rows_(rows) {
    for (std::size_t row = 0; row < step; ++row)
      if (is_left_out[row] == 0) order_.push_back(row);
    std::stable_sort(order_.begin(), order_.end(),
                     [&](std::size_t a, std::size_t b) { return rows.stamps[a] < rows.stamps[b]; });
  }

  /// Tells whether a row lies between readings that are no further apart than a gap.
  [[nodiscard]] bool covers(std::size_t row, double gap_s) const {
    const std::size_t next = first_not_before(row);
    if (next == order_.size()) return false;
    const Stamp after = rows_.stamps[order_[next]];
    if (after == rows_.stamps[row]) return true;
    return next > 0 && seconds_between(rows_.stamps[order_[next - 1]], after) <= gap_s;
  }
  /// Tells whether the row is there already.
  [[nodiscard]] bool holds(std::size_t row) const {
    for (std::size_t i = first_not_before(row);
         i < order_.size() && rows_.stamps[order_[i]] == rows_.stamps[row]; ++i)
      if (equal_rows(rows_, order_[i], row)) return true;
    return false;
  }

 private:
  [[nodiscard]] std::size_t first_not_before(std::size_t row) const {
    const auto found =
        std::lower_bound(order_.begin(), order_.end(), rows_.stamps[row],
                         [&](std::size_t other, Stamp stamp) { return rows_.stamps[other] < stamp; });
    return static_cast<std::size_t>(found - order_.begin());
  }

  const SensorTable& rows_;
  std::vector<std::size_t> order_;
};

}  // namespace

double usual_interval_s(std::span<const Stamp> stamps) {
  std::vector<double> intervals;
  for (std::size_t i = 1; i < stamps.size(); ++i)
    if (stamps[i] > stamps[i - 1]) intervals.push_back(seconds_between(stamps[i - 1], stamps[i]));
  return intervals.empty() ? 0 : upper_median(std::move(intervals));
}

std::vector<StepBack> find_steps_back(const SensorTable& rows) {
  const double usual_s = usual_interval_s(rows.stamps);
  std::vector<std::size_t> falls;
  for (std::size_t i = 1; i < rows.size(); ++i)
    if (seconds_between(rows.stamps[i], rows.stamps[i - 1]) > kFewestIntervals * usual_s) falls.push_back(i);
  std::vector<StepBack> steps;
  if (falls.empty() || falls.size() > kMostSteps) return steps;
  std::vector<char> is_left_out(rows.size(), 0);
  for (std::size_t f = 0; f < falls.size(); ++f) {
    const std::size_t end = f + 1 < falls.size() ? falls[f + 1] : rows.size();
    const Past past(rows, falls[f], is_left_out);
    StepBack step{.row = falls[f],
                  .back_s = seconds_between(rows.stamps[falls[f]], rows.stamps[falls[f] - 1])};
    std::size_t repeated = 0;
    for (std::size_t row = falls[f]; row < end; ++row) {
      if (!past.covers(row, kGapIntervals * usual_s)) continue;
      step.in_past.push_back(row);
      repeated += past.holds(row);
    }
    if (step.in_past.size() < kFewestRows || 2 * repeated > step.in_past.size()) continue;
    for (const std::size_t row : step.in_past) is_left_out[row] = 1;
    step.length_s = seconds_between(rows.stamps[step.in_past.front()], rows.stamps[step.in_past.back()]);
    steps.push_back(std::move(step));
  }
  return steps;
}

std::string warning_of(const StepBack& step, const std::string& file, std::size_t rows) {
  return fmt::format(
      "{}: the clock of the odometry steps back by {:.3f} s at reading {} of {}, into a time that has readings: the {} "
      "readings of {:.1f} s that lie there are left out; correct their stamps, or keep one side by 'time: {{from, "
      "to}}'",
      file, step.back_s, step.row + 1, rows, step.in_past.size(), step.length_s);
}

}  // namespace waymark::drive
