#include <waymark/formats/logs/detail/ubx/ubx_sensors.hpp>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include <waymark/formats/logs/detail/common/gps_time.hpp>

namespace waymark::formats {
namespace {

constexpr std::int64_t kMillisecond = 1'000'000;
// GNSS time only goes so far back if logs were joined.
constexpr std::int64_t kOtherLog = 10 * kSecondNanoseconds;
constexpr std::uint32_t kTickRange = 1U << 23U;
/// How long rows wait for messages out of order, and for the first navigation messages.
constexpr std::int64_t kHeldMs = 2000;
constexpr std::size_t kHeldRows = 4096;
/// A tag further than this from the newest one comes from a clock that restarted.
constexpr std::int64_t kJumpMs = 60'000;

std::int64_t signed_field(std::uint32_t field) {
  const auto value = static_cast<std::int64_t>(field);
  return (field & kTickRange) != 0 ? value - 2 * std::int64_t{kTickRange} : value;
}

}  // namespace

double UbxTicks::count(std::uint32_t field) {
  const std::uint32_t counter = field & (kTickRange - 1);
  if (!last_) {
    count_ = counter;
  } else {
    const std::uint32_t step = (counter - *last_) & (kTickRange - 1);
    if (step >= kTickRange / 2) {
      ++restarts_;
    } else {
      count_ += (field & kTickRange) != 0 ? -std::int64_t{step} : std::int64_t{step};
    }
  }
  last_ = counter;
  return static_cast<double>(count_);
}

void UbxSensorClock::sensor(std::int64_t tag_ms) {
  fresh_tag_ms_ = fresh_tag_ms_ ? std::max(*fresh_tag_ms_, tag_ms) : tag_ms;
}

void UbxSensorClock::navigation(std::int64_t gps_ns) {
  const bool backwards = newest_gps_ && gps_ns < *newest_gps_ - kOtherLog;
  if (newest_gps_ && gps_ns <= *newest_gps_ && !backwards) return;
  newest_gps_ = gps_ns;
  if (!fresh_tag_ms_) return;
  differences_[meetings_ % kMeetings] = gps_ns - *fresh_tag_ms_ * kMillisecond;
  ++meetings_;
  kept_ = std::min(kept_ + 1, kMeetings);
  median_ = median();
  fresh_tag_ms_.reset();
}

void UbxSensorClock::restart() {
  fresh_tag_ms_.reset();
  meetings_ = 0;
  kept_ = 0;
  if (offset_) ++jumps_;
  offset_.reset();
  last_tag_ms_ = 0;
}

std::int64_t UbxSensorClock::median() const {
  std::array<std::int64_t, kMeetings> sorted = differences_;
  const auto end = sorted.begin() + static_cast<std::ptrdiff_t>(kept_);
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(kept_ / 2);
  std::nth_element(sorted.begin(), middle, end);
  return *middle;
}

std::int64_t UbxSensorClock::gps_ns(std::int64_t tag_ms) {
  const std::int64_t wanted = median_;
  if (!offset_) {
    offset_ = first_offset_ = wanted;
  } else if (std::abs(wanted - *offset_) > kSecondNanoseconds) {
    offset_ = wanted;
    ++jumps_;
  } else {
    const std::int64_t passed_ms = std::max<std::int64_t>(0, tag_ms - last_tag_ms_);
    const std::int64_t most = passed_ms * (kMillisecond / 10'000);  // 100 ppm
    *offset_ += std::clamp(wanted - *offset_, -most, most);
  }
  last_tag_ms_ = std::max(last_tag_ms_, tag_ms);
  const std::int64_t gps = tag_ms * kMillisecond + *offset_;
  const bool other_log = last_gps_ && gps < *last_gps_ - kOtherLog;
  last_gps_ = last_gps_ && !other_log ? std::max(*last_gps_, gps) : gps;
  return *last_gps_;
}

UbxSensorDecoder::UbxSensorDecoder(std::string path, LogRequest request)
    : UbxFrameDecoder(std::move(path), std::move(request)), time_(this->request().gps_week) {
  column_of_type_.fill(-1);
  const std::vector<SensorColumn>& wanted = this->request().readings;
  for (std::size_t column = 0; column < wanted.size(); ++column) {
    for (const UbxChannel& channel : kUbxChannels) {
      if (wanted[column].name == channel.name) column_of_type_[channel.type] = static_cast<int>(column);
    }
  }
  data_.readings.columns = wanted.size();
}

void UbxSensorDecoder::take_frame(const UbxFrame& frame) {
  const std::size_t least = least_ubx_length(frame.key);
  if (least == 0 || frame.payload.empty()) return;
  const bool measurements = frame.key == ubx::kEsfMeas;
  if (frame.payload.size() < least) {
    if (!measurements) return;
    ++data_.records;
    return corrupt(byte(), fmt::format("ESF-MEAS: {} bytes, but the message has at least {}",
                                       frame.payload.size(), least));
  }
  const UbxPayload payload(frame.payload);
  if (measurements) {
    take_measurements(payload);
  } else {
    take_time(frame.key, payload);
  }
}

void UbxSensorDecoder::take_time(std::uint16_t key, const UbxPayload& payload) {
  const std::uint32_t itow_ms = ubx_itow(key, payload);
  if (itow_ms >= kItowWeekMs) return;
  std::optional<std::int64_t> gps;
  if (key == ubx::kNavPvt || key == ubx::kHnrPvt) {
    const UbxSolution solution = key == ubx::kNavPvt ? read_nav_pvt(payload) : read_hnr_pvt(payload);
    if (solution.date) gps = time_.from_date(*solution.date, itow_ms);
  } else if (key == ubx::kNavSol || key == ubx::kNavTimegps) {
    if (const std::optional<UbxWeek> week = read_ubx_week(key, payload))
      gps = time_.from_week(*week, itow_ms);
  } else if (key == ubx::kNavTimeutc) {
    if (const std::optional<UbxDate> date = read_nav_timeutc(payload)) gps = time_.from_date(*date, itow_ms);
  }
  if (!gps) gps = time_.from_itow(itow_ms);
  if (gps) clock_.navigation(*gps);
}

void UbxSensorDecoder::take_measurements(const UbxPayload& payload) {
  ++data_.records;
  const unsigned flags = payload.u16(4);
  const bool calibrated = (flags & 8U) != 0;
  const std::size_t tail = calibrated ? 4 : 0;
  std::size_t fields = flags >> 11U;
  // older firmware
  if (fields == 0 && payload.size() >= 8 + tail) fields = (payload.size() - 8 - tail) / 4;
  if (8 + 4 * fields + tail > payload.size())
    return corrupt(byte(), fmt::format("ESF-MEAS: {} bytes cannot hold {} measurements{}", payload.size(),
                                       fields, calibrated ? " and a calibrated time tag" : ""));
  if (!calibrated_) calibrated_ = calibrated;
  if (*calibrated_ != calibrated) {
    ++other_clock_;
    return;
  }
  bool any = false;
  values_.assign(data_.readings.columns, std::numeric_limits<double>::quiet_NaN());
  for (std::size_t i = 0; i < fields; ++i) {
    const std::uint32_t word = payload.u32(8 + 4 * i);
    const unsigned type = word >> 24U & 0x3FU;
    if (column_of_type_[type] < 0) continue;
    const std::uint32_t field = word & 0xFFFFFFU;
    const auto* channel = std::find_if(kUbxChannels.begin(), kUbxChannels.end(),
                                       [type](const UbxChannel& entry) { return entry.type == type; });
    values_[static_cast<std::size_t>(column_of_type_[type])] =
        channel->unit == 0 ? ticks_[type].count(field)
                           : static_cast<double>(signed_field(field)) * channel->unit;
    any = true;
  }
  const std::int64_t tag_ms = payload.u32(calibrated ? 8 + 4 * fields : 0);
  if (!held_.empty() && std::abs(tag_ms - held_.back().tag_ms) > kJumpMs) {
    release_all();
    clock_.restart();
  }
  clock_.sensor(tag_ms);
  if (any) hold(tag_ms);
}

/// Adds the current row to the waiting ones, and releases those that have waited long enough.
void UbxSensorDecoder::hold(std::int64_t tag_ms) {
  Row row{tag_ms, {}};
  if (!pool_.empty()) {
    row.values = std::move(pool_.back());
    pool_.pop_back();
  }
  row.values = values_;
  const auto place = std::upper_bound(held_.begin(), held_.end(), tag_ms,
                                      [](std::int64_t tag, const Row& other) { return tag < other.tag_ms; });
  held_.insert(place, std::move(row));
  if (clock_.ready()) {
    release(held_.back().tag_ms - kHeldMs);
  }
  if (held_.size() > kHeldRows) {
    if (clock_.ready()) {
      release(held_.front().tag_ms);
    } else {
      held_.pop_front();
      ++undated_;
    }
  }
}

void UbxSensorDecoder::release(std::int64_t up_to_tag_ms) {
  while (!held_.empty() && held_.front().tag_ms <= up_to_tag_ms) {
    Row& row = held_.front();
    Stamp stamp = convert(Stamp{clock_.gps_ns(row.tag_ms)}, TimeScale::gps, request().time_scale);
    stamp.nanoseconds += std::llround(request().time_offset_s * 1e9);
    data_.readings.stamps.push_back(stamp);
    data_.readings.values.insert(data_.readings.values.end(), row.values.begin(), row.values.end());
    pool_.push_back(std::move(row.values));
    held_.pop_front();
  }
}

void UbxSensorDecoder::release_all() {
  if (clock_.ready()) {
    release(std::numeric_limits<std::int64_t>::max());
  } else {
    undated_ += held_.size();
    held_.clear();
  }
}

void UbxSensorDecoder::end() {
  const std::size_t meetings = clock_.meetings();
  release_all();
  if (undated_ > 0) {
    data_.corrupt += undated_;
    data_.corrupt_examples.push_back(fmt::format(
        "{}: no navigation message gives a GPS week for {} ESF-MEAS messages; state 'time: {{week: ...}}' if "
        "navigation messages give the time of week",
        path(), undated_));
  }
  if (meetings > 0)
    note(fmt::format(
        "the {} of ESF-MEAS were placed on GNSS time by the order of the messages (drift over the "
        "log {:.3f} s); they are too early by the delay of the navigation messages: hundredths of a "
        "second with HNR-PVT, up to half a second without",
        *calibrated_ ? "calibrated time tags" : "time tags", static_cast<double>(clock_.drift_ns()) * 1e-9));
  if (clock_.jumps() > 0)
    note(fmt::format("the sensors' clock jumped or restarted {} times", clock_.jumps()));
  if (other_clock_ > 0)
    note(fmt::format("{} ESF-MEAS {} were skipped", other_clock_,
                     *calibrated_ ? "without a calibrated time tag (messages to the receiver)"
                                  : "with a calibrated time tag"));
  std::size_t restarts = 0;
  for (const UbxTicks& ticks : ticks_) restarts += ticks.restarts();
  if (restarts > 0)
    note(fmt::format("tick counters went back {} times; each time a restart without motion is assumed",
                     restarts));
  if (time_.used_stated_week())
    note(fmt::format("the first epochs state no GPS week; the stated week {} is used", request().gps_week));
}

}  // namespace waymark::formats
