#include <waymark/formats/logs/detail/common/quantity.hpp>

#include <algorithm>
#include <array>
#include <limits>
#include <numbers>

#include <waymark/core/base/angle.hpp>
#include <waymark/core/base/error.hpp>

namespace waymark::formats {
namespace {

using std::numbers::pi;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

constexpr Unit text_unit(std::string_view name) {
  return {name, 0, UnitForm::text};
}
constexpr std::array kTimes{Unit{"s", 0},        Unit{"ms", -3},      Unit{"us", -6},       Unit{"ns", -9},
                            text_unit(kIso8601), text_unit("dmy"),    text_unit("mdy"),     text_unit("hms"),
                            text_unit("excel"),  text_unit("matlab"), text_unit("filetime")};
constexpr std::array kDates{text_unit(kIso8601), text_unit("dmy"), text_unit("mdy"), text_unit("excel"),
                            text_unit("gps_week")};
constexpr std::array kSpeeds{Unit{"m/s", 1}, Unit{"km/h", 1 / 3.6}, Unit{"mph", 0.44704},
                             Unit{"kn", 1852 / 3600.0}, Unit{"mm/s", 1e-3}};
constexpr std::array kRates{Unit{"rad/s", 1}, Unit{"deg/s", kDegree}};
constexpr std::array kDegrees{
    Unit{"deg", 1},        Unit{"rad", 1 / kDegree},        Unit{"1e-7deg", 1e-7},
    Unit{"min", 1 / 60.0}, Unit{"ddmm", 1, UnitForm::text}, Unit{"dms", 1, UnitForm::text}};
constexpr std::array kLengths{Unit{"m", 1}, Unit{"cm", 1e-2}, Unit{"mm", 1e-3}};
constexpr std::array kSigmas{Unit{"m", 1}, Unit{"cm", 1e-2}, Unit{"mm", 1e-3},
                             Unit{"m^2", 1, UnitForm::square}};
constexpr std::array kCourses{Unit{"deg", kDegree}, Unit{"rad", 1}, Unit{"1e-5deg", 1e-5 * kDegree}};
constexpr std::array kHeadings{Unit{"rad", 1}, Unit{"deg", kDegree}};
constexpr std::array kAccelerations{Unit{"m/s^2", 1}, Unit{"g", 9.80665}};
constexpr std::array kFlags{Unit{"1", 1}};

constexpr std::array kDurations{Unit{"s", 1}, Unit{"ms", 1e-3}, Unit{"us", 1e-6}, Unit{"ns", 1e-9}};
// The numbers of a quality: GGA's, RTKLIB's Q, or those of ROS's NavSatStatus. Words are the same in all.
constexpr std::array kQualityCodes{Unit{"gga", 1}, Unit{"rtklib", 1}, Unit{"ros", 1}};

constexpr std::array kSides{Convention{"positive_east", 1, 0}, Convention{"positive_west", -1, 0}};
constexpr std::array kTurns{Convention{"ccw", 1, 0}, Convention{"cw", -1, 0}};
// A course counts clockwise from north, a heading counter-clockwise from east. Each is pi/2
// minus the other.
constexpr std::array kCourseSenses{Convention{"cw_from_north", 1, 0},
                                   Convention{"ccw_from_east", -1, pi / 2}};
constexpr std::array kHeadingSenses{Convention{"ccw_from_east", 1, 0},
                                    Convention{"cw_from_north", -1, pi / 2}};

// Times and flags are not parsed as bounded numbers. The limits of speed and yaw rate are generous
// for a road vehicle. A number beyond them is garbage or has another unit. Yaw rates may be those of deg/s read as
// rad/s: preparation tells that from garbage, which single records cannot.
constexpr Quantity kTime{"time", "time_s", true, kTimes, {}, -kInfinity, kInfinity};
constexpr Quantity kDate{"date", "", false, kDates, {}, -kInfinity, kInfinity, true};
constexpr Quantity kSpeed{"speed", "speed_mps", true, kSpeeds, {}, -150, 150};
constexpr Quantity kOptionalSpeed{"speed", "speed_mps", false, kSpeeds, {}, -150, 150};
constexpr Quantity kLatitude{"latitude", "latitude_deg", true, kDegrees, {}, -90, 90};
constexpr Quantity kLongitude{"longitude", "longitude_deg", true, kDegrees, kSides, -180, 360};
constexpr Quantity kLatitudeSide{"latitude_hemisphere", "lat_hemisphere", false, kFlags, {}, -1, 1};
constexpr Quantity kLongitudeSide{"longitude_hemisphere", "lon_hemisphere", false, kFlags, {}, -1, 1};
// The frame decides how large coordinates are: its origin may be that of the zone.
constexpr Quantity kEasting{"easting", "easting_m", false, kLengths, {}, -2e7, 2e7};
constexpr Quantity kNorthing{"northing", "northing_m", false, kLengths, {}, -2e7, 2e7};
constexpr Quantity kHeight{"height", "height_m", false, kLengths, {}, -12e3, 100e3};

constexpr std::array kOdometry{kTime, kDate, kSpeed,
                               Quantity{"yaw_rate", "yaw_rate_radps", true, kRates, kTurns, -1200, 1200}};
constexpr std::array kGnss{
    kTime,
    kDate,
    kLatitude,
    kLongitude,
    kLatitudeSide,
    kLongitudeSide,
    kEasting,
    kNorthing,
    kHeight,
    Quantity{"accuracy", "accuracy_m", false, kLengths, {}, -kInfinity, 1e6},
    Quantity{"accuracy_east", "accuracy_east_m", false, kLengths, {}, -kInfinity, 1e6},
    Quantity{"accuracy_north", "accuracy_north_m", false, kLengths, {}, -kInfinity, 1e6},
    Quantity{"sigma_east", "sigma_east_m", false, kSigmas, {}, -kInfinity, 1e6},
    Quantity{"sigma_north", "sigma_north_m", false, kSigmas, {}, -kInfinity, 1e6},
    Quantity{"covariance_en_signed_root", "covariance_en_signed_root_m", false, kSigmas, {}, -1e6, 1e6},
    Quantity{"course", "course_deg", false, kCourses, kCourseSenses, -2 * pi, 2 * pi},
    Quantity{"course_accuracy", "course_accuracy_deg", false, kCourses, {}, -kInfinity, kInfinity},
    kOptionalSpeed,
    Quantity{"speed_accuracy", "speed_accuracy_mps", false, kSpeeds, {}, -kInfinity, kInfinity},
    Quantity{"gnss_time", "gnss_time_s", false, kTimes, {}, -kInfinity, kInfinity},
    Quantity{"valid", "valid_flag", false, kFlags, {}, -kInfinity, kInfinity},
    Quantity{"quality", "fix_quality", false, kQualityCodes, {}, -kInfinity, kInfinity},
    Quantity{"hdop", "HDOP", false, kFlags, {}, -kInfinity, kInfinity},
    Quantity{"satellites", "satellites_used", false, kFlags, {}, -kInfinity, kInfinity},
    Quantity{"correction_age", "correction_age_s", false, kDurations, {}, -kInfinity, kInfinity}};
// References often let the heading run on over full turns.
constexpr std::array kTruth{
    kTime,         kDate,
    kLatitude,     kLongitude,
    kLatitudeSide, kLongitudeSide,
    kEasting,      kNorthing,
    kHeight,       Quantity{"heading", "heading_rad", false, kHeadings, kHeadingSenses, -200 * pi, 200 * pi}};

// What tables give in pieces. They are never found by a default name.
constexpr std::array kFractions{Unit{"s", 0}, Unit{"ms", -3}, Unit{"us", -6}, Unit{"ns", -9}};
constexpr Quantity piece(std::string_view name, std::span<const Unit> units, double largest,
                         std::span<const Convention> conventions = {}) {
  return {name, "", false, units, conventions, -largest, largest, true};
}
constexpr std::array kPieces{piece("time_fraction", kFractions, kInfinity),
                             piece("velocity_east", kSpeeds, 150),
                             piece("velocity_north", kSpeeds, 150),
                             piece("heading_east", kFlags, kInfinity),
                             piece("heading_north", kFlags, kInfinity),
                             piece("quaternion_x", kFlags, kInfinity),
                             piece("quaternion_y", kFlags, kInfinity),
                             piece("quaternion_z", kFlags, kInfinity),
                             piece("quaternion_w", kFlags, kInfinity),
                             piece("distance_step", kLengths, kInfinity),
                             piece("heading_step", kHeadings, kInfinity, kTurns),
                             piece("ecef_x", kLengths, 1e7),
                             piece("ecef_y", kLengths, 1e7),
                             piece("ecef_z", kLengths, 1e7)};

// What a sensor may request: an SI unit, and the sense of an angle or rate (SensorColumn).
struct SensorKind {
  std::string_view unit;
  std::string_view sense;
  std::span<const Unit> units;
  std::span<const Convention> conventions;
  double largest = kInfinity;  ///< what is beyond it no vehicle does
};
constexpr std::array kAngles{Unit{"rad", 1}, Unit{"deg", kDegree}};
// Coordinates of a place: in the frame, of its UTM zone, WGS84, Earth-centred. The last three are converted
// when a drive has its frame (tools/drive/sensors/place_columns.hpp).
constexpr std::array kPlaceX{Unit{"m", 1},       Unit{"cm", 1e-2}, Unit{"mm", 1e-3},
                             Unit{"easting", 1}, Unit{"lon", 1},   Unit{"ecef_x", 1}};
constexpr std::array kPlaceY{Unit{"m", 1},        Unit{"cm", 1e-2}, Unit{"mm", 1e-3},
                             Unit{"northing", 1}, Unit{"lat", 1},   Unit{"ecef_y", 1}};
constexpr std::array kPlaceHeight{Unit{"m", 1}, Unit{"cm", 1e-2}, Unit{"mm", 1e-3}, Unit{"ecef_z", 1}};
constexpr std::array<SensorKind, 14> kSensorKinds{{{"1", "", kFlags, {}},
                                                   {"m", "x", kPlaceX, {}},
                                                   {"m", "y", kPlaceY, {}},
                                                   {"m", "height", kPlaceHeight, {}},
                                                   {"m", "", kLengths, {}},
                                                   {"m/s", "", kSpeeds, {}},
                                                   {"m/s", "body", kSpeeds, {}, kSpeed.largest},
                                                   {"m/s^2", "", kAccelerations, {}},
                                                   {"s", "", kDurations, {}},
                                                   {"rad", "", kAngles, {}},
                                                   {"rad", "ccw_from_east", kHeadings, kHeadingSenses},
                                                   {"rad", "ccw", kHeadings, kTurns},
                                                   {"rad/s", "", kRates, {}},
                                                   {"rad/s", "ccw", kRates, kTurns, 20}}};

template <typename Item>
const Item* find_named(std::span<const Item> items, std::string_view name) {
  for (const Item& item : items) {
    if (item.name == name) return &item;
  }
  return nullptr;
}

Quantity sensor_quantity(const SensorColumn& column) {
  for (const SensorKind& kind : kSensorKinds) {
    if (kind.unit != column.unit || kind.sense != column.sense) continue;
    return {column.name,      column.name,   column.required, kind.units,
            kind.conventions, -kind.largest, kind.largest};
  }
  throw UsageError("sensor column '" + column.name + "': no unit '" + column.unit + "' of sense '" +
                   column.sense + "'; SensorColumn in core/drive/sample.hpp lists all");
}

/// Returns the channels of a stream; none is required. A channel that the stream has as its own
/// quantity is taken from the stream.
std::vector<Quantity> channel_quantities(std::span<const Quantity> stream,
                                         std::span<const SensorColumn> channels) {
  std::vector<Quantity> own{kTime, kDate};
  for (const SensorColumn& channel : channels) {
    const Quantity* whole = find_named(stream, channel.name);
    own.push_back(whole != nullptr ? *whole : sensor_quantity(channel));
    own.back().required = false;
    if (whole != nullptr) continue;
    // One channel that is wrong is no reason to leave out the others of its row.
    own.back().smallest = -kInfinity;
    own.back().largest = kInfinity;
  }
  return own;
}

}  // namespace

std::vector<Quantity> quantities(const LogRequest& request) {
  switch (request.stream) {
    case StreamKind::odometry:
      if (!request.readings.empty()) return channel_quantities(kOdometry, request.readings);
      return {kOdometry.begin(), kOdometry.end()};
    case StreamKind::gnss:
      if (!request.readings.empty()) return channel_quantities(kGnss, request.readings);
      return {kGnss.begin(), kGnss.end()};
    case StreamKind::truth:
      return {kTruth.begin(), kTruth.end()};
    case StreamKind::sensor:
      break;
  }
  std::vector<Quantity> own{kTime};
  // A plugin may mean something else by the word.
  if (std::none_of(request.readings.begin(), request.readings.end(),
                   [](const SensorColumn& column) { return column.name == kDate.name; }))
    own.push_back(kDate);
  for (const SensorColumn& column : request.readings) own.push_back(sensor_quantity(column));
  return own;
}

std::vector<std::string_view> names_of(std::span<const Quantity> quantities) {
  std::vector<std::string_view> names;
  for (const Quantity& quantity : quantities) names.push_back(quantity.name);
  return names;
}

const Quantity* find_quantity(std::span<const Quantity> quantities, std::string_view name) {
  return find_named(quantities, name);
}

const Quantity* find_piece(std::string_view name) {
  return find_named(std::span<const Quantity>(kPieces), name);
}

bool has_size(const Quantity& quantity) {
  constexpr std::array<std::string_view, 3> kMarks{"valid", kLatitudeSide.name, kLongitudeSide.name};
  const Unit* units = quantity.units.data();
  return units != kTimes.data() && units != kFractions.data() && units != kDates.data() &&
         units != kQualityCodes.data() &&
         std::find(kMarks.begin(), kMarks.end(), quantity.name) == kMarks.end();
}

const Unit* find_unit(const Quantity& quantity, std::string_view name) {
  return name.empty() ? &quantity.units.front() : find_named(quantity.units, name);
}

const Convention* find_convention(const Quantity& quantity, std::string_view name) {
  static constexpr Convention kNone{"", 1, 0};
  if (quantity.conventions.empty()) return name.empty() ? &kNone : nullptr;
  return name.empty() ? &quantity.conventions.front() : find_named(quantity.conventions, name);
}

std::string_view to_string(StreamKind stream) {
  switch (stream) {
    case StreamKind::odometry:
      return "odometry";
    case StreamKind::gnss:
      return "gnss";
    case StreamKind::truth:
      return "truth";
    case StreamKind::sensor:
      return "sensor";
  }
  return "gnss";
}

}  // namespace waymark::formats
