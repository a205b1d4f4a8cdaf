#include <waymark/tools/live/inputs/channel.hpp>

#include <algorithm>
#include <span>
#include <utility>

#include <waymark/tools/drive/sensors/sensor_logs.hpp>

namespace waymark::live {
namespace {

/// Tells whether readings are places or headings, which are converted into the frame.
bool needs_frame(const LogRequest& request) {
  return std::any_of(request.readings.begin(), request.readings.end(),
                     [](const SensorColumn& column) { return !column.sense.empty(); });
}

drive::ChosenReader reader_for_live(const drive::LogConfig& log, const TypeRegistry& registry) {
  drive::ChosenReader chosen = drive::choose_reader(log, registry);
  chosen.request.is_live = true;
  return chosen;
}

/// A drive may be without a fix for hours.
void append(const SensorTable& more, SensorTable& rows) {
  constexpr std::size_t kMost = 100'000;
  if (rows.size() > kMost) rows = {};
  rows.columns = more.columns;
  rows.stamps.insert(rows.stamps.end(), more.stamps.begin(), more.stamps.end());
  rows.values.insert(rows.values.end(), more.values.begin(), more.values.end());
}

}  // namespace

Channel::Channel(Role role, const drive::LogConfig& log, std::size_t index, TimeScale scale,
                 OdometryStream& parts, std::size_t odometry, const TypeRegistry& registry)
    : role_(role),
      log_(log),
      index_(index),
      scale_(scale),
      parts_(parts),
      odometry_(odometry),
      chosen_(reader_for_live(log, registry)),
      decoder_(chosen_.type.reader->open(log.file, chosen_.request)) {}

std::vector<Sample> Channel::take(std::string_view piece, const drive::Projection* projection) {
  decoder_->take(piece);
  return collect(projection);
}

std::vector<Sample> Channel::finish(const drive::Projection* projection) {
  decoder_->finish();
  return collect(projection);
}

std::vector<Sample> Channel::pause(const drive::Projection* projection) {
  decoder_->pause();
  return collect(projection);
}

Sample Channel::labelled(const OdometrySample& sample) const {
  if (odometry_ == 0) return sample;
  return FurtherOdometry{sample.stamp, odometry_, sample.speed_mps, sample.yaw_rate_radps,
                         sample.turn_variance_per_s};
}

std::vector<Sample> Channel::collect(const drive::Projection* projection) {
  LogData& data = decoder_->data();
  const TimeScale own = chosen_.request.time_scale;
  std::vector<Sample> samples;
  for (OdometrySample& sample : std::exchange(data.odometry, {})) {
    sample.stamp = convert(sample.stamp, own, scale_);
    samples.push_back(labelled(sample));
  }
  for (GeodeticFix& fix : std::exchange(data.fixes, {})) {
    fix.stamp = convert(fix.stamp, own, scale_);
    samples.emplace_back(fix);
  }
  data.clocks.clear();
  if (data.readings.size() == 0 && waiting_.size() == 0) return samples;
  SensorTable rows;
  rows.columns = data.readings.columns;
  std::swap(rows, data.readings);
  if (role_ == Role::sensor && needs_frame(chosen_.request)) {
    append(rows, waiting_);
    if (projection == nullptr) return samples;
    rows = std::exchange(waiting_, {});
  }
  if (role_ == Role::odometry) {
    for (Stamp& stamp : rows.stamps) stamp = convert(stamp, own, scale_);
    for (const OdometrySample& sample : parts_.take(index_, rows)) samples.push_back(labelled(sample));
  } else if (role_ == Role::sensor) {
    drive::DriveLogs::Log log;
    log.scale = own;
    log.file = log_.file;
    log.data.readings = std::move(rows);
    drive::PrepareReport report;
    const SensorTable ready = drive::prepare_readings(log, chosen_.request, scale_, {}, projection, report);
    for (std::size_t row = 0; row < ready.size(); ++row) {
      SensorReading reading{ready.stamps[row], index_, {}};
      for (std::size_t column = 0; column < ready.columns; ++column)
        reading.values.push_back(ready.at(row, column));
      samples.emplace_back(std::move(reading));
    }
  }
  return samples;
}

}  // namespace waymark::live
