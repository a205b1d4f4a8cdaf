/// Calibration of an odometry whose scales are wrong beyond what a sound one has.
#pragma once

#include <string>
#include <vector>

#include <waymark/core/registry/registry.hpp>
#include <waymark/tools/drive/description/fusion_settings.hpp>
#include <waymark/tools/drive/model/place.hpp>

namespace waymark::drive {

/// Widens the priors of the scales of speed and yaw rate, and of its bias per speed, of the odometry that
/// gives the nodes to what the fixes show (PlacedDrive::speed_factor, turn_factor, yaw_bias), unless they are
/// stated or the state is not calibrated.
/// @param by_default nobody stated which states are calibrated: those of the yaw rate are, too, if they must be
/// @returns notes about what was changed
[[nodiscard]] std::vector<std::string> adapt_to_scales(const PlacedDrive& placed, bool by_default,
                                                       const TypeRegistry& registry,
                                                       FusionSettings& decision);

}  // namespace waymark::drive
