#include <initializer_list>

#include <waymark/formats/logs/detail/common/gps_time.hpp>
#include <waymark/formats/satellites/broadcast/beidou_subframe.hpp>
#include <waymark/formats/satellites/broadcast/broadcast_messages.hpp>

namespace waymark::formats::satellites {
namespace {

constexpr std::uint32_t kSecondsOfPage = 3;

using D2Parts = MessageParts<10>;

/// Bits of one page, 1 to 10.
struct PageRange {
  std::size_t page = 1;
  std::size_t begin = 0;
  std::size_t width = 0;
};

/// The bits of a number, the highest ones first. Pages and parities part them.
MessageBits joined(const D2Parts& message, std::initializer_list<PageRange> ranges) {
  MessageBits bits;
  for (const PageRange& range : ranges)
    bits.append(message.parts[range.page - 1]->whole(range.begin, range.width), range.width);
  return bits;
}

double scaled(const D2Parts& message, std::initializer_list<PageRange> ranges, int exponent) {
  const MessageBits bits = joined(message, ranges);
  return bits.scaled(0, bits.size(), exponent);
}

double positive(const D2Parts& message, std::initializer_list<PageRange> ranges, int exponent) {
  const MessageBits bits = joined(message, ranges);
  return bits.positive(0, bits.size(), exponent);
}

void add_clock(const D2Parts& message, Stamp near_of_beidou, KeplerOrbit& orbit) {
  constexpr double kTenth_ns = 1e-10;
  orbit.is_healthy = message.parts[0]->whole(46, 1) == 0;
  orbit.toc =
      in_nearest_week(near_of_beidou, positive(message, {{1, 77, 5}, {1, 90, 12}}, 3)).later(kBeidouBehind_s);
  orbit.group_delay_s = kTenth_ns * scaled(message, {{1, 102, 10}}, 0);
  orbit.clock_bias_s = scaled(message, {{3, 100, 12}, {3, 120, 12}}, -33);
  orbit.clock_drift = scaled(message, {{3, 132, 4}, {4, 46, 6}, {4, 60, 12}}, -50);
  orbit.clock_drift_rate_1_s = scaled(message, {{4, 72, 10}, {4, 90, 1}}, -66);
}

KeplerOrbit d2_orbit(int satellite, const D2Parts& message, Stamp near) {
  const Stamp near_of_beidou = near.later(-kBeidouBehind_s);
  KeplerOrbit orbit;
  orbit.system = System::beidou;
  orbit.number = satellite;
  add_clock(message, near_of_beidou, orbit);
  orbit.mean_motion_difference_radps = kSemicircle_rad * scaled(message, {{4, 96, 16}}, -43);
  orbit.cuc = scaled(message, {{4, 120, 14}, {5, 46, 4}}, -31);
  orbit.mean_anomaly_rad = kSemicircle_rad * scaled(message, {{5, 50, 2}, {5, 60, 22}, {5, 90, 8}}, -31);
  orbit.cus = scaled(message, {{5, 98, 14}, {5, 120, 4}}, -31);
  orbit.eccentricity = positive(message, {{5, 124, 10}, {6, 46, 6}, {6, 60, 16}}, -33);
  orbit.sqrt_a = positive(message, {{6, 76, 6}, {6, 90, 22}, {6, 120, 4}}, -19);
  orbit.cic = scaled(message, {{6, 124, 10}, {7, 46, 6}, {7, 60, 2}}, -31);
  orbit.cis = scaled(message, {{7, 62, 18}}, -31);
  orbit.toe_sow_s = positive(message, {{7, 80, 2}, {7, 90, 15}}, 3);
  orbit.toe = in_nearest_week(near_of_beidou, orbit.toe_sow_s).later(kBeidouBehind_s);
  orbit.inclination_rad =
      kSemicircle_rad * scaled(message, {{7, 105, 7}, {7, 120, 14}, {8, 46, 6}, {8, 60, 5}}, -31);
  orbit.crc = scaled(message, {{8, 65, 17}, {8, 90, 1}}, -6);
  orbit.crs = scaled(message, {{8, 91, 18}}, -6);
  orbit.node_rate_radps = kSemicircle_rad * scaled(message, {{8, 109, 3}, {8, 120, 16}, {9, 46, 5}}, -43);
  orbit.node_rad = kSemicircle_rad * scaled(message, {{9, 51, 1}, {9, 60, 22}, {9, 90, 9}}, -31);
  orbit.perigee_rad = kSemicircle_rad * scaled(message, {{9, 99, 13}, {9, 120, 14}, {10, 46, 5}}, -31);
  orbit.inclination_rate_radps = kSemicircle_rad * scaled(message, {{10, 51, 1}, {10, 60, 13}}, -43);
  return orbit;
}

}  // namespace

bool D2Messages::take(int satellite, std::span<const std::uint32_t, 10> words, Stamp near,
                      Ephemerides& ephemerides) {
  const std::optional<MessageBits> subframe = beidou_subframe(words);
  if (!subframe) return false;
  const std::uint32_t page = subframe->whole(42, 4);
  if (subframe->whole(15, 3) != 1 || page < 1 || page > 10) return false;
  D2Parts& message = satellites_[satellite];
  message.parts[page - 1] = *subframe;
  if (!message.is_complete()) return false;
  // Pages belong together if they follow one another.
  for (std::uint32_t i = 1; i < 10; ++i)
    if (second_of_week(*message.parts[i]) != second_of_week(*message.parts[0]) + kSecondsOfPage * i)
      return false;
  const KeplerOrbit orbit = d2_orbit(satellite, message, near);
  const std::uint64_t key = static_cast<std::uint64_t>(orbit.toe_sow_s) << 32U |
                            message.parts[0]->whole(46, 6) << 8U | message.parts[3]->whole(91, 5);
  return message.give(orbit, key, ephemerides);
}

}  // namespace waymark::formats::satellites
