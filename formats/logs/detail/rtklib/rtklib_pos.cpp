#include <waymark/formats/logs/detail/rtklib/rtklib_pos.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include <fmt/format.h>

#include <waymark/core/base/error.hpp>
#include <waymark/formats/logs/detail/common/gps_time.hpp>
#include <waymark/formats/logs/detail/common/line_decoder.hpp>
#include <waymark/formats/logs/detail/common/log_request.hpp>
#include <waymark/formats/logs/detail/common/position_stream.hpp>
#include <waymark/formats/logs/detail/common/record_fields.hpp>
#include <waymark/formats/logs/detail/common/table_accuracy.hpp>
#include <waymark/formats/logs/detail/place/geocentric.hpp>
#include <waymark/formats/logs/detail/rtklib/rtklib_header.hpp>
#include <waymark/formats/text/detail/line_scanner.hpp>
#include <waymark/formats/text/iso8601.hpp>

namespace waymark::formats {
namespace {

constexpr const char* kPosFormat = "an RTKLIB solution";
constexpr std::array<const char*, 8> kQualities{"none", "fix",    "float", "sbas",
                                                "dgps", "single", "ppp",   "dead reckoning"};
constexpr std::int64_t kHour = 3'600'000'000'000;

double signed_square(double root) {
  return root * std::abs(root);
}

/// Returns the symmetric matrix of three deviations and the signed roots of the
/// covariances 01, 12, 20.
Eigen::Matrix3d covariance_xyz(const std::array<double, 6>& deviation) {
  Eigen::Matrix3d result;
  const double xy = signed_square(deviation[3]);
  const double yz = signed_square(deviation[4]);
  const double zx = signed_square(deviation[5]);
  result << deviation[0] * deviation[0], xy, zx,  //
      xy, deviation[1] * deviation[1], yz,        //
      zx, yz, deviation[2] * deviation[2];
  return result;
}

class RtklibDecoder final : public LineDecoder {
 public:
  RtklibDecoder(const std::string& path, const LogRequest& request)
      : LineDecoder(path, request), positions_(path, request, "standard deviations") {}

 private:
  void take_line(std::string_view line, std::size_t number) override;
  void end() override;

  void take_record(std::size_t number);
  [[nodiscard]] bool has_fix();
  void read_details(GeodeticFix& fix);
  [[nodiscard]] std::optional<Stamp> stamp();
  [[nodiscard]] GeodeticPlace place();
  [[nodiscard]] double angle(std::size_t first, const char* name, double limit);
  void choose_axes(const GeodeticPlace& place);
  [[nodiscard]] std::optional<Eigen::Matrix2d> horizontal(std::size_t first);
  void read_velocity(GeodeticFix& fix);

  [[nodiscard]] double number(std::size_t field, const char* name);
  void complain(std::size_t field, const std::string& what);
  [[nodiscard]] bool is_sound() const { return what_.empty(); }

  PositionStream positions_;
  RtklibHeader header_;
  RecordFields fields_;
  std::array<std::size_t, kQualities.size()> qualities_{};
  bool any_without_names_ = false;
  bool any_above_geoid_ = false;

