#include <bit>

#include <waymark/formats/logs/detail/common/gps_time.hpp>
#include <waymark/formats/satellites/broadcast/broadcast_messages.hpp>

namespace waymark::formats::satellites {
namespace {

constexpr std::uint32_t kLnavPreamble = 0x8B;
constexpr std::size_t kParityBits = 6;
constexpr std::size_t kDataBits = 24;

/// A satellite's page number of the ionosphere in subframe 4.
constexpr std::uint32_t kIonospherePage = 56;

KlobucharCoefficients lnav_ionosphere(const MessageBits& page) {
  return {
      {page.scaled(56, 8, -30), page.scaled(64, 8, -27), page.scaled(72, 8, -24), page.scaled(80, 8, -24)},
      {page.scaled(88, 8, 11), page.scaled(96, 8, 14), page.scaled(104, 8, 16), page.scaled(112, 8, 16)}};
}

KeplerOrbit lnav_orbit(int satellite, const MessageParts<3>& message, Stamp near) {
  const MessageBits& clock = *message.parts[0];
  const MessageBits& first = *message.parts[1];
  const MessageBits& second = *message.parts[2];
  KeplerOrbit orbit;
  orbit.system = System::gps;
  orbit.number = satellite;
  orbit.is_healthy = clock.whole(64, 6) == 0;
  orbit.group_delay_s = clock.scaled(160, 8, -31);
  orbit.toc = in_nearest_week(near, clock.positive(176, 16, 4));
  orbit.clock_drift_rate_1_s = clock.scaled(192, 8, -55);
  orbit.clock_drift = clock.scaled(200, 16, -43);
  orbit.clock_bias_s = clock.scaled(216, 22, -31);
  orbit.crs = first.scaled(56, 16, -5);
  orbit.mean_motion_difference_radps = kSemicircle_rad * first.scaled(72, 16, -43);
  orbit.mean_anomaly_rad = kSemicircle_rad * first.scaled(88, 32, -31);
  orbit.cuc = first.scaled(120, 16, -29);
  orbit.eccentricity = first.positive(136, 32, -33);
  orbit.cus = first.scaled(168, 16, -29);
  orbit.sqrt_a = first.positive(184, 32, -19);
  orbit.toe_sow_s = first.positive(216, 16, 4);
  orbit.toe = in_nearest_week(near, orbit.toe_sow_s);
  orbit.cic = second.scaled(48, 16, -29);
  orbit.node_rad = kSemicircle_rad * second.scaled(64, 32, -31);
  orbit.cis = second.scaled(96, 16, -29);
  orbit.inclination_rad = kSemicircle_rad * second.scaled(112, 32, -31);
  orbit.crc = second.scaled(144, 16, -5);
  orbit.perigee_rad = kSemicircle_rad * second.scaled(160, 32, -31);
  orbit.node_rate_radps = kSemicircle_rad * second.scaled(192, 24, -43);
  orbit.inclination_rate_radps = kSemicircle_rad * second.scaled(224, 14, -43);
  return orbit;
}

}  // namespace

bool lnav_parity_is_right(std::uint32_t word) {
  // Which of the 24 data bits, the first one highest, enter each parity bit.
  constexpr std::array<std::uint32_t, kParityBits> kMasks{0xEC7CD2, 0x763E69, 0xBB1F34,
                                                          0x5D8F9A, 0xAEC7CD, 0x2DEA27};
  const std::uint32_t data = word >> kParityBits & 0xFFFFFF;
  std::uint32_t parity = 0;
  for (const std::uint32_t mask : kMasks)
    parity = parity << 1U | (static_cast<std::uint32_t>(std::popcount(data & mask)) & 1U);
  // Once the inversion is undone, only the last but one bit of the word before still enters: into bits 1, 3 and 6.
  constexpr std::uint32_t kBitBefore = 0b101001;
  const std::uint32_t sent = word & 0x3F;
  return sent == parity || sent == (parity ^ kBitBefore);
}

LnavMessages::Found LnavMessages::take(int satellite, std::span<const std::uint32_t, 10> words, Stamp near,
                                       Ephemerides& ephemerides) {
  MessageBits subframe;
  for (const std::uint32_t word : words) {
    if (!lnav_parity_is_right(word)) return Found::wrong_parity;
    subframe.append(word >> kParityBits, kDataBits);
  }
  if (subframe.whole(0, 8) != kLnavPreamble) return Found::nothing;
  const std::uint32_t number = subframe.whole(43, 3);
  if (number == 4 && subframe.whole(50, 6) == kIonospherePage) {
    ephemerides.ionosphere = lnav_ionosphere(subframe);
    return Found::ionosphere;
  }
  if (number < 1 || number > 3) return Found::nothing;
  MessageParts<3>& message = satellites_[satellite];
  message.parts[number - 1] = subframe;
  if (!message.is_complete()) return Found::nothing;
  const MessageBits& clock = *message.parts[0];
  const std::uint32_t issue = clock.whole(168, 8);  // the lower bits of IODC; IODE is the same
  if (message.parts[1]->whole(48, 8) != issue || message.parts[2]->whole(216, 8) != issue)
    return Found::nothing;
  // The issue is the same again after hours, and the health changes without a new one.
  const std::uint64_t key =
      std::uint64_t{message.parts[1]->whole(216, 16)} << 32U | clock.whole({64, 6}, {70, 2}) << 8U | issue;
  return message.give(lnav_orbit(satellite, message, near), key, ephemerides) ? Found::ephemeris
                                                                              : Found::nothing;
}

}  // namespace waymark::formats::satellites
