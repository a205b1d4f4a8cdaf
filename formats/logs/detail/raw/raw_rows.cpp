#include <waymark/formats/logs/detail/raw/raw_rows.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <numbers>
#include <utility>

#include <fmt/format.h>

#include <waymark/core/base/error.hpp>
#include <waymark/formats/logs/detail/common/gps_time.hpp>
#include <waymark/formats/logs/detail/rinex/rinex_navigation.hpp>
#include <waymark/formats/text/iso8601.hpp>

namespace waymark::formats {
namespace {

using satellites::CorrectedMeasurement;
using satellites::PlacedMeasurement;
using satellites::RawEpoch;

constexpr double kLowest_rad = 5 * std::numbers::pi / 180;
constexpr std::int64_t kWeekCycle_ns = 1024 * kGpsWeekNanoseconds;
/// Epochs that wait for the first position. At 10 Hz a minute passes.
constexpr std::size_t kMostWaiting = 600;
/// Every satellite sends its whole ephemeris within 30 s (GPS, Galileo, BeiDou).
constexpr double kEarly_s = 60;
constexpr std::size_t kMostEarly = 2000;

/// The calendar of GPS, without leap seconds.
std::string date_text(Stamp gps) {
  const std::string text = iso8601_from_stamp(Stamp{gps.nanoseconds + kGpsEpochPosix});
  return text.substr(0, text.find_first_of(".Z"));
}

/// A number of a measurement by the name of its column (plugins/gnss_raw/README.md).
struct RawColumn {
  std::string_view name;
  double (*value)(const CorrectedMeasurement&);
};
using Corrected = const CorrectedMeasurement&;
constexpr std::array kRawColumns{
    RawColumn{"system", [](Corrected of) { return double(static_cast<int>(of.placed.raw.satellite.first)); }},
    RawColumn{"satellite", [](Corrected of) { return double(of.placed.raw.satellite.second); }},
    RawColumn{"pseudorange", [](Corrected of) { return of.pseudorange_m; }},
    RawColumn{"range_rate", [](Corrected of) { return of.range_rate_mps; }},
    RawColumn{"satellite_x", [](Corrected of) { return of.placed.satellite.position.x(); }},
    RawColumn{"satellite_y", [](Corrected of) { return of.placed.satellite.position.y(); }},
    RawColumn{"satellite_z", [](Corrected of) { return of.placed.satellite.position.z(); }},
    RawColumn{"satellite_vx", [](Corrected of) { return of.placed.satellite.velocity.x(); }},
    RawColumn{"satellite_vy", [](Corrected of) { return of.placed.satellite.velocity.y(); }},
    RawColumn{"satellite_vz", [](Corrected of) { return of.placed.satellite.velocity.z(); }},
    RawColumn{"elevation", [](Corrected of) { return of.direction.elevation_rad; }},
    RawColumn{"cn0", [](Corrected of) { return of.placed.raw.cn0_dbhz; }},
};

double column_of(const CorrectedMeasurement& measurement, std::string_view name) {
  const auto found = std::find_if(kRawColumns.begin(), kRawColumns.end(),
                                  [name](const RawColumn& column) { return column.name == name; });
  return found == kRawColumns.end() ? std::numeric_limits<double>::quiet_NaN() : found->value(measurement);
}

}  // namespace

RawRows::RawRows(std::string path, const LogRequest& request, LogData& data)
    : path_(std::move(path)), request_(request), data_(data) {
  data_.readings.columns = request_.readings.size();
  constexpr double kLargestOffset_s = 1e9;  // added to a date before 2200
  if (!(std::abs(request_.time_offset_s) <= kLargestOffset_s))
    throw InputError(fmt::format("{}: with an offset of {} s its time is too large for a stamp", path_,
                                 request_.time_offset_s));
  const auto files = request_.companions.find("navigation");
  if (files != request_.companions.end()) {
    for (const CompanionFile& file : files->second) {
      files_ += files_.empty() ? file.path : ", " + file.path;
      read_rinex_navigation(file, ephemerides_, data_.notes);
    }
  }
  is_early_ = files_.empty();
}

void RawRows::take(const RawEpoch& epoch) {
  if (!is_early_) return place(epoch);
  early_.push_back(epoch);
  if (seconds_between(early_.front().moment, epoch.moment) > kEarly_s || early_.size() > kMostEarly)
    take_early();
}

void RawRows::take_early() {
  is_early_ = false;
  for (RawEpoch& epoch : early_) place(std::move(epoch));
  early_.clear();
}

/// A week that was counted in another cycle is far from all ephemerides, by whole cycles.
void RawRows::find_cycle(const RawEpoch& epoch) {
  cycles_ = 0;
  if (ephemerides_.empty()) return;
  const auto [first, last] = ephemerides_.times();
  const double away = static_cast<double>(first.nanoseconds - epoch.moment.nanoseconds);
  const auto cycles = std::llround(away / static_cast<double>(kWeekCycle_ns));
  const double left_s = (away - static_cast<double>(cycles) * static_cast<double>(kWeekCycle_ns)) * 1e-9;
  constexpr double kDays_s = 2 * 86'400;
  cycles_ = std::abs(left_s) < kDays_s + seconds_between(first, last) ? cycles : 0;
  if (*cycles_ != 0)
    note(fmt::format("its dates are {} cycles of 1024 weeks off by the navigation file; {} weeks are added",
                     std::abs(*cycles_), *cycles_ * 1024));
}

void RawRows::place(RawEpoch epoch) {
  if (!cycles_) find_cycle(epoch);
  epoch.moment.nanoseconds += *cycles_ * kWeekCycle_ns;
  if (!first_) first_ = epoch.moment;
  last_ = epoch.moment;
  Waiting next{epoch.moment, {}};
  for (const satellites::RawMeasurement& raw : epoch.satellites) {
    ++data_.records;
    if (const auto found = satellites::placed(raw, epoch.moment, ephemerides_))
      next.measurements.push_back(*found);
    else
      ++without_ephemeris_[raw.satellite];
  }
  placed_ += next.measurements.size();
  locate(next.measurements);
  if (!place_) {
    waiting_.push_back(std::move(next));
    if (waiting_.size() > kMostWaiting) {
      given_up_ += waiting_.front().measurements.size();
      waiting_.pop_front();
    }
    return;
  }
  for (const Waiting& before : waiting_) give(before);
  waiting_.clear();
  give(next);
}

/// The place is that of the last epoch that has one: the atmosphere is the same a kilometre away.
void RawRows::locate(const std::vector<PlacedMeasurement>& measurements) {
  const auto solved = satellites::rough_place(measurements, place_.value_or(Eigen::Vector3d::Zero()));
  if (solved) place_ = solved;
}

void RawRows::give(const Waiting& epoch) {
  for (const PlacedMeasurement& measurement : epoch.measurements) {
    const CorrectedMeasurement corrected =
        satellites::corrected(measurement, epoch.moment, *place_, ephemerides_);
    if (corrected.direction.elevation_rad < kLowest_rad) {
      ++low_;
      continue;
    }
    add_row(epoch.moment, corrected);
  }
}

void RawRows::add_row(Stamp moment, const CorrectedMeasurement& measurement) {
  Stamp stamp = convert(moment, TimeScale::gps, request_.time_scale);
  stamp.nanoseconds += std::llround(request_.time_offset_s * 1e9);
  ++given_;
  data_.readings.stamps.push_back(stamp);
  for (const SensorColumn& column : request_.readings)
    data_.readings.values.push_back(column_of(measurement, column.name));
}

void RawRows::finish() {
  take_early();
  require_ephemerides();
  for (const Waiting& epoch : waiting_) given_up_ += epoch.measurements.size();
  waiting_.clear();
  if (placed_ > 0 && given_ == 0)
    throw InputError(fmt::format(
        "{}: no epoch has five satellites with an ephemeris, and no place is stated "
        "(RINEX: APPROX POSITION XYZ), so the atmosphere cannot be corrected; add navigation files of "
        "the other systems",
        path_));
  add_notes();
}

/// @throws InputError if the satellites have measurements and none has an ephemeris
void RawRows::require_ephemerides() const {
  if (placed_ > 0 || without_ephemeris_.empty()) return;
  if (ephemerides_.empty())
    throw InputError(
        fmt::format("{}: no message of the log holds a whole ephemeris from {} to {} (GPS time); name the "
                    "broadcast ephemerides of that day with 'navigation: FILE'",
                    path_, date_text(*first_), date_text(*last_)));
  const auto [first, last] = ephemerides_.times();
  throw InputError(
      fmt::format("{}: no satellite has a usable ephemeris from {} to {} (GPS time); {} has them from {} to "
                  "{}; name the navigation file of that day and of these systems",
                  path_, date_text(*first_), date_text(*last_), has_navigation_files() ? files_ : "the log",
                  date_text(first), date_text(last)));
}

void RawRows::add_notes() {
  std::size_t missing = 0;
  std::string names;
  for (const auto& [satellite, count] : without_ephemeris_) {
    missing += count;
    names += (names.empty() ? "" : " ") + satellites::to_string(satellite);
  }
  constexpr std::size_t kShown = 120;
  if (names.size() > kShown) names = names.substr(0, kShown - 3) + "...";
  if (missing > 0)
    note(fmt::format("{} measurements have no usable ephemeris and are left out: {}", missing, names));
  if (low_ > 0) note(fmt::format("{} measurements below 5 degrees are left out", low_));
  if (given_up_ > 0) note(fmt::format("{} measurements before the first position are left out", given_up_));
  if (!ephemerides_.ionosphere)
    note(fmt::format(
        "{} has coefficients of the ionosphere: those of a typical day stand for them; heights may "
        "be wrong by metres",
        has_navigation_files() ? "no navigation file" : "no message of the log"));
}

}  // namespace waymark::formats
