#include <waymark/formats/logs/detail/nmea/nmea_epoch.hpp>

#include <algorithm>
#include <cmath>

#include <waymark/formats/logs/detail/common/accuracy.hpp>
#include <waymark/formats/logs/detail/common/record_fields.hpp>
#include <waymark/formats/logs/detail/common/table_accuracy.hpp>
#include <waymark/formats/text/detail/line_scanner.hpp>

namespace waymark::formats {
namespace {

constexpr double kKnot = 1852.0 / 3600;
constexpr double kKilometrePerHour = 1000.0 / 3600;
constexpr double kNoHdop = 1000;   // 99.99 is the usual "not known"; a larger number is damage
constexpr double kFastest = 1000;  // m/s; a larger number is damage

int rank(NmeaKind kind) {
  switch (kind) {
    case NmeaKind::gga:
      return 4;
    case NmeaKind::gns:
      return 3;
    case NmeaKind::rmc:
      return 2;
    case NmeaKind::gll:
      return 1;
    default:
      return 0;
  }
}

std::size_t decimals(std::string_view field) {
  const std::size_t point = field.find('.');
  return point == std::string_view::npos ? 0 : field.size() - point - 1;
}

/// Reads latitude and longitude from four fields. @param required the sentence states a fix
NmeaEpoch::Position read_position(NmeaKind kind, const NmeaFields& fields, std::size_t first,
                                  std::size_t line, bool required) {
  const std::optional<double> latitude = fields.latitude(first);
  const std::optional<double> longitude = fields.longitude(first + 2);
  if (latitude && longitude)
    return {*latitude, *longitude, kind, std::max(decimals(fields[first]), decimals(fields[first + 2])),
            line};
  if (required)
    throw BadNmeaField{fields[latitude ? first + 2 : first],
                       std::string("a fix without ") + (latitude ? "longitude" : "latitude")};
  return {};
}

/// Returns the quality of a letter of a mode indicator.
FixQuality letter_quality(char letter) {
  switch (letter) {
    case 'A':  // autonomous
    case 'P':  // precise: without degradation of the signals
      return FixQuality::single;
    case 'D':
      return FixQuality::differential;
    case 'F':
      return FixQuality::floating;
    case 'R':
      return FixQuality::fixed;
    case 'E':
      return FixQuality::dead_reckoned;
    case 'M':
      return FixQuality::manual;
    case 'S':
      return FixQuality::simulated;
    default:
      return FixQuality::unknown;
  }
}

/// The mode indicator of RMC, GLL and GNS. GNS has one for each satellite system.
struct Mode {
  bool none = false;
  FixQuality quality =
      FixQuality::unknown;  ///< that of the best system; dead reckoned, manual, simulated: of any

