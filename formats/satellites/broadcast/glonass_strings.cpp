#include <cmath>

#include <waymark/formats/logs/detail/common/gps_time.hpp>
#include <waymark/formats/satellites/broadcast/broadcast_messages.hpp>

namespace waymark::formats::satellites {
namespace {

constexpr std::size_t kBits = 85;
constexpr std::size_t kChecks = 8;

/// The ICD numbers the bits of a string from 85, which is sent first, down to 1.
constexpr std::size_t place_of(std::size_t bit) {
  return kBits - bit;
}

/// A number whose first bit is its sign, in units of 2^exponent. @param first the highest bit, by the ICD
double scaled(const MessageBits& text, std::size_t first, std::size_t width, int exponent) {
  const double size = std::ldexp(text.whole(place_of(first) + 1, width - 1), exponent);
  return text.whole(place_of(first), 1) != 0 ? -size : size;
}

std::uint32_t whole(const MessageBits& text, std::size_t first, std::size_t width) {
  return text.whole(place_of(first), width);
}

/// The code of Hamming (GLONASS ICD 5.1, 4.7): the bits from 9 on stand at the places 3, 5, 6, 7, 9, ... that are no
/// powers of two. The bits 1 to 7 are the exclusive or of the places with a one; bit 8 makes the number of ones even.
bool checksum_is_right(const MessageBits& text) {
  std::uint32_t places = 0;
  std::uint32_t ones = 0;
  std::uint32_t place = 2;
  for (std::size_t bit = kChecks + 1; bit <= kBits; ++bit) {
    ++place;
    if ((place & (place - 1)) == 0) ++place;
    if (whole(text, bit, 1) == 0) continue;
    places ^= place;
    ++ones;
  }
  for (std::size_t bit = 1; bit <= kChecks; ++bit) {
    const std::uint32_t sent = whole(text, bit, 1);
    if (bit < kChecks) places ^= sent << (bit - 1);
    ones += sent;
  }
  return places == 0 && ones % 2 == 0;
}

/// The time of an ephemeris: quarters of an hour of a day of Moscow, the day nearest to a time. Both on the GPS scale.
Stamp time_of(std::uint32_t quarters, Stamp near) {
  constexpr double kMoscowAhead_s = 10'800;
  constexpr double kQuarter_s = 900;
  constexpr double kDayOfMoscow_s = 86'400;
  const Stamp moscow = convert(near, TimeScale::gps, TimeScale::utc).later(kMoscowAhead_s);
  const Stamp midnight{moscow.nanoseconds - moscow.nanoseconds % kDayNanoseconds};
  Stamp moment = midnight.later(kQuarter_s * quarters);
  const double ahead_s = seconds_between(moscow, moment);
  if (std::abs(ahead_s) > kDayOfMoscow_s / 2) moment = moment.later(std::copysign(kDayOfMoscow_s, -ahead_s));
  return convert(moment.later(-kMoscowAhead_s), TimeScale::utc, TimeScale::gps);
}

GlonassOrbit orbit_of(int satellite, int channel, const MessageParts<4>& message, Stamp near) {
  constexpr double kKilometre_m = 1000;
  GlonassOrbit orbit;
  orbit.number = satellite;
  orbit.channel = channel;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    const MessageBits& text = *message.parts[static_cast<std::size_t>(axis)];
    orbit.velocity[axis] = kKilometre_m * scaled(text, 64, 24, -20);
    orbit.acceleration[axis] = kKilometre_m * scaled(text, 40, 5, -30);
    orbit.position[axis] = kKilometre_m * scaled(text, 35, 27, -11);
  }
  const MessageBits& second = *message.parts[1];
  constexpr std::uint32_t kMalfunction = 4;  // the first of the three bits B
  orbit.is_healthy = (whole(second, 80, 3) & kMalfunction) == 0;
  orbit.toe = time_of(whole(second, 76, 7), near);
  orbit.clock_drift = scaled(*message.parts[2], 79, 11, -40);
  orbit.clock_bias_s = -scaled(*message.parts[3], 80, 22, -30);
  return orbit;
}

}  // namespace

GlonassStrings::Found GlonassStrings::take(int satellite, int channel,
                                           std::span<const std::uint32_t, 4> words, Stamp near,
                                           Ephemerides& ephemerides) {
  MessageBits text;
  for (const std::uint32_t word : words) text.append(word, 32);
  if (!checksum_is_right(text)) return Found::wrong_checksum;
  const std::uint32_t number = whole(text, 84, 4);
  if (number < 1 || number > 4) return Found::nothing;
  MessageParts<4>& message = satellites_[satellite];
  // Strings of one frame follow one another; nothing in them names their frame.
  const bool follows = number == 1 || (message.parts[number - 2] && !message.parts[number - 1]);
  if (number == 1 || !follows) message.parts = {};
  if (!follows) return Found::nothing;
  message.parts[number - 1] = text;
  if (!message.is_complete()) return Found::nothing;
  const std::uint64_t key =
      std::uint64_t{whole(*message.parts[1], 80, 11)} << 32U | whole(*message.parts[0], 35, 27);
  const bool is_new = message.give(orbit_of(satellite, channel, message, near), key, ephemerides);
  message.parts = {};
  return is_new ? Found::ephemeris : Found::nothing;
}

}  // namespace waymark::formats::satellites
