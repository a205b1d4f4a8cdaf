/// The UBX messages that are read: layouts, units and flags as in the interface descriptions of
/// u-blox (M8: UBX-13003221, F9: UBX-18010854).
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string_view>

#include <Eigen/Core>

#include <waymark/core/drive/stamp.hpp>

namespace waymark::formats {

/// Keys (class * 256 + id) of the messages that are read.
namespace ubx {
inline constexpr std::uint16_t kNavPosecef = 0x0101;
inline constexpr std::uint16_t kNavPosllh = 0x0102;
inline constexpr std::uint16_t kNavStatus = 0x0103;
inline constexpr std::uint16_t kNavDop = 0x0104;
inline constexpr std::uint16_t kNavSol = 0x0106;
inline constexpr std::uint16_t kNavPvt = 0x0107;
inline constexpr std::uint16_t kNavVelecef = 0x0111;
inline constexpr std::uint16_t kNavVelned = 0x0112;
inline constexpr std::uint16_t kNavHpposllh = 0x0114;
inline constexpr std::uint16_t kNavTimegps = 0x0120;
inline constexpr std::uint16_t kNavTimeutc = 0x0121;
inline constexpr std::uint16_t kNavCov = 0x0136;
inline constexpr std::uint16_t kNavEoe = 0x0161;
inline constexpr std::uint16_t kRxmSfrbx = 0x0213;
inline constexpr std::uint16_t kRxmRawx = 0x0215;
inline constexpr std::uint16_t kEsfMeas = 0x1002;
inline constexpr std::uint16_t kHnrPvt = 0x2800;
}  // namespace ubx

/// Returns the shortest legal payload of a message that is read, and 0 for all others.
[[nodiscard]] std::size_t least_ubx_length(std::uint16_t key);

/// Reads little-endian numbers of a payload, byte by byte, because a payload is not aligned.
/// Offsets lie within the payload: least_ubx_length is checked before.
class UbxPayload {
 public:
  explicit UbxPayload(std::string_view bytes) : bytes_(bytes) {}
  [[nodiscard]] std::uint8_t u8(std::size_t at) const { return static_cast<std::uint8_t>(bytes_[at]); }
  [[nodiscard]] std::int8_t i8(std::size_t at) const { return static_cast<std::int8_t>(u8(at)); }
  [[nodiscard]] std::uint16_t u16(std::size_t at) const {
    return static_cast<std::uint16_t>(u8(at) | u8(at + 1) << 8U);
  }
  [[nodiscard]] std::int16_t i16(std::size_t at) const { return static_cast<std::int16_t>(u16(at)); }
  [[nodiscard]] std::uint32_t u32(std::size_t at) const {
    return u16(at) | static_cast<std::uint32_t>(u16(at + 2)) << 16U;
  }
  [[nodiscard]] std::int32_t i32(std::size_t at) const { return static_cast<std::int32_t>(u32(at)); }
  [[nodiscard]] double f32(std::size_t at) const;
  [[nodiscard]] double f64(std::size_t at) const;
  [[nodiscard]] std::size_t size() const { return bytes_.size(); }

 private:
  std::string_view bytes_;
};

/// A date that the receiver marks as valid.
struct UbxDate {
  Stamp utc;                 ///< POSIX; second 60 is given as 59 with `leap_second`
  bool leap_second = false;  ///< one second later than `utc`
  bool resolved = true;      ///< false: its seconds may still be wrong by leap seconds
};

/// A position.
struct UbxPlace {
  double latitude_deg = 0;
  double longitude_deg = 0;
  double height_m = 0;    ///< above the ellipsoid
  double accuracy_m = 0;  ///< hAcc; 0: none
};

/// Motion over ground. Accuracies are read as one sigma; 0: none.
struct UbxMotion {
  double speed_mps = 0;
  double speed_accuracy_mps = 0;
  double course_deg = 0;  ///< clockwise from true north
  double course_accuracy_deg = 0;
};

/// A position or a velocity in Earth-centred axes, m or m/s.
struct UbxEcef {
  Eigen::Vector3d vector{0, 0, 0};
  double accuracy = 0;  ///< of all three dimensions; 0: none
};

/// The state of a fix.
struct UbxFixState {
  /// 0 none, 1 dead reckoning, 2 2D, 3 3D, 4 GNSS and dead reckoning, 5 time only
  int type = 0;
  bool ok = false;            ///< within the receiver's limits (gnssFixOK)
  bool differential = false;  ///< diffSoln
  int carrier = 0;            ///< carrSoln: 1 float, 2 fixed
  int satellites = -1;        ///< numSV; -1: not told
  /// upper end of the interval that lastCorrectionAge tells; NaN: not told, or no corrections
  double correction_age_s = std::numeric_limits<double>::quiet_NaN();

  [[nodiscard]] bool usable() const { return ok && type >= 1 && type <= 4; }
};

/// NAV-PVT or HNR-PVT.
struct UbxSolution {
  std::optional<UbxDate> date;
  UbxFixState state;
  UbxPlace place;
  UbxMotion motion;
  std::optional<double> vehicle_heading_deg;  ///< clockwise from true north, if its flag says valid
};

/// A GPS week, and the sub-millisecond rest of iTOW.
struct UbxWeek {
  int week = 0;
  std::int32_t fraction_ns = 0;
};

[[nodiscard]] std::uint32_t ubx_itow(std::uint16_t key, const UbxPayload& payload);
[[nodiscard]] UbxSolution read_nav_pvt(const UbxPayload& payload);
[[nodiscard]] UbxSolution read_hnr_pvt(const UbxPayload& payload);
[[nodiscard]] UbxPlace read_nav_posllh(const UbxPayload& payload);
/// Returns nothing if the message is marked invalid.
[[nodiscard]] std::optional<UbxPlace> read_nav_hpposllh(const UbxPayload& payload);
/// Reads the position of NAV-POSECEF or NAV-SOL. Empty if the point is not near the surface of the Earth:
/// receivers without a fix write zeros.
[[nodiscard]] std::optional<UbxEcef> read_ubx_ecef(std::uint16_t key, const UbxPayload& payload);
/// Reads the velocity of NAV-VELECEF or NAV-SOL.
[[nodiscard]] UbxEcef read_ubx_ecef_velocity(std::uint16_t key, const UbxPayload& payload);
/// Converts them, which takes longer than to read them.
[[nodiscard]] UbxPlace ubx_place(const UbxEcef& position);
/// @param place where the receiver is
[[nodiscard]] UbxMotion ubx_motion(const UbxEcef& velocity, const UbxPlace& place);
/// Returns the horizontal dilution of precision; 0: not known.
[[nodiscard]] double read_nav_dop(const UbxPayload& payload);
[[nodiscard]] UbxMotion read_nav_velned(const UbxPayload& payload);
[[nodiscard]] std::optional<UbxDate> read_nav_timeutc(const UbxPayload& payload);
/// Reads NAV-SOL or NAV-TIMEGPS. Empty if week or time of week is not valid.
[[nodiscard]] std::optional<UbxWeek> read_ubx_week(std::uint16_t key, const UbxPayload& payload);
/// Reads NAV-SOL or NAV-STATUS.
[[nodiscard]] UbxFixState read_ubx_state(std::uint16_t key, const UbxPayload& payload);
/// Reads the horizontal covariance, axes east, north, in m^2. Empty if its flag says invalid. It is
/// not checked for being positive definite.
[[nodiscard]] std::optional<Eigen::Matrix2d> read_nav_cov(const UbxPayload& payload);

}  // namespace waymark::formats
