/// How much slower the clock of the odometry runs than that of the fixes. A logger's quartz is off by 20 to 100 ppm: a
/// tenth of a second in half an hour, and metres at 30 m/s.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>

#include <waymark/core/registry/registry.hpp>
#include <waymark/tools/drive/description/fusion_settings.hpp>
#include <waymark/tools/drive/model/place.hpp>

namespace waymark::drive {

struct ClockDrift {
  double rate = 0;  ///< seconds by which the odometry's stamps fall behind in a second; negative: they hurry
  double sigma = 0;
  bool is_probable = false;  ///< so that the odometry should be tried without it
};

/// Finds the drift that makes the fixes most probable, with all states that the settings estimate, on a coarse drive.
/// A drift moves the fixes along the way, the more the later they are: the least cost over the states is a parabola of
/// it.
///
/// It is a proposal, and the evidence decides: probable at 3 sigmas (1.5 if it moves a fix by three of its accuracies,
/// because noise was then found in its place), if it is what quartzes do (5 to 300 ppm). Empty where it would move no
/// fix by a tenth of its accuracy, so that it does not matter.
/// @param placed with the time offsets of its fixes @param settings with the noise
/// @param between called between its fusions; what it throws ends the search. Empty: nothing is called
[[nodiscard]] std::optional<ClockDrift> find_clock_drift(const PlacedDrive& placed,
                                                         std::span<const PreparedSensor> sensors,
                                                         const FusionSettings& settings,
                                                         const TypeRegistry& registry,
                                                         const std::function<void()>& between = {});

/// Returns the drive with the odometry's readings at the times of the other clock. Both agree at the first fix: a
/// constant difference cannot be told from fixes that are late.
[[nodiscard]] PreparedDrive without_drift(PreparedDrive drive, const ClockDrift& drift);

/// Returns the drive with other stamps of the odometry. The last reading holds until the former end.
/// @param by_s how much later each stamp becomes, in their order
[[nodiscard]] PreparedDrive with_stamps_later(PreparedDrive drive, const std::function<double(Stamp)>& by_s);

/// Returns the warning about a clock that drifts. @param duration_s from the first fix to the last one
[[nodiscard]] std::string warning_of(const ClockDrift& drift, double duration_s);

}  // namespace waymark::drive
