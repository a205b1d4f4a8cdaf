/// Constants of the interface specifications of satellite systems.
#pragma once

namespace waymark::formats::satellites {

/// GPS L1 and Galileo E1.
inline constexpr double kL1_hz = 1575.42e6;
inline constexpr double kBeidouB1_hz = 1561.098e6;
inline constexpr double kGlonassG1_hz = 1602e6;
/// Between two channels of GLONASS G1.
inline constexpr double kGlonassStep_hz = 562.5e3;

/// BeiDou's time is behind that of GPS by this.
inline constexpr double kBeidouBehind_s = 14;

/// Satellite systems, by the numbers of libRSF.
enum class System : int { gps = 1, sbas = 2, glonass = 4, galileo = 8, beidou = 32 };

}  // namespace waymark::formats::satellites
