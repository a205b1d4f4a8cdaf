#include "logs/ubx/raw_frames.hpp"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <numbers>
#include <string_view>
#include <utility>

#include "logs/ubx/ubx_bytes.hpp"

namespace waymark_test {

using waymark::formats::satellites::GlonassOrbit;
using waymark::formats::satellites::KeplerOrbit;

namespace {

/// Bits as text of 0 and 1: slow, and easy to compare with the tables.
using Bits = std::string;

Bits bits(std::int64_t value, std::size_t width) {
  constexpr std::size_t kSign = 63;  // a wider number repeats it
  Bits text;
  for (std::size_t i = width; i-- > 0;)
    text += (static_cast<std::uint64_t>(value) >> std::min(i, kSign) & 1U) != 0 ? '1' : '0';
  return text;
}

/// A number in units of 2^exponent.
Bits scaled(double value, std::size_t width, int exponent) {
  return bits(std::llround(std::ldexp(value, -exponent)), width);
}
Bits angle(double value_rad, std::size_t width, int exponent) {
  return scaled(value_rad / std::numbers::pi, width, exponent);
}

std::uint32_t number_of(std::string_view text) {
  std::uint32_t value = 0;
  for (const char c : text) value = value << 1U | (c == '1' ? 1U : 0U);
  return value;
}

char exclusive_or(char a, char b) {
  return a == b ? '0' : '1';
}

/// IS-GPS-200, table 20-XIV. @param data 24 bits before the inversion; before: D29* and D30*
Bits lnav_parity(const Bits& data, const Bits& before) {
  static const std::vector<std::vector<std::size_t>> kBits{
      {1, 2, 3, 5, 6, 10, 11, 12, 13, 14, 17, 18, 20, 23},
      {2, 3, 4, 6, 7, 11, 12, 13, 14, 15, 18, 19, 21, 24},
      {1, 3, 4, 5, 7, 8, 12, 13, 14, 15, 16, 19, 20, 22},
      {2, 4, 5, 6, 8, 9, 13, 14, 15, 16, 17, 20, 21, 23},
      {1, 3, 5, 6, 7, 9, 10, 14, 15, 16, 17, 18, 21, 22, 24},
      {3, 5, 6, 8, 9, 10, 11, 13, 15, 19, 22, 23, 24}};
  static const std::vector<std::size_t> kBefore{0, 1, 0, 1, 1, 0};
  Bits parity;
  for (std::size_t i = 0; i < kBits.size(); ++i) {
    char bit = before[kBefore[i]];
    for (const std::size_t place : kBits[i]) bit = exclusive_or(bit, data[place - 1]);
    parity += bit;
  }
  return parity;
}

Bits inverted(Bits text) {
  for (char& c : text) c = c == '0' ? '1' : '0';
  return text;
}

/// @param data 240 bits; the last two of the words 2 and 10 are chosen so that their parity ends with 00
std::vector<std::uint32_t> lnav_words(Bits data) {
  std::vector<std::uint32_t> words;
  Bits before = "00";
  for (std::size_t k = 0; k < 10; ++k) {
    Bits word = data.substr(24 * k, 24);
    for (int choice = 0; (k == 1 || k == 9) && choice < 4; ++choice) {
      word.replace(22, 2, bits(choice, 2));
      if (lnav_parity(word, before).substr(4) == "00") break;
    }
    const bool is_inverted = before[1] == '1';
    const Bits sent = (is_inverted ? inverted(word) : word) + lnav_parity(word, before);
    words.push_back(number_of(is_inverted ? inverted(before + sent) : before + sent));
    before = sent.substr(28);
  }
  return words;
}

Bits lnav_head(int number) {
  return bits(0x8B, 8) + bits(0, 16) + bits(100, 17) + bits(0, 2) + bits(number, 3) + bits(0, 2);
}

std::uint32_t crc24q(const Bits& text) {
  std::uint32_t sum = 0;
  for (const char c : text) {
    const bool out = ((sum >> 23U & 1U) != 0) != (c == '1');
    sum = sum << 1U & 0xFFFFFFU;
    if (out) sum ^= 0x864CFBU;
  }
  return sum;
}

/// Parts 224 bits of data into words: 26 bits and 4 of parity, then 22 and 8. The parity is left at zero: receivers check
/// it, and no decoder does again.
std::vector<std::uint32_t> d1_words(const Bits& data) {
  std::vector<std::uint32_t> words{number_of(data.substr(0, 26) + bits(0, 4))};
  for (std::size_t at = 26; at < data.size(); at += 22)
    words.push_back(number_of(data.substr(at, 22) + bits(0, 8)));
  return words;
}

/// A number whose first bit is its sign.
Bits sign_and_size(double value, std::size_t width, int exponent) {
  return (value < 0 ? "1" : "0") + scaled(std::abs(value), width - 1, exponent);
}

/// The sums of GLONASS ICD 5.1, table 4.13, over bits that are numbered from 85 down. @param text the bits 85 to 9
Bits glonass_checks(const Bits& text) {
  using Range = std::pair<int, int>;
  static const std::vector<std::vector<Range>> kSums{
      {{9, 10},  {12, 13}, {15, 15}, {17, 17}, {19, 20}, {22, 22}, {24, 24}, {26, 26}, {28, 28},
       {30, 30}, {32, 32}, {34, 35}, {37, 37}, {39, 39}, {41, 41}, {43, 43}, {45, 45}, {47, 47},
       {49, 49}, {51, 51}, {53, 53}, {55, 55}, {57, 57}, {59, 59}, {61, 61}, {63, 63}, {65, 66},
       {68, 68}, {70, 70}, {72, 72}, {74, 74}, {76, 76}, {78, 78}, {80, 80}, {82, 82}, {84, 84}},
      {{9, 9},   {11, 12}, {14, 15}, {18, 19}, {21, 22}, {25, 26}, {29, 30},
       {33, 34}, {36, 37}, {40, 41}, {44, 45}, {48, 49}, {52, 53}, {56, 57},
       {60, 61}, {64, 65}, {67, 68}, {71, 72}, {75, 76}, {79, 80}, {83, 84}},
      {{10, 12},
       {16, 19},
       {23, 26},
       {31, 34},
       {38, 41},
       {46, 49},
       {54, 57},
       {62, 65},
       {69, 72},
       {77, 80},
       {85, 85}},
      {{13, 19}, {27, 34}, {42, 49}, {58, 65}, {73, 80}},
      {{20, 34}, {50, 65}, {81, 85}},
      {{35, 65}},
      {{66, 85}}};
  const auto sum_of = [&](int from, int to) {
    char sum = '0';
    for (int bit = from; bit <= to; ++bit) sum = exclusive_or(sum, text[static_cast<std::size_t>(85 - bit)]);
    return sum;
  };
  Bits checks;  // bit 1 first
  char all = sum_of(9, 85);
  for (const auto& ranges : kSums) {
    char sum = '0';
    for (const auto& [from, to] : ranges) sum = exclusive_or(sum, sum_of(from, to));
    checks += sum;
    all = exclusive_or(all, sum);
  }
  checks += all;
  std::reverse(checks.begin(), checks.end());
  return checks;
}

}  // namespace

std::string rawx_frame(int week, double second_of_week, const std::vector<RawxMeasurement>& measurements) {
  UbxBytes payload(16 + 32 * measurements.size());
  payload.f64(0, second_of_week)
      .u16(8, week)
      .u8(10, 18)
      .u8(11, static_cast<std::int64_t>(measurements.size()));
  payload.u8(12, 1).u8(13, 1);
  for (std::size_t i = 0; i < measurements.size(); ++i) {
    const RawxMeasurement& one = measurements[i];
    const std::size_t at = 16 + 32 * i;
    payload.f64(at, one.pseudorange_m).f64(at + 8, one.pseudorange_m / 0.19).f32(at + 16, one.doppler_hz);
    payload.u8(at + 20, one.system).u8(at + 21, one.satellite).u8(at + 22, one.signal).u8(at + 23, 7);
    payload.u16(at + 24, 5000).u8(at + 26, one.cn0_dbhz).u8(at + 27, 5).u8(at + 28, 2).u8(at + 29, 5);
    payload.u8(at + 30, one.is_valid ? 7 : 6);
  }
  return ubx_frame(0x0215, payload.bytes());
}

std::string sfrbx_frame(int system, int satellite, int signal, const std::vector<std::uint32_t>& words,
                        int channel) {
  UbxBytes payload(8 + 4 * words.size());
  payload.u8(0, system).u8(1, satellite).u8(2, signal).u8(4, static_cast<std::int64_t>(words.size()));
  payload.u8(3, channel + 7).u8(5, 3).u8(6, 2);
  for (std::size_t i = 0; i < words.size(); ++i) payload.u32(8 + 4 * i, words[i]);
  return ubx_frame(0x0213, payload.bytes());
}

std::vector<std::uint32_t> lnav_subframe(const KeplerOrbit& orbit, int number, unsigned issue,
                                         unsigned week) {
  const auto toc_s = std::fmod(static_cast<double>(orbit.toc.nanoseconds) * 1e-9, 604'800);
  Bits data = lnav_head(number);
  if (number == 1) {
    data +=
        bits(week % 1024, 10) + bits(1, 2) + bits(0, 4) + bits(orbit.is_healthy ? 0 : 0x20, 6) + bits(0, 2);
    data += bits(0, 24 * 3 + 16) + scaled(orbit.group_delay_s, 8, -31);
    data += bits(issue, 8) + scaled(toc_s, 16, 4);
    data += scaled(orbit.clock_drift_rate_1_s, 8, -55) + scaled(orbit.clock_drift, 16, -43);
    data += scaled(orbit.clock_bias_s, 22, -31) + "00";
  } else if (number == 2) {
    data += bits(issue, 8) + scaled(orbit.crs, 16, -5);
    data += angle(orbit.mean_motion_difference_radps, 16, -43) + angle(orbit.mean_anomaly_rad, 32, -31);
    data += scaled(orbit.cuc, 16, -29) + scaled(orbit.eccentricity, 32, -33);
    data += scaled(orbit.cus, 16, -29) + scaled(orbit.sqrt_a, 32, -19);
    data += scaled(orbit.toe_sow_s, 16, 4) + bits(0, 8);
  } else {
    data += scaled(orbit.cic, 16, -29) + angle(orbit.node_rad, 32, -31);
    data += scaled(orbit.cis, 16, -29) + angle(orbit.inclination_rad, 32, -31);
    data += scaled(orbit.crc, 16, -5) + angle(orbit.perigee_rad, 32, -31);
    data += angle(orbit.node_rate_radps, 24, -43);
    data += bits(issue, 8) + angle(orbit.inclination_rate_radps, 14, -43) + "00";
  }
  return lnav_words(data);
}

std::vector<std::uint32_t> lnav_ionosphere_page(const std::array<int, 8>& coefficients) {
  Bits data = lnav_head(4) + "01" + bits(56, 6);
  for (const int coefficient : coefficients) data += bits(coefficient, 8);
  return lnav_words(data + bits(0, 240 - data.size()));
}

std::vector<std::uint32_t> inav_word(const KeplerOrbit& orbit, int type, unsigned issue, unsigned week) {
  const auto toc_s = std::fmod(static_cast<double>(orbit.toc.nanoseconds) * 1e-9, 604'800);
  Bits word = bits(type, 6);
  if (type >= 1 && type <= 4) word += bits(issue, 10);
  if (type == 0) {
    word += "10" + bits(0, 88) + bits(week, 12) + scaled(orbit.toe_sow_s, 20, 0);
  } else if (type == 6) {
    word += bits(0, 122);
  } else if (type == 1) {
    word += bits(std::llround(orbit.toe_sow_s / 60), 14) + angle(orbit.mean_anomaly_rad, 32, -31);
    word += scaled(orbit.eccentricity, 32, -33) + scaled(orbit.sqrt_a, 32, -19) + "00";
  } else if (type == 2) {
    word += angle(orbit.node_rad, 32, -31) + angle(orbit.inclination_rad, 32, -31);
    word += angle(orbit.perigee_rad, 32, -31) + angle(orbit.inclination_rate_radps, 14, -43) + "00";
  } else if (type == 3) {
    word += angle(orbit.node_rate_radps, 24, -43) + angle(orbit.mean_motion_difference_radps, 16, -43);
    word += scaled(orbit.cuc, 16, -29) + scaled(orbit.cus, 16, -29) + scaled(orbit.crc, 16, -5);
    word += scaled(orbit.crs, 16, -5) + bits(107, 8);
  } else if (type == 4) {
    word += bits(orbit.number, 6) + scaled(orbit.cic, 16, -29) + scaled(orbit.cis, 16, -29);
    word += bits(std::llround(toc_s / 60), 14) + scaled(orbit.clock_bias_s, 31, -34);
    word += scaled(orbit.clock_drift, 21, -46) + scaled(orbit.clock_drift_rate_1_s, 6, -59) + "00";
  } else {
    word += bits(0, 41) + bits(0, 10) + scaled(orbit.group_delay_s, 10, -32) + bits(0, 2);
    word += bits(orbit.is_healthy ? 0 : 1, 2) + bits(0, 2) + bits(week, 12) + scaled(orbit.toe_sow_s, 20, 0) +
            bits(0, 23);
  }
  const Bits even = "00" + word.substr(0, 112);
  const Bits odd = "10" + word.substr(112) + bits(0, 40 + 22 + 2);
  const Bits parts = even + bits(0, 6 + 8) + odd + bits(crc24q(even + odd), 24) + bits(0, 8 + 6 + 8);
  std::vector<std::uint32_t> words;
  for (std::size_t at = 0; at < parts.size(); at += 32) words.push_back(number_of(parts.substr(at, 32)));
  return words;
}

std::vector<std::uint32_t> d1_subframe(const KeplerOrbit& orbit, int number, unsigned second, unsigned week) {
  const auto toc_s = std::fmod(static_cast<double>(orbit.toc.nanoseconds) * 1e-9 - 14, 604'800);
  const Bits toe = bits(std::llround(orbit.toe_sow_s / 8), 17);
  Bits data = bits(0x712, 11) + bits(0, 4) + bits(number, 3) + bits(second, 20);
  if (number == 1) {
    data += bits(orbit.is_healthy ? 0 : 1, 1) + bits(1, 5) + bits(2, 4) + bits(week, 13);
    data +=
        bits(std::llround(toc_s / 8), 17) + bits(std::llround(orbit.group_delay_s * 1e10), 10) + bits(0, 10);
    data += bits(0, 64) + scaled(orbit.clock_drift_rate_1_s, 11, -66) + scaled(orbit.clock_bias_s, 24, -33);
    data += scaled(orbit.clock_drift, 22, -50) + bits(1, 5);
  } else if (number == 2) {
    data += angle(orbit.mean_motion_difference_radps, 16, -43) + scaled(orbit.cuc, 18, -31);
    data += angle(orbit.mean_anomaly_rad, 32, -31) + scaled(orbit.eccentricity, 32, -33);
    data += scaled(orbit.cus, 18, -31) + scaled(orbit.crc, 18, -6) + scaled(orbit.crs, 18, -6);
    data += scaled(orbit.sqrt_a, 32, -19) + toe.substr(0, 2);
  } else {
    data += toe.substr(2) + angle(orbit.inclination_rad, 32, -31) + scaled(orbit.cic, 18, -31);
    data += angle(orbit.node_rate_radps, 24, -43) + scaled(orbit.cis, 18, -31);
    data += angle(orbit.inclination_rate_radps, 14, -43) + angle(orbit.node_rad, 32, -31);
    data += angle(orbit.perigee_rad, 32, -31) + "0";
  }
  data.resize(26 + 9 * 22, '0');
  return d1_words(data);
}

std::vector<std::uint32_t> d2_page(const KeplerOrbit& orbit, int page, unsigned second, unsigned week) {
  const auto toc_s = std::fmod(static_cast<double>(orbit.toc.nanoseconds) * 1e-9 - 14, 604'800);
  const Bits toe = bits(std::llround(orbit.toe_sow_s / 8), 17);
  const Bits drift = scaled(orbit.clock_drift, 22, -50);
  const Bits cuc = scaled(orbit.cuc, 18, -31);
  const Bits cic = scaled(orbit.cic, 18, -31);
  const Bits eccentricity = scaled(orbit.eccentricity, 32, -33);
  const Bits inclination = angle(orbit.inclination_rad, 32, -31);
  const Bits node_rate = angle(orbit.node_rate_radps, 24, -43);
  const Bits perigee = angle(orbit.perigee_rad, 32, -31);
  Bits data = bits(0x712, 11) + bits(0, 4) + bits(1, 3) + bits(second, 20) + bits(page, 4);
  if (page == 1) {
    data += bits(orbit.is_healthy ? 0 : 1, 1) + bits(1, 5) + bits(2, 4) + bits(week, 13);
    data +=
        bits(std::llround(toc_s / 8), 17) + bits(std::llround(orbit.group_delay_s * 1e10), 10) + bits(0, 10);
  } else if (page == 3) {
    data += bits(0, 6 + 22 + 10) + scaled(orbit.clock_bias_s, 24, -33) + drift.substr(0, 4);
  } else if (page == 4) {
    data += drift.substr(4) + scaled(orbit.clock_drift_rate_1_s, 11, -66) + bits(1, 5);
    data += angle(orbit.mean_motion_difference_radps, 16, -43) + cuc.substr(0, 14);
  } else if (page == 5) {
    data += cuc.substr(14) + angle(orbit.mean_anomaly_rad, 32, -31) + scaled(orbit.cus, 18, -31) +
            eccentricity.substr(0, 10);
  } else if (page == 6) {
    data += eccentricity.substr(10) + scaled(orbit.sqrt_a, 32, -19) + cic.substr(0, 10);
  } else if (page == 7) {
    data += cic.substr(10) + scaled(orbit.cis, 18, -31) + toe + inclination.substr(0, 21);
  } else if (page == 8) {
    data += inclination.substr(21) + scaled(orbit.crc, 18, -6) + scaled(orbit.crs, 18, -6) +
            node_rate.substr(0, 19);
  } else if (page == 9) {
    data += node_rate.substr(19) + angle(orbit.node_rad, 32, -31) + perigee.substr(0, 27);
  } else if (page == 10) {
    data += perigee.substr(27) + angle(orbit.inclination_rate_radps, 14, -43);
  }
  data.resize(26 + 9 * 22, '0');
  return d1_words(data);
}

std::vector<std::uint32_t> glonass_string(const GlonassOrbit& orbit, int number, int day, int interval) {
  constexpr double kKilometre_m = 1000;
  constexpr std::int64_t kDay_s = 86'400;
  const waymark::Stamp utc = convert(orbit.toe, waymark::TimeScale::gps, waymark::TimeScale::utc);
  const std::int64_t moscow_s = (utc.nanoseconds / 1'000'000'000 + 10'800) % kDay_s;
  Bits text = "0" + bits(number, 4);
  if (number <= 3) {
    const Eigen::Index axis = number - 1;
    if (number == 1) text += bits(0, 2 + 2) + bits(moscow_s / 3600, 5) + bits(moscow_s / 60 % 60, 6) + "0";
    if (number == 2) text += bits(orbit.is_healthy ? 0 : 4, 3) + "0" + bits(moscow_s / 900, 7) + bits(0, 5);
    if (number == 3) text += "0" + sign_and_size(orbit.clock_drift, 11, -40) + bits(0, 4);
    text += sign_and_size(orbit.velocity[axis] / kKilometre_m, 24, -20);
    text += sign_and_size(orbit.acceleration[axis] / kKilometre_m, 5, -30);
    text += sign_and_size(orbit.position[axis] / kKilometre_m, 27, -11);
  } else if (number == 4) {
    text += sign_and_size(-orbit.clock_bias_s, 22, -30) + bits(0, 5) + bits(0, 5) + bits(0, 14) + "0" +
            bits(2, 4) + bits(0, 3) + bits(day, 11) + bits(orbit.number, 5) + bits(1, 2);
  } else {
    text += bits(day, 11) + bits(0, 32) + "0" + bits(interval, 5);
  }
  text.resize(77, '0');
  text += glonass_checks(text);
  text.resize(128, '0');
  std::vector<std::uint32_t> words;
  for (std::size_t at = 0; at < text.size(); at += 32) words.push_back(number_of(text.substr(at, 32)));
  return words;
}

}  // namespace waymark_test
