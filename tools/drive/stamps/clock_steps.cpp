#include <waymark/tools/drive/stamps/clock_steps.hpp>

#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include <waymark/tools/drive/clocks/clock_sync.hpp>

namespace waymark::drive {
namespace {

/// What fixes may be late, beside a step.
constexpr double kOwnOffset_s = 5;

std::vector<OdometrySample> samples_within(const std::vector<OdometrySample>& odometry, Stamp from,
                                           Stamp to) {
  std::vector<OdometrySample> samples;
  for (const OdometrySample& sample : odometry)
    if (from <= sample.stamp && sample.stamp <= to) samples.push_back(sample);
  return samples;
}

std::optional<ClockOffset> offset_of(const std::vector<OdometrySample>& samples,
                                     const std::vector<Fix>& fixes, double largest_s) {
  if (samples.size() < 2) return std::nullopt;
  return estimate_clock_offsets(samples, fixes, {.largest_s = largest_s}).common();
}

/// Tells whether the later readings are so much later than the earlier ones, and not as late.
bool is_of_clock(const StampStep& step, const ClockOffset& earlier, const ClockOffset& later) {
  constexpr double kSame_s = 0.15;
  const double apart_s = later.late_s - earlier.late_s;
  const double uncertain_s = kSame_s + kOffsetSigmas * std::hypot(earlier.sigma_s, later.sigma_s);
  return std::abs(apart_s - step.by_s) < std::min(uncertain_s, 0.5 * std::abs(step.by_s));
}

}  // namespace

std::vector<StampStep> find_clock_steps(std::span<const StampStep> steps,
                                        const std::vector<OdometrySample>& odometry,
                                        const std::vector<Fix>& fixes) {
  constexpr double kBeside_s = 600;
  std::vector<StampStep> found;
  if (odometry.empty() || fixes.empty()) return found;
  Stamp begin = odometry.front().stamp;
  for (std::size_t k = 0; k < steps.size(); ++k) {
    const StampStep& step = steps[k];
    const Stamp behind = std::max(step.before, step.before.later(step.by_s));
    const Stamp end = k + 1 < steps.size() ? steps[k + 1].before : odometry.back().stamp;
    const double largest_s = std::abs(step.by_s) + kOwnOffset_s;
    const auto earlier =
        offset_of(samples_within(odometry, std::max(begin, step.before.later(-kBeside_s)), step.before),
                  fixes, largest_s);
    begin = behind;
    if (!earlier) continue;
    const auto later =
        offset_of(samples_within(odometry, behind, std::min(end, behind.later(kBeside_s))), fixes, largest_s);
    if (later && is_of_clock(step, *earlier, *later)) found.push_back(step);
  }
  return found;
}

void take_back(std::span<const StampStep> steps, std::span<Stamp> stamps) {
  for (const StampStep& step : steps)
    for (std::size_t row = step.row; row < stamps.size(); ++row) stamps[row] = stamps[row].later(-step.by_s);
}

std::string warning_of(const StampStep& step, const std::string& file, Stamp first) {
  return fmt::format(
      "{}: the clock of the odometry steps {} by {:.3f} s at reading {}, {:.1f} s after its start: the motion before and "
      "behind it fits the fixes at offsets that differ by that. The readings behind it are moved back onto the clock of "
      "those before; correct their stamps",
      file, step.by_s > 0 ? "forward" : "back", std::abs(step.by_s), step.row + 1,
      seconds_between(first, step.before));
}

}  // namespace waymark::drive
