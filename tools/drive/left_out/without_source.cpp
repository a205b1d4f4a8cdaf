#include <waymark/tools/drive/left_out/without_source.hpp>

#include <algorithm>

#include <waymark/tools/drive/logs/prepare_steps.hpp>

namespace waymark::drive {
namespace {

void leave_out_odometry(const std::string& name, PreparedDrive& drive) {
  std::erase_if(drive.relative, [&](const PreparedOdometry& source) { return source.name == name; });
  drive.odometry_name = drive.relative.front().name;
  drive.yaw_rate_at_rest = drive.relative.front().yaw_rate_at_rest;
  std::size_t added = 0;
  drive.odometry = covered_by_all(drive.relative, added);
  if (drive.relative.size() == 1) drive.relative.clear();
}

/// Keeps the fixes within the odometry, which may be shorter now.
void keep_fixes_within(PreparedDrive& drive) {
  std::erase_if(drive.fixes, [&](const Fix& fix) {
    return fix.stamp < drive.odometry.front().stamp || fix.stamp > drive.odometry.back().stamp;
  });
}

}  // namespace

std::vector<SourceOfDrive> sources_of(const PreparedDrive& drive) {
  std::vector<SourceOfDrive> sources;
  for (const PreparedOdometry& source : drive.relative) sources.push_back({source.name, "odometry"});
  if (sources.empty()) sources.push_back({drive.odometry_name, "odometry"});
  for (const PreparedReceiver& source : drive.receivers) sources.push_back({source.name, "gnss"});
  for (const PreparedSensor& sensor : drive.sensors) sources.push_back({sensor.source, sensor.name});
  return sources;
}

bool can_do_without(const PreparedDrive& drive, const SourceOfDrive& source) {
  if (source.kind == "odometry") return drive.relative.size() > 1;
  if (source.kind == "gnss") return drive.receivers.size() > 1;
  return true;
}

PreparedDrive without_source(const PreparedDrive& drive, const SourceOfDrive& source) {
  PreparedDrive rest = drive;
  if (source.kind == "odometry") {
    leave_out_odometry(source.name, rest);
    keep_fixes_within(rest);
  } else if (source.kind == "gnss") {
    for (Fix& fix : rest.fixes) {
      if (rest.receivers[static_cast<std::size_t>(fix.source)].name != source.name) continue;
      fix.status = FixStatus::withheld;
      fix.reason = "withheld";
    }
  } else {
    std::erase_if(rest.sensors, [&](const PreparedSensor& sensor) { return sensor.source == source.name; });
  }
  return rest;
}

}  // namespace waymark::drive
