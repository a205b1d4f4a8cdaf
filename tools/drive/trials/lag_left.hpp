/// What is left of the lag of a speed or yaw rate that was late alone, after its readings were moved. Correlation knows a
/// lag to some hundredths of a second, which are decimetres at 10 m/s; precise fixes know it to thousandths.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>

#include <waymark/core/registry/registry.hpp>
#include <waymark/tools/drive/description/fusion_settings.hpp>
#include <waymark/tools/drive/logs/prepare.hpp>
#include <waymark/tools/drive/model/place.hpp>

namespace waymark::drive {

struct LagLeft {
  double late_s = 0;  ///< of the readings as they were moved; negative: they were moved too far
  double sigma_s = 0;

  [[nodiscard]] bool is_probable() const;
};

/// Finds the lag that makes the fixes most probable, with all states that the settings estimate, on a coarse drive.
/// Empty if there is none within 0.15 s.
/// @param placed with the time offsets of its fixes @param settings with the noise
/// @param between called between its fusions; what it throws ends the search. Empty: nothing is called
[[nodiscard]] std::optional<LagLeft> find_lag_left(OdometryQuantity kind, const PlacedDrive& placed,
                                                   std::span<const PreparedSensor> sensors,
                                                   const FusionSettings& settings,
                                                   const TypeRegistry& registry,
                                                   const std::function<void()>& between = {});

/// Returns a drive of one odometry whose quantity is moved by what was left, but for the readings at one end. Its report
/// has by how much they are moved in all.
[[nodiscard]] PreparedDrive without_lag_left(PreparedDrive drive, const LagLeft& left);

/// Returns the warning that states where the readings are.
[[nodiscard]] std::string warning_of(const MovedQuantity& moved);

}  // namespace waymark::drive
