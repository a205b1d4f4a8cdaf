/// Broadcast ephemerides from messages RXM-SFRBX of a UBX log.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <waymark/core/drive/stamp.hpp>
#include <waymark/formats/logs/detail/ubx/ubx_messages.hpp>
#include <waymark/formats/satellites/broadcast/broadcast_messages.hpp>
#include <waymark/formats/satellites/ephemerides.hpp>

namespace waymark::formats {

/// Numbers of systems in UBX.
enum UbxSystem : int { kUbxGps = 0, kUbxSbas = 1, kUbxGalileo = 2, kUbxBeidou = 3, kUbxGlonass = 6 };

/// Greater numbers of GLONASS are not known yet.
inline constexpr int kLastGlonass = 32;

/// Decodes the words of satellites. The week is that of the measurements: words before the first of these wait.
class UbxSubframes {
 public:
  /// @returns what is wrong with the message; empty: nothing
  [[nodiscard]] std::string take(const UbxPayload& payload, satellites::Ephemerides& ephemerides);
  /// Tells the time of the last measurements.
  void set_moment(Stamp moment, satellites::Ephemerides& ephemerides);

  /// Ephemerides that were added.
  [[nodiscard]] std::size_t ephemerides() const { return ephemerides_; }
  [[nodiscard]] std::size_t wrong_parity() const { return wrong_parity_; }

 private:
  /// The words of a satellite in one message.
  struct Subframe {
    int system = 0, satellite = 0, signal = 0, channel = 0;
    std::vector<std::uint32_t> words;
  };
  void decode(const Subframe& subframe, satellites::Ephemerides& ephemerides);

  std::optional<Stamp> moment_;
  std::vector<Subframe> undated_;
  satellites::LnavMessages gps_;
  satellites::InavMessages galileo_;
  satellites::D1Messages beidou_;
  satellites::D2Messages beidou_geostationary_;
  satellites::GlonassStrings glonass_;
  std::size_t ephemerides_ = 0, wrong_parity_ = 0;
};

}  // namespace waymark::formats
