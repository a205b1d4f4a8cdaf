/// Messages RXM-RAWX and RXM-SFRBX made by hand from the interface descriptions: u-blox M8 (UBX-13003221), IS-GPS-200,
/// Galileo OS SIS ICD, BDS-SIS-ICD. The subframes are built bit by bit as satellites send them.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include <waymark/formats/satellites/ephemeris.hpp>

namespace waymark_test {

/// One measurement of RXM-RAWX.
struct RawxMeasurement {
  int system = 0, satellite = 0, signal = 0;  ///< gnssId, svId, sigId
  double pseudorange_m = 0;
  float doppler_hz = 0;
  int cn0_dbhz = 45;
  bool is_valid = true;  ///< prValid
};

[[nodiscard]] std::string rawx_frame(int week, double second_of_week,
                                     const std::vector<RawxMeasurement>& measurements);
/// @param channel of a GLONASS satellite
[[nodiscard]] std::string sfrbx_frame(int system, int satellite, int signal,
                                      const std::vector<std::uint32_t>& words, int channel = 0);

/// Words of a subframe (1 to 3) of GPS, as a u-blox receiver gives them: 30 bits behind the last two of the word before,
/// all of them inverted if the last one is set. @param issue 8 bits; @param week 10 bits
[[nodiscard]] std::vector<std::uint32_t> lnav_subframe(const waymark::formats::satellites::KeplerOrbit& orbit,
                                                       int number, unsigned issue, unsigned week);
/// Page 18 of subframe 4. @param coefficients alpha and beta as they are sent: integers of 8 bits
[[nodiscard]] std::vector<std::uint32_t> lnav_ionosphere_page(const std::array<int, 8>& coefficients);
/// Two page parts with a word (0: time, 1 to 5: ephemeris, 6: UTC, left empty) of Galileo. @param issue 10 bits; @param week of Galileo
[[nodiscard]] std::vector<std::uint32_t> inav_word(const waymark::formats::satellites::KeplerOrbit& orbit,
                                                   int type, unsigned issue, unsigned week);
/// A subframe (1 to 3) of BeiDou's D1. @param second of the week of its begin; @param week of BeiDou
[[nodiscard]] std::vector<std::uint32_t> d1_subframe(const waymark::formats::satellites::KeplerOrbit& orbit,
                                                     int number, unsigned second, unsigned week);
/// A page (1 to 10) of subframe 1 of BeiDou's D2. @param second of the week of its begin; @param week of BeiDou
[[nodiscard]] std::vector<std::uint32_t> d2_page(const waymark::formats::satellites::KeplerOrbit& orbit,
                                                 int page, unsigned second, unsigned week);
/// A string (1 to 5) of GLONASS with its checks. The time of the orbit is a quarter of an hour.
/// @param day of the interval of four years @param interval of four years from 1996
[[nodiscard]] std::vector<std::uint32_t> glonass_string(
    const waymark::formats::satellites::GlonassOrbit& orbit, int number, int day, int interval);

}  // namespace waymark_test