  Eigen::Matrix3d enu_from_axes_ = Eigen::Matrix3d::Identity();  ///< of the current record
  std::size_t column_ = 0;                                       ///< of the first error
  std::string what_;                                             ///< empty: no error yet
};

void RtklibDecoder::take_line(std::string_view line, std::size_t number) {
  const std::size_t start = line.find_first_not_of(" \t");
  if (start == std::string_view::npos) return;
  if (line[start] == '%') {
    header_.take(line.substr(start));
    return;
  }
  ++data_.records;
  what_.clear();
  fields_.split_words(line);
  const bool as_named = fields_.count() == header_.fields;
  if (!as_named && (header_.names_columns || fields_.count() < 7)) {
    complain(fields_.count(),
             fmt::format("expected {}{} fields, got {}", header_.names_columns ? "" : "at least ",
                         header_.names_columns ? header_.fields : 7, fields_.count()));
  } else {
    take_record(number);
  }
  if (!is_sound()) corrupt(number, column_, what_);
}

void RtklibDecoder::take_record(std::size_t number) {
  if (!has_fix()) return;
  const std::optional<Stamp> at = stamp();
  const GeodeticPlace where = place();
  if (!at || !is_sound()) return;
  GeodeticFix fix;
  fix.stamp = *at;
  fix.latitude_deg = where.latitude_deg;
  fix.longitude_deg = where.longitude_deg;
  fix.height_m = where.height_m;
  fix.line = number;
  read_details(fix);
  StatedAccuracy accuracy;
  if (!positions_.wants_truth()) {
    choose_axes(where);
    const bool has_sigmas = header_.sigma > 0 && fields_.count() >= header_.sigma + 6;
    if (has_sigmas) accuracy.squares_en = horizontal(header_.sigma);
    if (header_.velocity > 0) read_velocity(fix);
    if (!is_sound()) return;
  }
  const char* complaint = positions_.add(data_, fix, accuracy);
  if (complaint != nullptr) {
    complain(header_.sigma > 0 ? header_.sigma : 0, complaint);
    return;
  }
  any_without_names_ = any_without_names_ || !header_.names_columns;
  any_above_geoid_ = any_above_geoid_ || header_.above_geoid;
}

bool RtklibDecoder::has_fix() {
  const std::optional<int> quality = field_count(fields_[header_.quality]);
  if (!quality || *quality >= static_cast<int>(kQualities.size())) {
    complain(header_.quality,
             fmt::format("Q: expected a quality 0 .. 7, got {}", quote_word(fields_[header_.quality])));
    return false;
  }
  ++qualities_[static_cast<std::size_t>(*quality)];
  if (*quality == 0) ++data_.without_fix;
  return *quality != 0;
}

/// Reads Q, the number of satellites after it, and the age of the corrections.
void RtklibDecoder::read_details(GeodeticFix& fix) {
  fix.told.quality = rtklib_quality(field_count(fields_[header_.quality]).value_or(0));
  fix.told.satellites = field_count(fields_[header_.quality + 1]).value_or(-1);
  if (header_.sigma == 0 || fix.told.quality == FixQuality::single) return;
  const std::optional<double> age_s = field_number(fields_[header_.sigma + 6]);
  if (age_s && *age_s >= 0) fix.told.correction_age_s = *age_s;
}

std::optional<Stamp> RtklibDecoder::stamp() {
  const std::string_view day = fields_[0];
  const std::string_view time = fields_[1];
  std::optional<Stamp> given;
  if (day.find('/') == std::string_view::npos) {
    given = stamp_from_gps_week(day, time);
    // For UTC and JST, RTKLIB counts calendar weeks.
    if (given && header_.scale != TimeScale::gps) given->nanoseconds += kGpsEpochPosix;
  } else if (day.size() == 10 && time.size() >= 8 && time.size() <= 20) {
    std::array<char, 31> text{};
    std::copy(day.begin(), day.end(), text.begin());
    text[4] = day[4] == '/' ? '-' : '?';
    text[7] = day[7] == '/' ? '-' : '?';
    text[10] = 'T';
    std::copy(time.begin(), time.end(), text.begin() + 11);
    given = stamp_from_iso8601({text.data(), 11 + time.size()});
    if (given && header_.scale == TimeScale::gps) given->nanoseconds -= kGpsEpochPosix;
  }
  if (!given) {
    complain(0, fmt::format("time: expected yyyy/mm/dd hh:mm:ss.sss or a GPS week and its seconds, got {} {}",
                            quote_word(day), quote_word(time)));
    return std::nullopt;
  }
  given->nanoseconds -= header_.hours_ahead * kHour;
  const std::optional<Stamp> stamp = positions_.stamp(*given, header_.scale);
  if (!stamp) complain(0, "its time is too large for a stamp");
  return stamp;
}

GeodeticPlace RtklibDecoder::place() {
  if (header_.layout == RtklibLayout::degrees)
    return {angle(2, "latitude", 90), angle(3, "longitude", 360), number(4, "height")};
  if (header_.layout == RtklibLayout::sexagesimal)
    return {angle(2, "latitude", 90), angle(5, "longitude", 360), number(8, "height")};
  const bool baseline = header_.layout == RtklibLayout::baseline;
  if (baseline && !header_.reference)
    throw InputError(
        fmt::format("{}: the baselines (e/n/u) have no reference position: there is no '% ref pos' "
                    "line in degrees above them; let RTKLIB write latitude, longitude and height",
                    path()));
  const Eigen::Vector3d given(number(2, baseline ? "e-baseline" : "x-ecef"),
                              number(3, baseline ? "n-baseline" : "y-ecef"),
                              number(4, baseline ? "u-baseline" : "z-ecef"));
  if (!is_sound()) return {};
  Eigen::Vector3d ecef = given;
  if (baseline) {
    const GeodeticPlace& reference = *header_.reference;
    ecef = ecef_from_geodetic(reference) +
           enu_from_ecef(reference.latitude_deg, reference.longitude_deg).transpose() * given;
  }
  const double radius = ecef.norm();
  if (!(radius > 6.2e6 && radius < 7.5e6)) {
    complain(2, fmt::format("the position is {:.0f} km from the centre of the Earth", radius / 1000));
    return {};
  }
  return geodetic_from_ecef(ecef);
}

/// Reads degrees from one field or three.
double RtklibDecoder::angle(std::size_t first, const char* name, double limit) {
  double degrees = number(first, name);
  if (header_.layout == RtklibLayout::sexagesimal) {
    const double minutes = number(first + 1, name);
    const double seconds = number(first + 2, name);
    if (!(minutes >= 0 && minutes < 60 && seconds >= 0 && seconds <= 60))  // 60 by rounding
      complain(first, fmt::format("{}: minutes or seconds are outside 0 .. 60", name));
    degrees = std::copysign(std::abs(degrees) + minutes / 60 + seconds / 3600, degrees);
  }
  if (is_sound() && std::abs(degrees) > limit)
    complain(first, fmt::format("{}: {} is outside {} .. {}", name, degrees, -limit, limit));
  return degrees;
}

/// Sets the rotation from the axes of deviations and velocities to east, north, up at the fix.
void RtklibDecoder::choose_axes(const GeodeticPlace& where) {
  if (header_.layout == RtklibLayout::ecef || header_.layout == RtklibLayout::baseline)
    enu_from_axes_ = enu_from_ecef(where.latitude_deg, where.longitude_deg);
  if (header_.layout == RtklibLayout::baseline)
    enu_from_axes_ *=
        enu_from_ecef(header_.reference->latitude_deg, header_.reference->longitude_deg).transpose();
}

/// Returns the covariance in east and north from six deviations; empty if they are zero.
std::optional<Eigen::Matrix2d> RtklibDecoder::horizontal(std::size_t first) {
  std::array<double, 6> deviation{};
  for (std::size_t i = 0; i < deviation.size(); ++i) deviation[i] = number(first + i, "standard deviation");
  if (!is_sound()) return std::nullopt;
  if (header_.layout == RtklibLayout::degrees || header_.layout == RtklibLayout::sexagesimal) {
    if (deviation[0] == 0 || deviation[1] == 0) return std::nullopt;
    const double east_north = signed_square(deviation[3]);
    Eigen::Matrix2d result;
    result << deviation[1] * deviation[1], east_north, east_north, deviation[0] * deviation[0];
    return result;
  }
  if (deviation[0] == 0 || deviation[1] == 0 || deviation[2] == 0) return std::nullopt;
  const Eigen::Matrix3d enu = enu_from_axes_ * covariance_xyz(deviation) * enu_from_axes_.transpose();
  return Eigen::Matrix2d(enu.topLeftCorner<2, 2>());
}

void RtklibDecoder::read_velocity(GeodeticFix& fix) {
  const std::size_t first = header_.velocity;
  if (fields_.count() < first + 9) return;
  const Eigen::Vector3d given(number(first, "velocity"), number(first + 1, "velocity"),
                              number(first + 2, "velocity"));
  if (!(given.cwiseAbs().maxCoeff() < 1e5)) complain(first, "velocity: more than 100 km/s");
  const bool north_first =
      header_.layout == RtklibLayout::degrees || header_.layout == RtklibLayout::sexagesimal;
  const Eigen::Vector3d enu =
      north_first ? Eigen::Vector3d(given.y(), given.x(), given.z()) : enu_from_axes_ * given;
  const std::optional<Eigen::Matrix2d> covariance = horizontal(first + 3);
  if (!is_sound()) return;
  set_velocity(fix, enu.head<2>(), covariance ? &*covariance : nullptr);
}

double RtklibDecoder::number(std::size_t field, const char* name) {
  const std::optional<double> value = field_number(fields_[field]);
  if (!value) complain(field, fmt::format("{}: expected a number, got {}", name, quote_word(fields_[field])));
  return value.value_or(0);
}

void RtklibDecoder::complain(std::size_t field, const std::string& what) {
  if (!is_sound()) return;
  column_ = fields_.column(field);
  what_ = what;
}

void RtklibDecoder::end() {
  std::string shares;
  for (std::size_t q = 0; q < qualities_.size(); ++q) {
    if (qualities_[q] == 0) continue;
    data_.kinds[fmt::format("Q{} {}", q, kQualities[q])] = qualities_[q];
    shares += fmt::format("{}{} {}", shares.empty() ? "" : ", ", qualities_[q], kQualities[q]);
  }
  if (!shares.empty()) note("solutions by quality: " + shares);
  if (any_without_names_)
    note(
        "no header names the columns; assumed are latitude, longitude (degrees), height, Q, ns and "
        "deviations, on GPST");
  if (any_above_geoid_) note("heights are above the geoid ('geodetic' in the header)");
  positions_.finish(data_);
}

}  // namespace

std::unique_ptr<LogDecoder> RtklibPosReader::open(const std::string& path, const LogRequest& request) const {
  require_positions(path, request, kPosFormat);
  return std::make_unique<RtklibDecoder>(path, request);
}

Recognition RtklibPosReader::recognise(std::string_view head) const {
  HeadLines lines(head);
  while (lines.next()) {
    if (lines.line().starts_with('%') && RtklibHeader().take(lines.line()))
      return {1, "a header line names the columns of an RTKLIB solution"};
  }
  return {};
}

}  // namespace waymark::formats
