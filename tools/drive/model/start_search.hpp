/// The initial guess of a drive without receivers.
#pragma once

#include <span>

#include <waymark/tools/drive/model/place.hpp>

namespace waymark::drive {

/// Fills the initial guess. It is dead reckoning from the stated first pose. If the heading or the place
/// of that is not stated, several are tried on a coarse drive with all sensors: headings 30 degrees apart,
/// at the stated place or in the middle of the known places (vertices of the sensors that are fixed or have a
/// prior, such as landmarks of a map). The one with the lowest minimum is taken, and bent to that minimum.
/// @param placed with timeline and first pose
/// @param settings from decided()
/// @throws InputError if nothing says where the vehicle is; errors of the plugins
void search_start(std::span<const PreparedSensor> sensors, const FusionSettings& settings,
                  const TypeRegistry& registry, PlacedDrive& placed);

}  // namespace waymark::drive
