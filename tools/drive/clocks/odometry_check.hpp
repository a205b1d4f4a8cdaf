/// Whether each odometry fits the fixes: its clock, its turns and its distances. No model of noise fits one whose
/// unit, sign or clock is wrong; beside a sound one it draws the poses away.
#pragma once

#include <optional>
#include <set>
#include <string>
#include <vector>

#include <waymark/core/drive/sample.hpp>
#include <waymark/tools/drive/clocks/clock_sync.hpp>
#include <waymark/tools/drive/logs/prepare.hpp>

namespace waymark::drive {

/// A vehicle that is slower stands, in comparisons before an odometry model says what it calls so.
inline constexpr double kStands_mps = 0.01;

/// Returns the offset of the clock of an odometry, if it is late by 0.2 s or early by 0.3 s and more against every
/// receiver whose motion tells, by about as much. If it fits one of them, the clock is that of another receiver.
/// Withheld fixes do not count.
[[nodiscard]] std::optional<ClockOffset> offset_shown(const std::vector<OdometrySample>& odometry,
                                                      const std::vector<Fix>& fixes);

/// @param odometry "the odometry" or the name of one of several @param cure what to do
[[nodiscard]] std::string clock_warning(const std::string& odometry, const ClockOffset& offset,
                                        const std::string& cure);

/// What the fixes say against the odometries of a drive.
struct OdometryCheck {
  std::vector<std::string> warnings;
  std::set<std::string> left_out;  ///< names
};

/// Compares each of several odometries: its clock, the sign and the unit of its turns and distances. One in which
/// these are wrong is to be left out, if another one shows by its own motion that it fits and covers nearly as many
/// fixes.
/// @param suspects names of odometries in which they were wrong before: another one that covers half as many is
/// enough
[[nodiscard]] OdometryCheck check_odometries(const PreparedDrive& drive,
                                             const std::set<std::string>& suspects = {});

}  // namespace waymark::drive
