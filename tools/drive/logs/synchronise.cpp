#include <waymark/tools/drive/logs/synchronise.hpp>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <waymark/tools/drive/logs/clock_sync.hpp>

namespace waymark::drive {
namespace {

/// Adds an offset to a delay if it is significant. A note is made in either case.
bool apply_offset(const std::optional<ClockOffset>& offset, const char* quantity, double& delay_s,
                  std::vector<std::string>& notes) {
  if (!offset) {
    notes.push_back(
        fmt::format("sync: no offset of the {} was found; its stamps stay as they are", quantity));
    return false;
  }
  const bool is_one = offset->is_significant();
  if (is_one) delay_s += offset->late_s;
  notes.push_back(
      fmt::format("sync: the odometry's {} {} late by {:.3f} s (sigma {:.3f} s, correlation {:.4f}); {}",
                  quantity, is_one ? "was" : "seems", offset->late_s, offset->sigma_s, offset->correlation,
                  is_one ? "applied" : "within three sigmas, so not applied"));
  return is_one;
}

}  // namespace

OdometryConfig& source_of_nodes(const std::string& name, DriveDescription& description) {
  const auto found = std::find_if(description.odometry.begin(), description.odometry.end(),
                                  [&](const OdometryConfig& odometry) { return odometry.name == name; });
  return found == description.odometry.end() ? description.odometry.emplace_back() : *found;
}

void synchronise(DriveLogs& logs, DriveDescription& description) {
  std::vector<std::string> notes = put_on_told_time(logs);
  const PreparedDrive drive = prepare_drive(logs, description);
  const SyncReport report = estimate_clock_offsets(drive, {});
  OdometryConfig& odometry = source_of_nodes(drive.odometry_name, description);
  const bool speed_moved = apply_offset(report.speed, "speed", odometry.speed_delay_s, notes);
  (void)apply_offset(report.yaw_rate, "yaw rate", odometry.yaw_rate_delay_s, notes);
  // A log has one clock, so one half of it must not be moved alone.
  if (odometry.logs.size() == 1 && speed_moved && !report.yaw_rate) {
    odometry.yaw_rate_delay_s += report.speed->late_s;
    notes.emplace_back("sync: yaw rate and speed are in one log; both are moved together");
  }
  logs.notes.insert(logs.notes.end(), notes.begin(), notes.end());
}

}  // namespace waymark::drive