  explicit Mode(std::string_view letters) {
    none = !letters.empty() && letters.find_first_not_of('N') == std::string_view::npos;
    for (const char letter : letters) quality = std::max(quality, letter_quality(letter));
  }
};

void add_quality(const NmeaEpoch::Position& position, FixQuality quality, NmeaKind from, bool fixed,
                 NmeaEpoch& epoch) {
  if (rank(position.kind) > rank(epoch.position.kind) || position.kind == epoch.position.kind) {
    if (position.kind != NmeaKind::other) epoch.position = position;
  }
  epoch.without_fix = epoch.without_fix || !fixed;
  // Dead reckoned, manual and simulated count whoever tells them; else the sentence that knows best.
  const FixQuality either = std::max(quality, epoch.quality);
  if (either >= FixQuality::dead_reckoned) {
    epoch.quality = either;
  } else if (quality != FixQuality::unknown && rank(from) >= rank(epoch.quality_from)) {
    epoch.quality = quality;
    epoch.quality_from = from;
  }
}

std::optional<double> speed_from(const NmeaFields& fields, std::size_t index, double unit) {
  std::optional<double> speed = fields.number(index, "speed");
  if (!speed) return speed;
  *speed *= unit;
  if (!(*speed >= 0 && *speed <= kFastest))
    throw BadNmeaField{fields[index], "expected a speed of 0 to 1000 m/s, got " + quote_word(fields[index])};
  return speed;
}

std::optional<double> course_from(const NmeaFields& fields, std::size_t index) {
  const std::optional<double> course = fields.number(index, "course");
  if (course && !(std::abs(*course) <= 360))
    throw BadNmeaField{fields[index],
                       "expected a course of 0 to 360 degrees, got " + quote_word(fields[index])};
  return course;
}

void add_rmc(const NmeaFields& fields, std::size_t line, NmeaEpoch& epoch) {
  const Mode mode(fields[12]);
  const bool fixed = (fields[2] == "A" || fields[2] == "D") && !mode.none;
  const NmeaEpoch::Position position = read_position(NmeaKind::rmc, fields, 3, line, fixed);
  const std::optional<double> speed = speed_from(fields, 7, kKnot);
  const std::optional<double> course = course_from(fields, 8);
  // The clock of a receiver without a fix does not give the date.
  if (fixed && !epoch.has(NmeaKind::zda)) {
    if (const std::optional<std::int64_t> day = fields.short_date(9)) epoch.day = day;
  }
  if (speed) epoch.speed_mps = speed;
  if (course) epoch.course_deg = course;
  add_quality(position, mode.quality, NmeaKind::rmc, fixed, epoch);
}

bool is_hdop(const std::optional<double>& hdop) {
  return hdop && *hdop > 0 && *hdop < kNoHdop;
}

/// The fields that GGA and GNS share: satellites, dilution of precision, height and corrections.
struct Circumstances {
  std::optional<double> satellites;
  std::optional<double> hdop;
  std::optional<double> altitude;
  std::optional<double> separation;
  std::optional<double> age;

