/// Calibration of an odometry whose scales are wrong beyond what a sound one has.
#pragma once

#include <string>
#include <vector>

#include <waymark/core/registry/registry.hpp>
#include <waymark/tools/drive/description/fusion_settings.hpp>
#include <waymark/tools/drive/model/place.hpp>

namespace waymark::drive {

/// Widens the priors of the scales of speed and yaw rate of the odometry that gives the nodes to what the fixes show
/// (PlacedDrive::speed_factor, turn_factor), unless they are stated or the scale is not calibrated.
/// @param by_default nobody stated which states are calibrated: the scale of the yaw rate is, too, if it must be
/// @returns notes about what was changed
[[nodiscard]] std::vector<std::string> adapt_to_scales(const PlacedDrive& placed, bool by_default,
                                                       const TypeRegistry& registry,
                                                       FusionSettings& decision);

}  // namespace waymark::drive
