#include <waymark/formats/logs/detail/common/gps_time.hpp>
#include <waymark/formats/satellites/broadcast/beidou_subframe.hpp>
#include <waymark/formats/satellites/broadcast/broadcast_messages.hpp>

namespace waymark::formats::satellites {
namespace {

/// The two parts of the time of ephemeris stand in the subframes 2 and 3, in units of 8 s.
double d1_toe(const MessageParts<3>& message) {
  const std::uint32_t high = message.parts[1]->whole(290, 2);
  return 8.0 * (high << 15U | message.parts[2]->whole({42, 10}, {60, 5}));
}

KeplerOrbit d1_orbit(int satellite, const MessageParts<3>& message, Stamp near) {
  const MessageBits& clock = *message.parts[0];
  const MessageBits& first = *message.parts[1];
  const MessageBits& second = *message.parts[2];
  constexpr double kTenth_ns = 1e-10;
  const Stamp near_of_beidou = near.later(-kBeidouBehind_s);
  KeplerOrbit orbit;
  orbit.system = System::beidou;
  orbit.number = satellite;
  orbit.is_healthy = clock.whole(42, 1) == 0;
  orbit.toc = in_nearest_week(near_of_beidou, 8.0 * clock.whole({73, 9}, {90, 8})).later(kBeidouBehind_s);
  orbit.group_delay_s = kTenth_ns * clock.scaled(98, 10, 0);
  orbit.clock_drift_rate_1_s = clock.scaled(214, 11, -66);
  orbit.clock_bias_s = clock.scaled({225, 7}, {240, 17}, -33);
  orbit.clock_drift = clock.scaled({257, 5}, {270, 17}, -50);
  orbit.mean_motion_difference_radps = kSemicircle_rad * first.scaled({42, 10}, {60, 6}, -43);
  orbit.cuc = first.scaled({66, 16}, {90, 2}, -31);
  orbit.mean_anomaly_rad = kSemicircle_rad * first.scaled({92, 20}, {120, 12}, -31);
  orbit.eccentricity = std::ldexp(first.whole({132, 10}, {150, 22}), -33);
  orbit.cus = first.scaled(180, 18, -31);
  orbit.crc = first.scaled({198, 4}, {210, 14}, -6);
  orbit.crs = first.scaled({224, 8}, {240, 10}, -6);
  orbit.sqrt_a = std::ldexp(first.whole({250, 12}, {270, 20}), -19);
  orbit.toe_sow_s = d1_toe(message);
  orbit.toe = in_nearest_week(near_of_beidou, orbit.toe_sow_s).later(kBeidouBehind_s);
  orbit.inclination_rad = kSemicircle_rad * second.scaled({65, 17}, {90, 15}, -31);
  orbit.cic = second.scaled({105, 7}, {120, 11}, -31);
  orbit.node_rate_radps = kSemicircle_rad * second.scaled({131, 11}, {150, 13}, -43);
  orbit.cis = second.scaled({163, 9}, {180, 9}, -31);
  orbit.inclination_rate_radps = kSemicircle_rad * second.scaled({189, 13}, {210, 1}, -43);
  orbit.node_rad = kSemicircle_rad * second.scaled({211, 21}, {240, 11}, -31);
  orbit.perigee_rad = kSemicircle_rad * second.scaled({251, 11}, {270, 21}, -31);
  return orbit;
}

}  // namespace

bool D1Messages::take(int satellite, std::span<const std::uint32_t, 10> words, Stamp near,
                      Ephemerides& ephemerides) {
  const std::optional<MessageBits> subframe = beidou_subframe(words);
  if (!subframe) return false;
  const std::uint32_t number = subframe->whole(15, 3);
  if (number < 1 || number > 3) return false;
  MessageParts<3>& message = satellites_[satellite];
  message.parts[number - 1] = *subframe;
  if (!message.is_complete()) return false;
  // D1 names no issue in the subframes 2 and 3: they belong together if they follow one another, 6 s apart.
  const std::uint32_t begin = second_of_week(*message.parts[0]);
  if (second_of_week(*message.parts[1]) != begin + 6 || second_of_week(*message.parts[2]) != begin + 12)
    return false;
  const KeplerOrbit orbit = d1_orbit(satellite, message, near);
  const std::uint64_t key = static_cast<std::uint64_t>(orbit.toe_sow_s) << 32U |
                            message.parts[0]->whole(42, 6) << 8U | message.parts[0]->whole(287, 5);
  return message.give(orbit, key, ephemerides);
}

}  // namespace waymark::formats::satellites