  Circumstances(const NmeaFields& fields, std::size_t separation_field, std::size_t age_field)
      : satellites(fields.number(7, "number of satellites")),
        hdop(fields.number(8, "HDOP")),
        altitude(fields.number(9, "altitude")),
        separation(fields.number(separation_field, "geoid separation")),
        age(field_number(fields[age_field])) {}  // receivers write anything there
  void add_to(NmeaEpoch& epoch) const {
    if (satellites) epoch.satellites = satellites;
    if (is_hdop(hdop)) epoch.hdop = hdop;
    if (age && *age >= 0) epoch.correction_age_s = age;
    if (altitude) {
      epoch.altitude_m = altitude;
      epoch.geoid_separation_m = separation;
    }
  }
};

void add_gga(const NmeaFields& fields, std::size_t line, NmeaEpoch& epoch) {
  const double quality = fields.number(6, "fix quality").value_or(0);
  const bool fixed = quality > 0;
  const NmeaEpoch::Position position = read_position(NmeaKind::gga, fields, 2, line, fixed);
  const Circumstances circumstances(fields, 11, 13);
  circumstances.add_to(epoch);
  add_quality(position, gga_quality(static_cast<int>(std::min(quality, 100.0))), NmeaKind::gga, fixed, epoch);
}

void add_gns(const NmeaFields& fields, std::size_t line, NmeaEpoch& epoch) {
  const Mode mode(fields[6]);
  // A receiver may add one GNS for every satellite system, without a position.
  const NmeaEpoch::Position position = read_position(NmeaKind::gns, fields, 2, line, false);
  const Circumstances circumstances(fields, 10, 11);
  if (position.kind != NmeaKind::other && !epoch.has(NmeaKind::gga)) circumstances.add_to(epoch);
  add_quality(position, mode.quality, NmeaKind::gns, !mode.none, epoch);
}

void add_gll(const NmeaFields& fields, std::size_t line, NmeaEpoch& epoch) {
  const Mode mode(fields[7]);
  const bool fixed = fields[6] != "V" && !mode.none;
  add_quality(read_position(NmeaKind::gll, fields, 1, line, fixed), mode.quality, NmeaKind::gll, fixed,
              epoch);
}

void add_vtg(const NmeaFields& fields, NmeaEpoch& epoch) {
  // Before version 2 of the standard no letters followed the fields. Such sentences are not read.
  if (fields[2] != "T" || Mode(fields[9]).none) return;
  const std::optional<double> course = course_from(fields, 1);
  std::optional<double> speed = speed_from(fields, 5, kKnot);
  if (!speed) speed = speed_from(fields, 7, kKilometrePerHour);
  if (!epoch.course_deg) epoch.course_deg = course;
  if (!epoch.speed_mps) epoch.speed_mps = speed;
}

/// GSA has no time and no position: it adds HDOP where GGA and GNS have none.
void add_gsa(const NmeaFields& fields, NmeaEpoch& epoch) {
  const std::optional<double> hdop = field_number(fields[16]);
  if (!epoch.hdop && is_hdop(hdop)) epoch.hdop = hdop;
}

void add_gst(const NmeaFields& fields, NmeaEpoch& epoch) {
  NmeaAccuracy accuracy;
  accuracy.north_m = fields.number(6, "latitude error").value_or(0);
  accuracy.east_m = fields.number(7, "longitude error").value_or(0);
  const double major = fields.number(3, "semi-major axis").value_or(0);
  const double minor = fields.number(4, "semi-minor axis").value_or(0);
  const std::optional<double> orientation = fields.number(5, "orientation");
  if (!is_accuracy(accuracy.north_m) || !is_accuracy(accuracy.east_m)) return;
  if (is_accuracy(major) && is_accuracy(minor) && orientation) {
    const std::optional<double> correlation =
        ellipse_correlation(accuracy.east_m, accuracy.north_m, major, minor, *orientation);
    accuracy.has_ellipse = correlation.has_value();
    accuracy.ellipse_disagrees = !correlation;
    accuracy.correlation = correlation.value_or(0);
  }
  epoch.accuracy = accuracy;
}

}  // namespace

NmeaKind nmea_kind(std::string_view address) {
  if (address.size() != 5 || address[0] == 'P') return NmeaKind::other;
  const std::string_view kind = address.substr(2);
  if (kind == "RMC") return NmeaKind::rmc;
  if (kind == "GGA") return NmeaKind::gga;
  if (kind == "GNS") return NmeaKind::gns;
  if (kind == "GST") return NmeaKind::gst;
  if (kind == "VTG") return NmeaKind::vtg;
  if (kind == "ZDA") return NmeaKind::zda;
  if (kind == "GLL") return NmeaKind::gll;
  if (kind == "GSA") return NmeaKind::gsa;
  return NmeaKind::other;
}

std::optional<std::int64_t> nmea_time(NmeaKind kind, const NmeaFields& fields) {
  if (kind == NmeaKind::vtg || kind == NmeaKind::gsa || kind == NmeaKind::other) return std::nullopt;
  return fields.time_of_day(kind == NmeaKind::gll ? 5 : 1);
}

bool places_elsewhere(NmeaKind kind, const NmeaFields& fields, const NmeaEpoch& epoch) {
  if (kind != epoch.position.kind || rank(kind) == 0) return false;
  const std::size_t first = kind == NmeaKind::gll ? 1 : kind == NmeaKind::rmc ? 3 : 2;
  const std::optional<double> latitude = fields.latitude(first);
  const std::optional<double> longitude = fields.longitude(first + 2);
  return latitude && longitude &&
         (*latitude != epoch.position.latitude_deg || *longitude != epoch.position.longitude_deg);
}

void add_to_epoch(NmeaKind kind, const NmeaFields& fields, std::size_t line, NmeaEpoch& epoch) {
  switch (kind) {
    case NmeaKind::other:
      return;
    case NmeaKind::rmc:
      add_rmc(fields, line, epoch);
      break;
    case NmeaKind::gga:
      add_gga(fields, line, epoch);
      break;
    case NmeaKind::gns:
      add_gns(fields, line, epoch);
      break;
    case NmeaKind::gll:
      add_gll(fields, line, epoch);
      break;
    case NmeaKind::vtg:
      add_vtg(fields, epoch);
      break;
    case NmeaKind::gst:
      add_gst(fields, epoch);
      break;
    case NmeaKind::gsa:
      add_gsa(fields, epoch);
      break;
    case NmeaKind::zda:
      if (const std::optional<std::int64_t> day = fields.long_date(2)) epoch.day = day;
      break;
  }
  epoch.seen |= 1U << static_cast<unsigned>(kind);
}

}  // namespace waymark::formats
