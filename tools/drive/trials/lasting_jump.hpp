/// Fixes that are elsewhere from a moment on, for good: corrections that a receiver has lost, a reference station that
/// was moved. Each side fits the odometry, and nothing tells which one is right.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <waymark/core/registry/registry.hpp>
#include <waymark/tools/drive/description/fusion_settings.hpp>
#include <waymark/tools/drive/model/place.hpp>

namespace waymark::drive {

struct LastingJump {
  int source = 0;                                ///< Fix::source
  Stamp at;                                      ///< of the first fix that is elsewhere
  Eigen::Vector2d by = Eigen::Vector2d::Zero();  ///< m, in the frame
};

/// Finds the jump with which the fixes are most probable, with all states that the settings estimate, on a coarse drive.
/// Fixes of two minutes or more lie on both sides of it, up to the next known one. It is a proposal, and the evidence
/// decides: what the poses leave of the fixes changes there by four times as much as usual, and half chi2 falls by 15
/// (more where no state explains the fixes) if both sides have slow errors of their own, and by 15 less if
/// but two minutes before or after it have.
/// @param placed with the time offsets of its fixes, and the known jumps taken (take_jumps)
/// @param settings with the noise
/// @param between called between its fusions; what it throws ends the search. Empty: nothing is called
[[nodiscard]] std::optional<LastingJump> find_lasting_jump(
    const PlacedDrive& placed, std::span<const LastingJump> known, std::span<const PreparedSensor> sensors,
    const FusionSettings& settings, const TypeRegistry& registry, const std::function<void()>& between = {});

/// Tells the fixes of the jumps: Fix::level and Fix::jump_sigma_m. Slow errors of half a jump, per axis, leave
/// the middle between both sides as uncertain as it is if one of them is right.
void take_jumps(std::span<const LastingJump> jumps, std::span<Fix> fixes);

/// Returns the warning about a jump. @param receiver its name @param first fix of the drive
[[nodiscard]] std::string warning_of(const LastingJump& jump, const std::string& receiver, Stamp first);

}  // namespace waymark::drive
