#include <waymark/formats/logs/detail/rinex/rinex.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <deque>
#include <limits>
#include <map>
#include <numbers>
#include <utility>

#include <fmt/format.h>

#include <waymark/core/base/error.hpp>
#include <waymark/formats/logs/detail/common/gps_time.hpp>
#include <waymark/formats/logs/detail/common/line_decoder.hpp>
#include <waymark/formats/logs/detail/common/log_request.hpp>
#include <waymark/formats/logs/detail/rinex/rinex_navigation.hpp>
#include <waymark/formats/logs/detail/rinex/rinex_observations.hpp>
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

/// The calendar of GPS, without leap seconds.
std::string date_text(Stamp gps) {
  const std::string text = iso8601_from_stamp(Stamp{gps.nanoseconds + kGpsEpochPosix});
  return text.substr(0, text.find_first_of(".Z"));
}

/// A number of a measurement by the name of its column (plugins/gnss_raw/README.md).
struct RinexColumn {
  std::string_view name;
  double (*value)(const CorrectedMeasurement&);
};
using Corrected = const CorrectedMeasurement&;
constexpr std::array kRinexColumns{
    RinexColumn{"system",
                [](Corrected of) { return double(static_cast<int>(of.placed.raw.satellite.first)); }},
    RinexColumn{"satellite", [](Corrected of) { return double(of.placed.raw.satellite.second); }},
    RinexColumn{"pseudorange", [](Corrected of) { return of.pseudorange_m; }},
    RinexColumn{"range_rate", [](Corrected of) { return of.range_rate_mps; }},
    RinexColumn{"satellite_x", [](Corrected of) { return of.placed.satellite.position.x(); }},
    RinexColumn{"satellite_y", [](Corrected of) { return of.placed.satellite.position.y(); }},
    RinexColumn{"satellite_z", [](Corrected of) { return of.placed.satellite.position.z(); }},
    RinexColumn{"satellite_vx", [](Corrected of) { return of.placed.satellite.velocity.x(); }},
    RinexColumn{"satellite_vy", [](Corrected of) { return of.placed.satellite.velocity.y(); }},
    RinexColumn{"satellite_vz", [](Corrected of) { return of.placed.satellite.velocity.z(); }},
    RinexColumn{"elevation", [](Corrected of) { return of.direction.elevation_rad; }},
    RinexColumn{"cn0", [](Corrected of) { return of.placed.raw.cn0_dbhz; }},
};

double column_of(const CorrectedMeasurement& measurement, std::string_view name) {
  const auto found = std::find_if(kRinexColumns.begin(), kRinexColumns.end(),
                                  [name](const RinexColumn& column) { return column.name == name; });
  return found == kRinexColumns.end() ? std::numeric_limits<double>::quiet_NaN() : found->value(measurement);
}

class RinexDecoder final : public LineDecoder {
 public:
  RinexDecoder(const std::string& path, const LogRequest& request)
      : LineDecoder(path, request),
        observations_(path, {[this](const RawEpoch& epoch) { take_epoch(epoch); },
                             [this](std::size_t line, std::size_t column, const std::string& what) {
                               ++data_.records;
                               corrupt(line, column, what);
                             }}) {
    data_.readings.columns = request.readings.size();
    for (const CompanionFile& file : request.companions.at("navigation")) {
      files_ += files_.empty() ? file.path : ", " + file.path;
      read_rinex_navigation(file, ephemerides_, data_.notes);
    }
  }

 protected:
  void take_line(std::string_view line, std::size_t number) override {
    observations_.take_line(line, number);
  }
  void end() override;

 private:
  struct Waiting {
    Stamp moment;
    std::vector<PlacedMeasurement> measurements;
  };

  void take_epoch(RawEpoch epoch);
  void find_cycle(const RawEpoch& epoch);
  void locate(const std::vector<PlacedMeasurement>& measurements);
  void give(const Waiting& epoch);
  void add_row(Stamp moment, const CorrectedMeasurement& measurement);
  void require_ephemerides() const;
  void add_notes();

