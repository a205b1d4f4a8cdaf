#include <waymark/tools/live/inputs/odometry_stream.hpp>

#include <algorithm>
#include <utility>

#include <waymark/core/base/detail/median.hpp>
#include <waymark/core/base/error.hpp>

namespace waymark::live {
namespace {

constexpr double kKept = 4;              // s before the last sample: any gap that is bridged fits into it
constexpr std::size_t kForTheRate = 20;  // samples that tell the rate

}  // namespace

void OdometryStream::forget_before(Stamp moment) {
  for (drive::OdometryPart& part : parts_) {
    SensorTable& table = part.readings;
    const auto gone =
        std::lower_bound(table.stamps.begin(), table.stamps.end(), moment) - table.stamps.begin();
    table.stamps.erase(table.stamps.begin(), table.stamps.begin() + gone);
    table.values.erase(table.values.begin(),
                       table.values.begin() + gone * static_cast<std::ptrdiff_t>(table.columns));
  }
}

std::vector<OdometrySample> OdometryStream::take(std::size_t part, const SensorTable& rows) {
  SensorTable& table = parts_[part].readings;
  table.columns = rows.columns;
  for (std::size_t row = 0; row < rows.size(); ++row) {
    const auto place =
        std::upper_bound(table.stamps.begin(), table.stamps.end(), rows.stamps[row]) - table.stamps.begin();
    table.stamps.insert(table.stamps.begin() + place, rows.stamps[row]);
    const auto* values = rows.values.data() + row * rows.columns;
    table.values.insert(table.values.begin() + place * static_cast<std::ptrdiff_t>(rows.columns), values,
                        values + rows.columns);
  }
  if (std::any_of(parts_.begin(), parts_.end(),
                  [](const drive::OdometryPart& one) { return one.readings.size() < 3; }))
    return {};
  std::vector<OdometrySample> samples;
  try {
    drive::AssembledOdometry assembled = drive::assemble_odometry(parts_, how_, gap_s_);
    samples = std::move(assembled.samples);
    yaw_rate_from_ = assembled.yaw_rate_from;
    how_.heading_is_course = how_.heading_is_course || assembled.heading_is_course;
    obstacle_.clear();
  } catch (const InputError& error) {
    obstacle_ = error.what();
    return {};
  }
  if (how_.rate_hz == 0) {
    if (samples.size() < kForTheRate) return {};
    std::vector<double> intervals;
    for (std::size_t i = 1; i < samples.size(); ++i)
      intervals.push_back(seconds_between(samples[i - 1].stamp, samples[i].stamp));
    how_.rate_hz = 1 / upper_median(intervals);
  }
  // The last one may still change with the next reading.
  if (!samples.empty()) samples.pop_back();
  std::erase_if(samples, [&](const OdometrySample& sample) { return last_ && sample.stamp <= *last_; });
  if (!samples.empty()) {
    last_ = samples.back().stamp;
    forget_before(last_->later(-kKept));
  }
  return samples;
}

}  // namespace waymark::live
