#include <waymark/formats/logs/detail/common/gps_time.hpp>
#include <waymark/formats/satellites/broadcast/broadcast_messages.hpp>

namespace waymark::formats::satellites {
namespace {

constexpr std::size_t kEvenCovered = 114;  // without the tail bits
constexpr std::size_t kOddCovered = 82;    // up to the checksum

/// CRC-24Q, bit by bit: 1 + x + x^3 + x^4 + x^5 + x^6 + x^7 + x^10 + x^11 + x^14 + x^17 + x^18 + x^23 + x^24.
class Crc24q {
 public:
  void add(const MessageBits& bits, std::size_t count) {
    constexpr std::uint32_t kPolynomial = 0x864CFB;
    for (std::size_t i = 0; i < count; ++i) {
      const std::uint32_t out = (sum_ >> 23U ^ bits.whole(i, 1)) & 1U;
      sum_ = (sum_ << 1U & 0xFFFFFFU) ^ (out != 0 ? kPolynomial : 0U);
    }
  }
  [[nodiscard]] std::uint32_t sum() const { return sum_; }

 private:
  std::uint32_t sum_ = 0;
};

MessageBits inav_page(std::span<const std::uint32_t> words) {
  MessageBits bits;
  for (const std::uint32_t word : words) bits.append(word, 32);
  return bits;
}

/// The 128 bits of a word: 112 of the even part, 16 of the odd one.
MessageBits inav_word(const MessageBits& even, const MessageBits& odd) {
  MessageBits word;
  for (std::size_t at = 2; at < kEvenCovered; at += 16) word.append(even.whole(at, 16), 16);
  word.append(odd.whole(2, 16), 16);
  return word;
}

KeplerOrbit inav_orbit(int satellite, const MessageParts<5>& message, Stamp near) {
  const MessageBits& first = *message.parts[0];
  const MessageBits& second = *message.parts[1];
  const MessageBits& third = *message.parts[2];
  const MessageBits& fourth = *message.parts[3];
  const MessageBits& fifth = *message.parts[4];
  constexpr double kMinute_s = 60;
  KeplerOrbit orbit;
  orbit.system = System::galileo;
  orbit.number = satellite;
  orbit.toe_sow_s = kMinute_s * first.positive(16, 14, 0);
  orbit.toe = in_nearest_week(near, orbit.toe_sow_s);
  orbit.mean_anomaly_rad = kSemicircle_rad * first.scaled(30, 32, -31);
  orbit.eccentricity = first.positive(62, 32, -33);
  orbit.sqrt_a = first.positive(94, 32, -19);
  orbit.node_rad = kSemicircle_rad * second.scaled(16, 32, -31);
  orbit.inclination_rad = kSemicircle_rad * second.scaled(48, 32, -31);
  orbit.perigee_rad = kSemicircle_rad * second.scaled(80, 32, -31);
  orbit.inclination_rate_radps = kSemicircle_rad * second.scaled(112, 14, -43);
  orbit.node_rate_radps = kSemicircle_rad * third.scaled(16, 24, -43);
  orbit.mean_motion_difference_radps = kSemicircle_rad * third.scaled(40, 16, -43);
  orbit.cuc = third.scaled(56, 16, -29);
  orbit.cus = third.scaled(72, 16, -29);
  orbit.crc = third.scaled(88, 16, -5);
  orbit.crs = third.scaled(104, 16, -5);
  orbit.cic = fourth.scaled(22, 16, -29);
  orbit.cis = fourth.scaled(38, 16, -29);
  orbit.toc = in_nearest_week(near, kMinute_s * fourth.positive(54, 14, 0));
  orbit.clock_bias_s = fourth.scaled(68, 31, -34);
  orbit.clock_drift = fourth.scaled(99, 21, -46);
  orbit.clock_drift_rate_1_s = fourth.scaled(120, 6, -59);
  orbit.group_delay_s = fifth.scaled(57, 10, -32);  // E1 to E5b, the clock of I/NAV
  // State and validity of E1-B.
  orbit.is_healthy = fifth.whole(69, 2) == 0 && fifth.whole(72, 1) == 0;
  return orbit;
}

}  // namespace

InavMessages::Found InavMessages::take(int satellite, std::span<const std::uint32_t, 8> words, Stamp near,
                                       Ephemerides& ephemerides) {
  const MessageBits even = inav_page(words.first<4>());
  const MessageBits odd = inav_page(words.last<4>());
  const bool is_nominal = even.whole(0, 2) == 0b00 && odd.whole(0, 2) == 0b10;  // part, kind of page
  if (!is_nominal) return Found::nothing;
  Crc24q checksum;
  checksum.add(even, kEvenCovered);
  checksum.add(odd, kOddCovered);
  if (checksum.sum() != odd.whole(kOddCovered, 24)) return Found::wrong_checksum;
  const MessageBits word = inav_word(even, odd);
  const std::uint32_t type = word.whole(0, 6);
  if (type < 1 || type > 5) return Found::nothing;
  MessageParts<5>& message = satellites_[satellite];
  message.parts[type - 1] = word;
  if (!message.is_complete()) return Found::nothing;
  const std::uint32_t issue = message.parts[0]->whole(6, 10);
  for (std::size_t i = 1; i < 4; ++i)
    if (message.parts[i]->whole(6, 10) != issue) return Found::nothing;
  const std::uint64_t key =
      std::uint64_t{message.parts[0]->whole(16, 14)} << 32U | message.parts[4]->whole(67, 6) << 10U | issue;
  return message.give(inav_orbit(satellite, message, near), key, ephemerides) ? Found::ephemeris
                                                                              : Found::nothing;
}

}  // namespace waymark::formats::satellites
