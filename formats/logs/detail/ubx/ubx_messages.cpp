#include <waymark/formats/logs/detail/ubx/ubx_messages.hpp>

#include <array>
#include <bit>
#include <chrono>
#include <cmath>

#include <waymark/core/base/angle.hpp>
#include <waymark/formats/logs/detail/place/geocentric.hpp>

namespace waymark::formats {
namespace {

constexpr unsigned kPvtWithVehicle = 92;  // u-blox 6 and 7 end at 84
constexpr std::uint32_t kNoFigure = 0xFFFFFFFF;

double accuracy(std::uint32_t figure, double units_per_whole) {
  return figure == kNoFigure ? 0 : figure / units_per_whole;
}

/// Reads year to second at `at`. Empty if the date does not exist or is beyond the
/// range of a Stamp.
std::optional<UbxDate> read_date(const UbxPayload& payload, std::size_t at, std::int32_t nanoseconds) {
  const int year = payload.u16(at);
  const std::chrono::year_month_day day{std::chrono::year{year}, std::chrono::month{payload.u8(at + 2)},
                                        std::chrono::day{payload.u8(at + 3)}};
  const int hour = payload.u8(at + 4);
  const int minute = payload.u8(at + 5);
  const int second = payload.u8(at + 6);
  if (year < 1980 || year > 2200 || !day.ok() || hour > 23 || minute > 59 || second > 60) return std::nullopt;
  if (nanoseconds < -1'000'000'000 || nanoseconds > 1'000'000'000) return std::nullopt;
  const std::int64_t days = std::chrono::sys_days{day}.time_since_epoch().count();
  const bool leap = second == 60;
  const std::int64_t seconds = 86400 * days + 3600 * hour + 60 * minute + second - (leap ? 1 : 0);
  return UbxDate{Stamp{seconds * 1'000'000'000 + nanoseconds}, leap, true};
}

/// NAV-PVT and HNR-PVT begin alike: the date is at 4, its flags are at 11.
std::optional<UbxDate> read_solution_date(const UbxPayload& payload, std::size_t nano_at) {
  const unsigned valid = payload.u8(11);
  if ((valid & 3U) != 3U) return std::nullopt;  // validDate, validTime
  std::optional<UbxDate> date = read_date(payload, 4, payload.i32(nano_at));
  if (date) date->resolved = (valid & 4U) != 0;
  return date;
}

/// Longitude, latitude (1e-7 degree) and height (mm) are adjacent.
UbxPlace read_place(const UbxPayload& payload, std::size_t at, std::size_t accuracy_at) {
  UbxPlace place;
  place.longitude_deg = payload.i32(at) / 1e7;
  place.latitude_deg = payload.i32(at + 4) / 1e7;
  place.height_m = payload.i32(at + 8) / 1e3;
  place.accuracy_m = accuracy(payload.u32(accuracy_at), 1e3);
  return place;
}

/// Returns the upper end of the interval that NAV-PVT's lastCorrectionAge (flags3) tells.
double correction_age(unsigned code) {
  constexpr std::array kUpTo_s{0, 1, 2, 5, 10, 15, 20, 30, 45, 60, 90, 120};
  if (code == 0) return std::numeric_limits<double>::quiet_NaN();
  return code < kUpTo_s.size() ? kUpTo_s[code] : 2 * kUpTo_s.back();
}

Eigen::Vector3d read_vector(const UbxPayload& payload, std::size_t at, double units_per_metre) {
  return Eigen::Vector3d(payload.i32(at), payload.i32(at + 4), payload.i32(at + 8)) / units_per_metre;
}

}  // namespace

double UbxPayload::f32(std::size_t at) const {
  static_assert(sizeof(float) == sizeof(std::uint32_t));
  return std::bit_cast<float>(u32(at));
}

double UbxPayload::f64(std::size_t at) const {
  static_assert(sizeof(double) == sizeof(std::uint64_t));
  return std::bit_cast<double>(u32(at) | static_cast<std::uint64_t>(u32(at + 4)) << 32U);
}

std::size_t least_ubx_length(std::uint16_t key) {
  switch (key) {
    case ubx::kNavPosecef:
    case ubx::kNavVelecef:
      return 20;
    case ubx::kNavDop:
      return 18;
    case ubx::kNavPosllh:
      return 28;
    case ubx::kNavStatus:
      return 16;
    case ubx::kNavSol:
      return 52;
    case ubx::kNavPvt:
      return 84;
    case ubx::kNavVelned:
      return 36;
    case ubx::kNavHpposllh:
      return 36;
    case ubx::kNavTimegps:
      return 16;
    case ubx::kNavTimeutc:
      return 20;
    case ubx::kNavCov:
      return 64;
    case ubx::kNavEoe:
      return 4;
    case ubx::kEsfMeas:
      return 8;
    case ubx::kHnrPvt:
      return 72;
    default:
      return 0;
  }
}

std::uint32_t ubx_itow(std::uint16_t key, const UbxPayload& payload) {
  return payload.u32(key == ubx::kNavHpposllh ? 4 : 0);
}

UbxSolution read_nav_pvt(const UbxPayload& payload) {
  UbxSolution solution;
  solution.date = read_solution_date(payload, 16);
  const unsigned flags = payload.u8(21);
  const bool has_vehicle = payload.size() >= kPvtWithVehicle;
  const bool invalid_place = has_vehicle && (payload.u8(78) & 1U) != 0;
  solution.state = {
      payload.u8(20),      (flags & 1U) != 0 && !invalid_place,
      (flags & 2U) != 0,   static_cast<int>(flags >> 6U),
      int{payload.u8(23)}, has_vehicle ? correction_age(payload.u8(78) >> 1U & 15U) : correction_age(0)};
  solution.place = read_place(payload, 24, 40);
  solution.motion.speed_mps = payload.i32(60) / 1e3;
  solution.motion.course_deg = payload.i32(64) / 1e5;
  solution.motion.speed_accuracy_mps = accuracy(payload.u32(68), 1e3);
  solution.motion.course_accuracy_deg = accuracy(payload.u32(72), 1e5);
  if (has_vehicle && (flags & 0x20U) != 0) solution.vehicle_heading_deg = payload.i32(84) / 1e5;
  return solution;
}

UbxSolution read_hnr_pvt(const UbxPayload& payload) {
  UbxSolution solution;
  solution.date = read_solution_date(payload, 12);
  const unsigned flags = payload.u8(17);
  solution.state = {.type = payload.u8(16), .ok = (flags & 1U) != 0, .differential = (flags & 2U) != 0};
  solution.place = read_place(payload, 20, 52);
  solution.motion.speed_mps = payload.i32(36) / 1e3;
  solution.motion.course_deg = payload.i32(44) / 1e5;
  solution.motion.speed_accuracy_mps = accuracy(payload.u32(60), 1e3);
  solution.motion.course_accuracy_deg = accuracy(payload.u32(64), 1e5);
  if ((flags & 0x10U) != 0) solution.vehicle_heading_deg = payload.i32(48) / 1e5;
  return solution;
}

UbxPlace read_nav_posllh(const UbxPayload& payload) {
  return read_place(payload, 4, 20);
}

std::optional<UbxPlace> read_nav_hpposllh(const UbxPayload& payload) {
  if (payload.u8(3) != 0) return std::nullopt;
  const auto finer = [&](std::size_t at, std::size_t fine_at, int steps) {
    return static_cast<double>(std::int64_t{payload.i32(at)} * steps + payload.i8(fine_at));
  };
  UbxPlace place;
  place.longitude_deg = finer(8, 24, 100) / 1e9;
  place.latitude_deg = finer(12, 25, 100) / 1e9;
  place.height_m = finer(16, 26, 10) / 1e4;
  place.accuracy_m = accuracy(payload.u32(28), 1e4);
  return place;
}

std::optional<UbxEcef> read_ubx_ecef(std::uint16_t key, const UbxPayload& payload) {
  const bool is_sol = key == ubx::kNavSol;
  const UbxEcef position{read_vector(payload, is_sol ? 12 : 4, 1e2),
                         accuracy(payload.u32(is_sol ? 24 : 16), 1e2)};
  constexpr double kLeast_m = 6.2e6;
  constexpr double kMost_m = 7.5e6;
  const double squared = position.vector.squaredNorm();
  if (!(squared > kLeast_m * kLeast_m && squared < kMost_m * kMost_m)) return std::nullopt;
  return position;
}

UbxEcef read_ubx_ecef_velocity(std::uint16_t key, const UbxPayload& payload) {
  const bool is_sol = key == ubx::kNavSol;
  return {read_vector(payload, is_sol ? 28 : 4, 1e2), accuracy(payload.u32(is_sol ? 40 : 16), 1e2)};
}

UbxPlace ubx_place(const UbxEcef& position) {
  const GeodeticPlace geodetic = geodetic_from_ecef(position.vector);
  return {geodetic.latitude_deg, geodetic.longitude_deg, geodetic.height_m, position.accuracy};
}

UbxMotion ubx_motion(const UbxEcef& velocity, const UbxPlace& place) {
  const Eigen::Vector3d enu = enu_from_ecef(place.latitude_deg, place.longitude_deg) * velocity.vector;
  UbxMotion motion;
  motion.speed_mps = enu.head<2>().norm();
  motion.speed_accuracy_mps = velocity.accuracy;
  motion.course_deg = std::atan2(enu.x(), enu.y()) / kDegree;
  // Across the course the velocity is as uncertain as along it.
  if (motion.speed_mps > motion.speed_accuracy_mps)
    motion.course_accuracy_deg = std::atan2(motion.speed_accuracy_mps, motion.speed_mps) / kDegree;
  return motion;
}

double read_nav_dop(const UbxPayload& payload) {
  constexpr double kNoDop = 99;  // 99.99: not known
  const double hdop = payload.u16(12) / 1e2;
  return hdop < kNoDop ? hdop : 0;
}

UbxMotion read_nav_velned(const UbxPayload& payload) {
  UbxMotion motion;
  motion.speed_mps = payload.u32(20) / 1e2;
  motion.course_deg = payload.i32(24) / 1e5;
  motion.speed_accuracy_mps = accuracy(payload.u32(28), 1e2);
  motion.course_accuracy_deg = accuracy(payload.u32(32), 1e5);
  return motion;
}

std::optional<UbxDate> read_nav_timeutc(const UbxPayload& payload) {
  if ((payload.u8(19) & 4U) == 0) return std::nullopt;  // validUTC
  return read_date(payload, 12, payload.i32(8));
}

std::optional<UbxWeek> read_ubx_week(std::uint16_t key, const UbxPayload& payload) {
  const unsigned both = key == ubx::kNavSol ? 0x0CU : 0x03U;  // WKNSET, TOWSET; towValid, weekValid
  const UbxWeek week{payload.i16(8), payload.i32(4)};
  // The fraction of NAV-SOL is at most half a millisecond, and so is that of NAV-TIMEGPS.
  const bool sensible =
      week.week > 0 && week.week <= 10'000 && week.fraction_ns >= -500'000 && week.fraction_ns <= 500'000;
  if ((payload.u8(11) & both) != both || !sensible) return std::nullopt;
  return week;
}

UbxFixState read_ubx_state(std::uint16_t key, const UbxPayload& payload) {
  const bool is_sol = key == ubx::kNavSol;
  const std::size_t at = is_sol ? 10 : 4;
  const unsigned flags = payload.u8(at + 1);
  return {.type = payload.u8(at),
          .ok = (flags & 1U) != 0,
          .differential = (flags & 2U) != 0,
          .carrier = is_sol ? 0 : payload.u8(7) >> 6U,  // flags2, since protocol 27; zero before
          .satellites = is_sol ? int{payload.u8(47)} : -1};
}

std::optional<Eigen::Matrix2d> read_nav_cov(const UbxPayload& payload) {
  if (payload.u8(5) == 0) return std::nullopt;  // posCovValid
  const double north = payload.f32(16);
  const double north_east = payload.f32(20);
  const double east = payload.f32(28);
  Eigen::Matrix2d covariance;
  covariance << east, north_east, north_east, north;
  return covariance;
}

}  // namespace waymark::formats
