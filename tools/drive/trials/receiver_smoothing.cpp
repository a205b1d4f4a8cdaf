#include <waymark/tools/drive/trials/receiver_smoothing.hpp>

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include <waymark/tools/drive/trials/trial_drive.hpp>

namespace waymark::drive {
namespace {

constexpr double kShortest_s = 0.1;
constexpr double kLongest_s = 10;

double cost_at(double time_s, TrialDrive& trial) {
  return trial.cost_with([&](PlacedDrive& drive) { drive.smoothings_s.front() = time_s; });
}

/// Returns where to look for the time of a filter: where it is taken to be, or the first of some times with which the
/// fixes are far more probable than without a filter. Empty if there is none. What a filter does grows with the square of
/// its time, so where a short one costs more than none, a longer one does.
std::optional<double> first_time(double taken_s, TrialDrive& trial) {
  constexpr std::array kTimes_s = {0.5, 1.0, 2.0, 4.0};
  constexpr double kGain = 15;
  if (taken_s > 0) return taken_s;
  const double without = cost_at(0, trial);
  const double gain = kGain * std::pow(trial.spread(without), 2);
  for (const double time_s : kTimes_s) {
    const double cost = cost_at(time_s, trial);
    if (cost < without - gain) return time_s;
    if (!(cost < without)) return std::nullopt;
  }
  return std::nullopt;
}

}  // namespace

std::optional<ReceiverSmoothing> find_smoothing(const PlacedDrive& placed,
                                                std::span<const PreparedSensor> sensors,
                                                const FusionSettings& settings, const TypeRegistry& registry,
                                                const std::function<void()>& between) {
  constexpr double kFixPeriod_s = 1;
  constexpr double kNodePeriod_s = 0.25;
  constexpr std::size_t kWindows = 12;
  constexpr double kWindow_s = 200;
  constexpr double kApart = 0.2;  // of the time
  constexpr double kReached = 0.1;
  constexpr int kMostSteps = 10;
  if (placed.fixes.empty() || placed.receivers.size() != 1) return std::nullopt;
  TrialDrive trial(sample_of(coarsen(placed, sensors, kFixPeriod_s, kNodePeriod_s), kWindows, kWindow_s),
                   settings, registry, between);
  const std::optional<double> first_s = first_time(placed.smoothings_s.front(), trial);
  if (!first_s) return std::nullopt;
  ReceiverSmoothing found{*first_s};
  for (int count = 0; count < kMostSteps; ++count) {
    const double apart_s = kApart * found.time_s;
    const auto least =
        trial.least_near(found.time_s, apart_s, [&](double time_s) { return cost_at(time_s, trial); });
    // Far from it heavy tails flatten the cost.
    const double towards_s = least ? least->at - found.time_s : apart_s;
    const double step_s = std::clamp(towards_s, -apart_s, apart_s);
    found.time_s += step_s;
    if (!(found.time_s > kShortest_s) || !(found.time_s < kLongest_s)) return std::nullopt;
    if (!least || std::abs(step_s) > kReached * apart_s) continue;
    found.sigma_s = least->sigma;
    return found;
  }
  return std::nullopt;
}

std::string warning_of(const ReceiverSmoothing& smoothing, const std::string& receiver) {
  return fmt::format(
      "the positions of '{}' are smoothed by the receiver, over {:.2f} +- {:.2f} s: they run on where the vehicle brakes "
      "and swing out of bends; that is taken out of them, and is no delay; state 'smoothing: {:.2f}' for it",
      receiver, smoothing.time_s, smoothing.sigma_s, smoothing.time_s);
}

}  // namespace waymark::drive