  RinexObservations observations_;
  satellites::Ephemerides ephemerides_;
  std::string files_;
  std::optional<std::int64_t> cycles_;  ///< of 1024 weeks that are added
  std::optional<Eigen::Vector3d> place_;
  std::deque<Waiting> waiting_;
  std::map<satellites::SatelliteName, std::size_t> without_ephemeris_;
  std::optional<Stamp> first_, last_;
  std::size_t placed_ = 0, low_ = 0, given_up_ = 0;
};

/// A week that was counted in another cycle is far from all ephemerides, by whole cycles.
void RinexDecoder::find_cycle(const RawEpoch& epoch) {
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

void RinexDecoder::take_epoch(RawEpoch epoch) {
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
  if (!place_) place_ = observations_.stated_place();
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
void RinexDecoder::locate(const std::vector<PlacedMeasurement>& measurements) {
  const auto solved = satellites::rough_place(measurements, place_.value_or(Eigen::Vector3d::Zero()));
  if (solved) place_ = solved;
}

void RinexDecoder::give(const Waiting& epoch) {
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

void RinexDecoder::add_row(Stamp moment, const CorrectedMeasurement& measurement) {
  Stamp stamp = convert(moment, TimeScale::gps, request().time_scale);
  stamp.nanoseconds += std::llround(request().time_offset_s * 1e9);
  data_.readings.stamps.push_back(stamp);
  for (const SensorColumn& column : request().readings)
    data_.readings.values.push_back(column_of(measurement, column.name));
}

void RinexDecoder::end() {
  observations_.finish();
  require_ephemerides();
  for (const Waiting& epoch : waiting_) given_up_ += epoch.measurements.size();
  waiting_.clear();
  if (placed_ > 0 && data_.readings.size() == 0)
    throw InputError(
        fmt::format("{}: no epoch has five satellites with an ephemeris, and the header states no place "
                    "(APPROX POSITION XYZ), so the atmosphere cannot be corrected; add navigation files of "
                    "the other systems",
                    path()));
  add_notes();
}

/// @throws InputError if the satellites have measurements and none has an ephemeris
void RinexDecoder::require_ephemerides() const {
  if (placed_ > 0 || without_ephemeris_.empty()) return;
  const auto [first, last] = ephemerides_.times();
  throw InputError(
      fmt::format("{}: no satellite has a usable ephemeris from {} to {} (GPS time); {} has them from {} to "
                  "{}; name the navigation file of that day and of these systems",
                  path(), date_text(*first_), date_text(*last_), files_, date_text(first), date_text(last)));
}

void RinexDecoder::add_notes() {
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
  if (observations_.unused() > 0)
    note(fmt::format("{} measurements have no pseudorange of a first frequency, or are of another system",
                     observations_.unused()));
  if (observations_.events() > 0) note(fmt::format("{} event records were skipped", observations_.events()));
  if (!ephemerides_.ionosphere)
    note("no navigation file has coefficients of the ionosphere; its delay is left in the pseudoranges");
}

}  // namespace

std::unique_ptr<LogDecoder> RinexReader::open(const std::string& path, const LogRequest& request) const {
  if (request.stream == StreamKind::gnss)
    throw InputError(
        fmt::format("{}: a RINEX file of observations holds no fixes but pseudoranges; name the broadcast "
                    "ephemerides beside it, 'navigation: FILE'",
                    path));
  require_streams(path, request, "a RINEX file of observations", {StreamKind::sensor});
  require_no_columns(path, request, "a RINEX file of observations");
  require_companions(path, request, "a RINEX file of observations", "navigation");
  if (!request.companions.contains("navigation"))
    throw InputError(
        fmt::format("{}: the satellites of a RINEX file need broadcast ephemerides; name them with "
                    "'navigation: FILE' (one file or a list)",
                    path));
  return std::make_unique<RinexDecoder>(path, request);
}

Recognition RinexReader::recognise(std::string_view head) const {
  const std::optional<RinexVersion> version = rinex_version(head.substr(0, head.find_first_of("\r\n")));
  if (!version || version->kind != 'O') return {};
  return {1, fmt::format("the first line is that of RINEX {:.2f} observations", version->version)};
}

}  // namespace waymark::formats
