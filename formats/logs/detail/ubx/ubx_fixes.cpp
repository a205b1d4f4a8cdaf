#include <waymark/formats/logs/detail/ubx/ubx_fixes.hpp>

#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include <waymark/core/base/angle.hpp>
#include <waymark/core/base/error.hpp>
#include <waymark/formats/logs/detail/common/inner_log.hpp>
#include <waymark/formats/logs/detail/nmea/nmea.hpp>

namespace waymark::formats {
namespace {

/// Converts degrees clockwise from north to radians counter-clockwise from east, in (-pi, pi].
double heading_from_course(double course_deg) {
  const double heading = std::remainder((90 - course_deg) * kDegree, 2 * std::numbers::pi);
  return heading <= -std::numbers::pi ? std::numbers::pi : heading;
}

std::optional<double> if_positive(double value) {
  return value > 0 ? std::optional<double>(value) : std::nullopt;
}

bool positive_definite(const Eigen::Matrix2d& matrix) {
  return matrix.allFinite() && matrix(0, 0) > 0 &&
         matrix(0, 0) * matrix(1, 1) - matrix(0, 1) * matrix(1, 0) > 0;
}

/// A message that the open epoch already has belongs to the next epoch, even with the same iTOW.
bool has(const UbxEpoch& epoch, std::uint16_t key) {
  switch (key) {
    case ubx::kNavPvt:
      return epoch.solution.has_value();
    case ubx::kNavHpposllh:
      return epoch.precise.has_value();
    case ubx::kNavPosllh:
      return epoch.plain.has_value();
    default:
      return false;
  }
}

FixDetails details_of(const UbxEpoch& epoch) {
  FixDetails told;
  const std::optional<UbxFixState> state = epoch.solution ? epoch.solution->state : epoch.state;
  if (state) {
    told.quality = state->type == 1      ? FixQuality::dead_reckoned
                   : state->carrier == 2 ? FixQuality::fixed
                   : state->carrier == 1 ? FixQuality::floating
                   : state->differential ? FixQuality::differential
                                         : FixQuality::single;
    told.satellites = state->satellites;
    told.correction_age_s = state->correction_age_s;
  }
  if (epoch.hdop) told.hdop = *epoch.hdop;
  return told;
}

}  // namespace

UbxFixDecoder::UbxFixDecoder(std::string path, LogRequest request, bool high_rate)
    : UbxFrameDecoder(std::move(path), std::move(request)),
      high_rate_(high_rate),
      positions_(this->path(), this->request(), "hAcc"),
      time_(this->request().gps_week) {}

void UbxFixDecoder::take_frame(const UbxFrame& frame) {
  const std::size_t least = least_ubx_length(frame.key);
  if (least == 0 || frame.key == ubx::kEsfMeas) return;
  if ((frame.key == ubx::kHnrPvt) != high_rate_) return;
  if (frame.payload.empty()) return;  // a request for the message, in a log of both directions
  if (frame.payload.size() < least) {
    ++data_.records;
    corrupt(byte(), fmt::format("{}: {} bytes, but the message has at least {}", ubx_name(frame.key),
                                frame.payload.size(), least));
    return;
  }
  const UbxPayload payload(frame.payload);
  if (high_rate_) {
    begin_epoch_for(frame.key, ubx_itow(frame.key, payload));
    epoch_->solution = read_hnr_pvt(payload);
    epoch_->number = number();
    end_epoch();
  } else {
    take_navigation(frame.key, payload);
  }
}

void UbxFixDecoder::take_navigation(std::uint16_t key, const UbxPayload& payload) {
  const std::uint32_t itow_ms = ubx_itow(key, payload);
  if (key == ubx::kNavEoe) return end_epoch();
  begin_epoch_for(key, itow_ms);
  UbxEpoch& epoch = *epoch_;
  switch (key) {
    case ubx::kNavPvt:
      epoch.solution = read_nav_pvt(payload);
      epoch.number = number();
      break;
    case ubx::kNavHpposllh:
      epoch.precise = read_nav_hpposllh(payload);
      epoch.number = number();
      break;
    case ubx::kNavPosllh:
      epoch.plain = read_nav_posllh(payload);
      epoch.number = number();
      break;
    case ubx::kNavPosecef:
      take_ecef(key, payload);
      break;
    case ubx::kNavVelecef:
      epoch.velecef = read_ubx_ecef_velocity(key, payload);
      break;
    case ubx::kNavVelned:
      epoch.velned = read_nav_velned(payload);
      break;
    case ubx::kNavCov:
      epoch.covariance = read_nav_cov(payload);
      break;
    case ubx::kNavTimeutc:
      epoch.utc = read_nav_timeutc(payload);
      break;
    case ubx::kNavTimegps:
      epoch.week = read_ubx_week(key, payload);
      break;
    case ubx::kNavStatus:
      if (!epoch.state) epoch.state = read_ubx_state(key, payload);
      break;
    case ubx::kNavSol:
      epoch.state = read_ubx_state(key, payload);
      if (!epoch.week) epoch.week = read_ubx_week(key, payload);
      take_ecef(key, payload);
      if (!epoch.velecef) epoch.velecef = read_ubx_ecef_velocity(key, payload);
      break;
    case ubx::kNavDop:
      epoch.hdop = read_nav_dop(payload);
      break;
    default:
      break;
  }
}

/// Takes the position of NAV-POSECEF or NAV-SOL, whichever comes first: they are the same.
void UbxFixDecoder::take_ecef(std::uint16_t key, const UbxPayload& payload) {
  UbxEpoch& epoch = *epoch_;
  if (epoch.ecef) return;
  epoch.ecef = read_ubx_ecef(key, payload);
  if (epoch.number == 0) epoch.number = number();
}

void UbxFixDecoder::begin_epoch_for(std::uint16_t key, std::uint32_t itow_ms) {
  if (epoch_ && epoch_->itow_ms == itow_ms && !has(*epoch_, key)) return;
  end_epoch();
  epoch_.emplace();
  epoch_->itow_ms = itow_ms;
  epoch_->byte = byte();
}

void UbxFixDecoder::end_epoch() {
  if (!epoch_) return;
  const UbxEpoch epoch = *epoch_;
  epoch_.reset();
  // Time is taken from every epoch, because one without a position may be the only one
  // with the week.
  const std::optional<std::int64_t> gps = epoch.itow_ms < kItowWeekMs ? time_of(epoch) : std::nullopt;
  if (!epoch.has_position()) return;
  ++data_.records;
  if (ended_ == epoch.itow_ms) ++counts_.repeated;
  ended_ = epoch.itow_ms;
  if (epoch.itow_ms >= kItowWeekMs)
    return corrupt(epoch.byte, fmt::format("iTOW {} ms lies beyond the end of a week", epoch.itow_ms));

  const std::optional<UbxFixState> state = epoch.solution ? epoch.solution->state : epoch.state;
  if (state && !state->usable()) {
    ++data_.without_fix;
    return;
  }
  if (!gps)
    return corrupt(
        epoch.byte,
        "there is no valid date and no GPS week yet; state 'time: {week: ...}' to use this position");
  const UbxPlace place = epoch.precise    ? *epoch.precise
                         : epoch.solution ? epoch.solution->place
                         : epoch.plain    ? *epoch.plain
                                          : ubx_place(*epoch.ecef);
  if (std::abs(place.latitude_deg) > 90 || std::abs(place.longitude_deg) > 180)
    return corrupt(epoch.byte, fmt::format("the position {}, {} is outside -90 .. 90, -180 .. 180",
                                           place.latitude_deg, place.longitude_deg));
  const std::optional<Stamp> stamp = positions_.stamp(Stamp{*gps}, TimeScale::gps);
  if (!stamp) return corrupt(epoch.byte, "its time is too large for a stamp");
  add_sample(epoch, place, *stamp);
}

std::optional<std::int64_t> UbxFixDecoder::time_of(const UbxEpoch& epoch) {
  if (epoch.solution && epoch.solution->date && epoch.solution->date->resolved)
    return time_.from_date(*epoch.solution->date, epoch.itow_ms);
  if (epoch.utc) return time_.from_date(*epoch.utc, epoch.itow_ms);
  if (epoch.week) return time_.from_week(*epoch.week, epoch.itow_ms);
  if (epoch.solution && epoch.solution->date) return time_.from_date(*epoch.solution->date, epoch.itow_ms);
  return epoch.has_position() ? time_.from_itow(epoch.itow_ms) : std::nullopt;
}

void UbxFixDecoder::add_sample(const UbxEpoch& epoch, const UbxPlace& place, Stamp stamp) {
  GeodeticFix fix;
  fix.told = details_of(epoch);
  if (const char* complaint = positions_.set_covariance(fix, accuracy(epoch, place)))
    return corrupt(epoch.byte, complaint);
  count(epoch);
  fix.stamp = stamp;
  fix.latitude_deg = place.latitude_deg;
  fix.longitude_deg = place.longitude_deg;
  fix.height_m = place.height_m;
  fix.line = epoch.number;
  if (epoch.solution || epoch.velned || epoch.velecef) {
    const UbxMotion motion = epoch.solution ? epoch.solution->motion
                             : epoch.velned ? *epoch.velned
                                            : ubx_motion(*epoch.velecef, place);
    fix.speed_mps = motion.speed_mps;
    fix.speed_sigma_mps = if_positive(motion.speed_accuracy_mps);
    fix.course_rad = motion.course_deg * kDegree;
    fix.course_sigma_rad = if_positive(motion.course_accuracy_deg * kDegree);
  }
  std::optional<double> heading;
  if (epoch.solution && epoch.solution->vehicle_heading_deg)
    heading = heading_from_course(*epoch.solution->vehicle_heading_deg);
  positions_.give(data_, fix, heading);
}

StatedAccuracy UbxFixDecoder::accuracy(const UbxEpoch& epoch, const UbxPlace& place) {
  if (positions_.wants_truth()) return {};
  if (epoch.covariance && positive_definite(*epoch.covariance)) {
    ++counts_.covariance;
    return {epoch.covariance, std::nullopt};
  }
  if (epoch.covariance) ++counts_.bad_covariance;
  if (!(place.accuracy_m > 0)) return {};
  return {place.accuracy_m * place.accuracy_m * Eigen::Matrix2d::Identity(), AccuracyMeaning::drms};
}

/// Updates the counts for the notes about an epoch that is used.
void UbxFixDecoder::count(const UbxEpoch& epoch) {
  ++(epoch.precise    ? counts_.precise
     : epoch.solution ? counts_.solution
     : epoch.plain    ? counts_.plain
                      : counts_.ecef);
  const std::optional<UbxFixState> state = epoch.solution ? epoch.solution->state : epoch.state;
  if (!state) ++counts_.stateless;
  if (state && state->type == 1) ++counts_.dead_reckoned;
  if (state && state->type == 4) ++counts_.combined;
  if (state && state->carrier == 1) ++counts_.carrier_float;
  if (state && state->carrier == 2) ++counts_.carrier_fixed;
}

void UbxFixDecoder::take_strange(std::string_view bytes) {
  if (high_rate_) return;
  if (!nmea_) {
    if (bytes.find('$') == std::string_view::npos) return;
    LogRequest request = this->request();
    request.columns.clear();
    nmea_ = NmeaReader().open(path(), request);
  }
  nmea_->take(bytes);
}

/// Takes the positions of NMEA sentences between the frames, in a log whose frames have none.
void UbxFixDecoder::take_nmea() {
  nmea_->finish();
  LogData& nmea = nmea_->data();
  if (nmea.fixes.empty() && nmea.truth.empty()) return;
  note("no UBX message holds a position; they are those of the NMEA sentences between the frames");
  data_.fixes = std::move(nmea.fixes);
  data_.truth = std::move(nmea.truth);
  data_.qualities = std::move(nmea.qualities);
  add_counts(data_, nmea);
  data_.kinds.merge(nmea.kinds);
}

void UbxFixDecoder::end() {
  end_epoch();
  const bool has_positions = counts_.precise + counts_.solution + counts_.plain + counts_.ecef > 0;
  if (!has_positions && data_.without_fix == 0 && nmea_) return take_nmea();
  if (data_.records == 0 && UbxFrameDecoder::count(ubx::kRxmRawx) > 0)
    throw InputError(
        fmt::format("{}: the log holds no positions but {} messages RXM-RAWX; fuse these with 'sensors: "
                    "{{name: gnss_raw, file: ...}}'",
                    path(), UbxFrameDecoder::count(ubx::kRxmRawx)));
  note_positions();
  note_time();
  positions_.finish(data_);
}

void UbxFixDecoder::note_positions() {
  const std::size_t used = counts_.precise + counts_.solution + counts_.plain + counts_.ecef;
  if (used > 0 && high_rate_) {
    note(fmt::format("{} positions of HNR-PVT are dead-reckoned from the last GNSS epoch and share its error",
                     used));
  } else if (used > 0) {
    note(fmt::format("positions: {} of NAV-HPPOSLLH, {} of NAV-PVT, {} of NAV-POSLLH", counts_.precise,
                     counts_.solution, counts_.plain));
    if (counts_.ecef > 0)
      note(fmt::format(
          "{} positions of NAV-POSECEF or NAV-SOL; their accuracy is that of all three dimensions",
          counts_.ecef));
  }
  if (!high_rate_ && UbxFrameDecoder::count(ubx::kHnrPvt) > 0)
    note(
        fmt::format("{} positions of HNR-PVT, dead-reckoned between the navigation epochs, were skipped "
                    "('position: HNR-PVT' among the columns reads them instead)",
                    UbxFrameDecoder::count(ubx::kHnrPvt)));
  if (counts_.dead_reckoned + counts_.combined > 0)
    note(fmt::format("{} positions by dead reckoning alone, {} by GNSS and dead reckoning combined",
                     counts_.dead_reckoned, counts_.combined));
  if (counts_.carrier_float + counts_.carrier_fixed > 0)
    note(fmt::format("{} positions with carrier phases fixed, {} with carrier phases as floats",
                     counts_.carrier_fixed, counts_.carrier_float));
  if (counts_.stateless > 0)
    note(fmt::format("{} positions do not state whether there is a fix and are taken as fixes",
                     counts_.stateless));
  if (counts_.repeated > 0)
    note(fmt::format("{} epochs repeat the iTOW of the one before", counts_.repeated));
  if (counts_.covariance > 0)
    note(fmt::format("{} fixes with the covariance of NAV-COV", counts_.covariance));
  if (counts_.bad_covariance > 0)
    note(fmt::format("{} covariances of NAV-COV are not positive definite and were skipped",
                     counts_.bad_covariance));
}

void UbxFixDecoder::note_time() {
  if (time_.seconds_from_itow() > 0)
    note(fmt::format("{} dates are not fully resolved and differ from iTOW by whole seconds; iTOW is used",
                     time_.seconds_from_itow()));
  if (time_.disagreements() > 0)
    note(fmt::format("{} dates differ from iTOW by a second or more; the dates are used",
                     time_.disagreements()));
  if (time_.used_stated_week())
    note(fmt::format("the first epochs state no GPS week; the stated week {} is used", request().gps_week));
  if (time_.continued() > 0)
    note(fmt::format("{} epochs without a valid date or week: the week is that of the epochs before",
                     time_.continued()));
}

}  // namespace waymark::formats
