/// A clock of the odometry that was set during the drive, by NTP or a change to summer time: all later readings are stamped
/// that much later or earlier.
#pragma once

#include <span>
#include <string>
#include <vector>

#include <waymark/core/drive/sample.hpp>
#include <waymark/tools/drive/stamps/stamp_steps.hpp>

namespace waymark::drive {

/// Returns the places at which the clock was set, of those at which the stamps do not go on. What lies before and behind
/// such a place fits the fixes at offsets that differ as the stamps do; beside a gap both fit at the same one.
/// @param steps in the order of the log @param odometry sorted, all that was logged @param fixes of all receivers, all
/// that were logged
[[nodiscard]] std::vector<StampStep> find_clock_steps(std::span<const StampStep> steps,
                                                      const std::vector<OdometrySample>& odometry,
                                                      const std::vector<Fix>& fixes);

/// Moves the stamps behind each step to where they would be without it. @param stamps in the order of the log
void take_back(std::span<const StampStep> steps, std::span<Stamp> stamps);

/// Returns the warning about a clock that was set. @param file the log @param first stamp of the odometry
[[nodiscard]] std::string warning_of(const StampStep& step, const std::string& file, Stamp first);

}  // namespace waymark::drive
