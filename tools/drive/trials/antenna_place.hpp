/// Where the antenna of the only receiver is, beside the point of the vehicle that the odometry moves without slip (the
/// middle of the rear axle). Few drives state it; in bends and turns an antenna elsewhere swings out, and where its
/// place is not known that looks like fixes that are late or early.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>

#include <Eigen/Core>

#include <waymark/core/registry/registry.hpp>
#include <waymark/tools/drive/description/fusion_settings.hpp>
#include <waymark/tools/drive/model/place.hpp>

namespace waymark::drive {

struct AntennaPlace {
  Eigen::Vector2d place_m = Eigen::Vector2d::Zero();  ///< ahead and to the left
  /// where it is taken to be: at the origin, unless it is stated
  Eigen::Vector2d taken_m = Eigen::Vector2d::Zero();
  Eigen::Vector2d sigma_m = Eigen::Vector2d::Zero();
};

/// Finds the place that makes the fixes most probable, together with a delay of them, on a sample of the drive.
/// @param placed with the time offsets of its fixes @param settings with the noise
/// @param between called between its fusions; what it throws ends the search. Empty: nothing is called
/// @return empty if there are several receivers, or if the way from where the antenna is taken to be is not significant:
/// half chi2 falls by less than 15, or it is known to a quarter of its length only, or it is no decimetre, or beyond 9 m
[[nodiscard]] std::optional<AntennaPlace> find_antenna_place(const PlacedDrive& placed,
                                                             std::span<const PreparedSensor> sensors,
                                                             const FusionSettings& settings,
                                                             const TypeRegistry& registry,
                                                             const std::function<void()>& between = {});

/// Returns the warning about an antenna that is not where it is taken to be. @param receiver its name
[[nodiscard]] std::string warning_of(const AntennaPlace& antenna, const std::string& receiver);

}  // namespace waymark::drive
