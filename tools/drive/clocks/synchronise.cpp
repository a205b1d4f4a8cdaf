#include <waymark/tools/drive/clocks/synchronise.hpp>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <waymark/tools/drive/clocks/clock_check.hpp>
#include <waymark/tools/drive/clocks/clock_sync.hpp>
#include <waymark/tools/drive/clocks/offset_names.hpp>
#include <waymark/tools/drive/logs/clock_offsets.hpp>

namespace waymark::drive {
namespace {

/// Adds an offset to a delay if it is significant. A note is made in either case.
bool apply_offset(const std::optional<ClockOffset>& offset, const std::string& quantity, double& delay_s,
                  std::vector<std::string>& notes) {
  if (!offset) {
    notes.push_back(fmt::format("sync: no offset of {} was found; its stamps stay as they are", quantity));
    return false;
  }
  const bool is_one = offset->is_significant();
  if (is_one) delay_s += offset->late_s;
  notes.push_back(
      fmt::format("sync: {} {} late by {:.3f} s{} (sigma {:.3f} s, correlation {:.4f}); {}", quantity,
                  is_one ? "was" : "seems", offset->late_s, offset_in_words(*offset), offset->sigma_s,
                  offset->correlation,
                  is_one ? "applied" : "within what smoothing and three sigmas explain, so not applied"));
  return is_one;
}

/// Whether one half of the odometry must not be moved alone: the halves share a log, or the offset is one of
/// clocks.
bool share_a_clock(const OdometryConfig& odometry, const ClockOffset& offset) {
  constexpr double kFilter_s = 1.5;  // no filter is slower
  return odometry.logs.size() == 1 || std::abs(offset.late_s) > kFilter_s;
}

}  // namespace

OdometryConfig& config_of(const std::string& name, DriveDescription& description) {
  const auto found = std::find_if(description.odometry.begin(), description.odometry.end(),
                                  [&](const OdometryConfig& odometry) { return odometry.name == name; });
  return found == description.odometry.end() ? description.odometry.emplace_back() : *found;
}

void apply_offsets(const std::string& whose, const SyncReport& report, OdometryConfig& odometry,
                   std::vector<std::string>& notes) {
  const bool speed_moved = apply_offset(report.speed, whose + " speed", odometry.speed_delay_s, notes);
  const bool yaw_rate_moved =
      apply_offset(report.yaw_rate, whose + " yaw rate", odometry.yaw_rate_delay_s, notes);
  const std::string both =
      fmt::format("sync: {} yaw rate and speed are of one clock; both are moved together", whose);
  const auto takes_along = [&](const std::optional<ClockOffset>& moved,
                               const std::optional<ClockOffset>& other) {
    return share_a_clock(odometry, *moved) && (!other || other->may_be(*moved));
  };
  if (speed_moved && !yaw_rate_moved && takes_along(report.speed, report.yaw_rate)) {
    odometry.yaw_rate_delay_s += report.speed->late_s;
    notes.push_back(both);
  } else if (yaw_rate_moved && !speed_moved && takes_along(report.yaw_rate, report.speed)) {
    odometry.speed_delay_s += report.yaw_rate->late_s;
    notes.push_back(both);
  }
}

void synchronise(DriveLogs& logs, DriveDescription& description) {
  std::vector<std::string> notes = put_on_told_time(logs);
  const LoggedMotion motion = logged_motion(logs, description);
  for (const PreparedOdometry& source : motion.odometries) {
    const std::string whose = motion.odometries.size() > 1 ? source.name + "'s" : "the odometry's";
    apply_offsets(whose, estimate_clock_offsets(source.samples, motion.fixes, {}),
                  config_of(source.name, description), notes);
  }
  logs.notes.insert(logs.notes.end(), notes.begin(), notes.end());
}

}  // namespace waymark::drive
