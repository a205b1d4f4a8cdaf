/// Adds speed and course of a receiver from a separate log.
#pragma once

#include <cstddef>
#include <span>

#include <waymark/core/drive/sample.hpp>

namespace waymark::drive {

/// Gives fixes the speed and course in `readings` (columns as in velocity_channels(), stamps on
/// the scale of the fixes). Values are interpolated between the two readings around a fix if these
/// are at most 2.5 usual intervals apart; otherwise there is none. They replace the values that
/// the fix has.
/// @return how many fixes received a value
std::size_t add_velocity(const SensorTable& readings, std::span<GeodeticFix> fixes);

}  // namespace waymark::drive
