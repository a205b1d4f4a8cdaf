#include <waymark/tools/drive/model/surroundings.hpp>

#include <utility>

namespace waymark::drive {

DriveSurroundings::DriveSurroundings(const PreparedDrive& drive, std::vector<Fix> fixes)
    : fixes_(drive.receivers.size()) {
  for (Fix& fix : fixes) {
    const auto source = static_cast<std::size_t>(fix.source);
    if (source < fixes_.size()) fixes_[source].push_back(std::move(fix));
  }
  // The sources hold spans of what is kept here, so nothing may move once they are made.
  odometry_.reserve(drive.relative.size() + 1);
  readings_.reserve(drive.sensors.size());
  if (drive.relative.empty()) add_odometry(drive.odometry_name, drive.odometry);
  for (const PreparedOdometry& source : drive.relative) add_odometry(source.name, source.samples);
  add_receivers(drive);
  add_sensors(drive);
  if (drive.frame.zone != 0) projection_.emplace(drive.frame);
  context_ = {projection_ ? &*projection_ : nullptr, drive.scale, drive.vehicle, sources_};
}

void DriveSurroundings::add_odometry(const std::string& name, std::span<const OdometrySample> samples) {
  const auto& kept = odometry_.emplace_back(samples.begin(), samples.end());
  DriveSource& source = sources_.emplace_back();
  source.name = name;
  source.kind = "odometry";
  source.odometry = kept;
}

void DriveSurroundings::add_receivers(const PreparedDrive& drive) {
  for (std::size_t i = 0; i < drive.receivers.size(); ++i) {
    DriveSource& source = sources_.emplace_back();
    source.name = drive.receivers[i].name;
    source.kind = "gnss";
    source.antenna_m = drive.receivers[i].antenna_m;
    source.fixes = fixes_[i];
  }
}

void DriveSurroundings::add_sensors(const PreparedDrive& drive) {
  for (const PreparedSensor& sensor : drive.sensors) {
    DriveSource& source = sources_.emplace_back();
    source.name = sensor.source;
    source.kind = sensor.name;
    source.readings = &readings_.emplace_back(sensor.readings);
  }
}

const DriveContext& context_of(const std::shared_ptr<const DriveSurroundings>& surroundings) {
  return surroundings ? surroundings->context() : DriveContext::none();
}

}  // namespace waymark::drive
