/// Speed and course of a receiver that stand in a log of their own.
#pragma once

#include <cstddef>
#include <span>

#include <waymark/core/drive/sample.hpp>

namespace waymark::drive {

/// Gives fixes the speed and course that stand in `readings` (columns as velocity_channels(), stamps on the
/// fixes' scale): those between the two readings around a fix where they are at most 2.5 usual intervals
/// apart, else none. What a fix has of itself is replaced where the readings have it.
/// @return how many fixes got something
std::size_t add_velocity(const SensorTable& readings, std::span<GeodeticFix> fixes);

}  // namespace waymark::drive
