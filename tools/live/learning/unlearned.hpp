/// What is assumed of an odometry whose drive has not told anything yet.
///
/// A batch run has a drive of minutes, which tells the errors of its odometry; their priors hardly count. In the
/// first minute of a live drive they are all that is known, and the heading with them. So they are those of the
/// sensors that exist, from good to poor ones:
///
///   gyro: a bias of 3 deg/s that walks as its stops show (0.07 deg/s in an hour, without stops)
///   wheels or steering: radii that differ by 0.75 % on a track of 1.5 m, or a steering that stands 0.8 degrees off
///   (5e-3 rad/m); a track width or steering ratio of 5 %
///
/// The noise is taken as large as its prior expects it to be, exp(deviation^2 / 2) times its median: the covariance of
/// a pose is that of the expected variance, not of the most usual one.
#pragma once

#include <waymark/core/registry/registry.hpp>
#include <waymark/tools/drive/description/drive_description.hpp>
#include <waymark/tools/drive/description/fusion_settings.hpp>
#include <waymark/tools/live/learning/drive_so_far.hpp>

namespace waymark::live {

/// Returns the settings with the priors of the calibration of each odometry. A yaw rate from wheels or steering has a
/// scale by default. What is stated stays. @param stated settings of the drive
[[nodiscard]] drive::FusionSettings with_open_calibration(drive::FusionSettings stated,
                                                          const drive::DriveDescription& description,
                                                          const DriveSoFar& so_far,
                                                          const TypeRegistry& registry);

/// Tells whether the settings leave open how far the bias of the first odometry's gyro walks.
[[nodiscard]] bool walk_is_open(const drive::FusionSettings& stated,
                                const drive::DriveDescription& description);

/// Returns the settings with the noise of each odometry that is neither stated nor learned.
/// @param settings from drive::decided()
[[nodiscard]] drive::FusionSettings with_usual_noise(drive::FusionSettings settings,
                                                     const drive::DriveDescription& description,
                                                     const TypeRegistry& registry);

/// Returns the settings with a heading that errs by the white noise of each gyro's readings at least.
/// @param settings with noise @param stated settings of the drive: what they state stays
[[nodiscard]] drive::FusionSettings with_noise_of_readings(drive::FusionSettings settings,
                                                           const drive::FusionSettings& stated,
                                                           const drive::DriveDescription& description,
                                                           const DriveSoFar& so_far,
                                                           const TypeRegistry& registry);

}  // namespace waymark::live
