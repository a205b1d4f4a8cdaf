/// Ephemerides from the navigation messages that satellites send.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <span>

#include <waymark/formats/satellites/broadcast/message_bits.hpp>
#include <waymark/formats/satellites/ephemerides.hpp>

namespace waymark::formats::satellites {

/// The parts of one satellite's message, until they make an ephemeris.
template <std::size_t Parts>
struct MessageParts {
  std::array<std::optional<MessageBits>, Parts> parts;
  /// of the ephemeris that was given last, so that each is given once
  std::optional<std::uint64_t> issue;

  /// Adds the ephemeris of the parts, unless it was given already or cannot be. @param key tells it from the next one
  /// @returns whether it was added
  template <typename Orbit>
  [[nodiscard]] bool give(const Orbit& orbit, std::uint64_t key, Ephemerides& ephemerides) {
    if (issue == key || !is_possible(orbit)) return false;
    issue = key;
    ephemerides.add(orbit);
    return true;
  }
  [[nodiscard]] bool is_complete() const {
    for (const auto& part : parts)
      if (!part) return false;
    return true;
  }
};

/// Tells whether the six lowest of 30 bits are the parity of the others (IS-GPS-200, table 20-XIV), as a receiver gives
/// the word after it undid the inversion by the last bit of the word before.
[[nodiscard]] bool lnav_parity_is_right(std::uint32_t word);

/// LNAV of GPS L1 C/A (IS-GPS-200, 20.3.3): an ephemeris stands in the subframes 1 to 3, the ionosphere in page 18 of
/// subframe 4.
class LnavMessages {
 public:
  enum class Found { nothing, ephemeris, ionosphere, wrong_parity };

  /// @param words ten of 30 bits, parity last
  /// @param near a time within half a week, on the GPS scale
  Found take(int satellite, std::span<const std::uint32_t, 10> words, Stamp near, Ephemerides& ephemerides);

 private:
  std::map<int, MessageParts<3>> satellites_;
};

/// I/NAV of Galileo E1-B and E5b-I (OS SIS ICD, 4.3): an ephemeris stands in the words 1 to 5.
class InavMessages {
 public:
  enum class Found { nothing, ephemeris, wrong_checksum };

  /// @param words eight of 32 bits: an even page part of 120 bits from the first word on, an odd one from the fifth on
  Found take(int satellite, std::span<const std::uint32_t, 8> words, Stamp near, Ephemerides& ephemerides);

 private:
  std::map<int, MessageParts<5>> satellites_;
};

/// D1 of BeiDou B1I (BDS-SIS-ICD, 5.2), which satellites in medium and inclined orbits send: an ephemeris stands in the
/// subframes 1 to 3.
class D1Messages {
 public:
  /// @param words ten of 30 bits, each with its parity
  /// @returns whether an ephemeris was added
  bool take(int satellite, std::span<const std::uint32_t, 10> words, Stamp near, Ephemerides& ephemerides);

 private:
  std::map<int, MessageParts<3>> satellites_;
};

/// D2 of BeiDou B1I (BDS-SIS-ICD, 5.3), which geostationary satellites send: an ephemeris stands in the ten pages of
/// subframe 1, 3 s apart.
class D2Messages {
 public:
  /// @param words ten of 30 bits, each with its parity
  /// @returns whether an ephemeris was added
  bool take(int satellite, std::span<const std::uint32_t, 10> words, Stamp near, Ephemerides& ephemerides);

 private:
  std::map<int, MessageParts<10>> satellites_;
};

/// The strings of GLONASS G1 (GLONASS ICD 5.1, 4): an ephemeris stands in the strings 1 to 4.
class GlonassStrings {
 public:
  enum class Found { nothing, ephemeris, wrong_checksum };

  /// @param channel of the satellite's frequency, -7 .. 6
  /// @param words four of 32 bits: the 85 bits of a string from the first word on
  Found take(int satellite, int channel, std::span<const std::uint32_t, 4> words, Stamp near,
             Ephemerides& ephemerides);

 private:
  std::map<int, MessageParts<4>> satellites_;
};

}  // namespace waymark::formats::satellites
