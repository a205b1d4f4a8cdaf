/// Which delays of the fixes a drive estimates, and the noise beside them.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include <waymark/core/registry/registry.hpp>
#include <waymark/tools/drive/description/fusion_settings.hpp>
#include <waymark/tools/drive/estimation/latency.hpp>
#include <waymark/tools/drive/model/build.hpp>
#include <waymark/tools/drive/model/fuse.hpp>

namespace waymark::drive {

/// Finds the delay of the fixes, and the noise if it is estimated: each depends on the other.
/// @returns what the drive says about the delay of each group; empty for those that have none
std::vector<std::optional<TimeOffset>> estimate_noise_and_delays(
    const FusionSettings& settings, std::span<const PreparedSensor> sensors, const TypeRegistry& registry,
    const std::function<void()>& between, TimeOffsetSearch& delays, ModeledDrive& modeled);

/// Tells whether the delay of a group may be left out, because nobody stated how it is found.
[[nodiscard]] bool is_delay_open(const AbsoluteGroup& group, const FusionSettings& stated);

/// Leaves out the delays that the drive gives no better odds than their priors, unless they are stated: an offset
/// that is not needed costs RTK fixes at 30 m/s a decimetre.
/// @returns whether there was one
bool leave_out_improbable(const std::vector<std::optional<TimeOffset>>& offsets, const FusionSettings& stated,
                          FusionSettings& decision, ModeledDrive& modeled);

/// Leaves out the delays that nobody stated: an odometry that is worth little moves the fixes along the way as it
/// likes. @returns whether there was one
bool leave_out_unseen(const FusionSettings& stated, FusionSettings& decision, ModeledDrive& modeled);

}  // namespace waymark::drive
