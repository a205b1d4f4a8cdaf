/// Whether each odometry fits the fixes: its clock, its turns and its distances. No model of noise fits one whose
/// unit, sign or clock is wrong; beside a sound one it draws the poses away.
#pragma once

#include <functional>
#include <string>

#include <waymark/tools/drive/clocks/clock_sync.hpp>
#include <waymark/tools/drive/logs/prepare.hpp>

namespace waymark::drive {

/// Warns of a clock that is late by 0.2 s or early by 0.3 s and more against every receiver. Of several odometries
/// each one is compared: its clock, the sign and the unit of its turns and distances. One in which these are wrong
/// is left out with a warning, if another one that spans as many fixes fits them.
/// @param remedy what to do if the only odometry has another clock
void check_odometries(PreparedDrive& drive, const std::function<std::string(const ClockOffset&)>& remedy);

}  // namespace waymark::drive
