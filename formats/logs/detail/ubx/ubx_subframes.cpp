#include <waymark/formats/logs/detail/ubx/ubx_subframes.hpp>

#include <span>
#include <utility>

#include <fmt/format.h>

namespace waymark::formats {
namespace {

constexpr std::size_t kSubframeHead = 8;
/// freqId of channel 0 of GLONASS.
constexpr int kChannelZero = 7;
/// A minute of subframes, if the receiver tells its week late.
constexpr std::size_t kMostUndatedSubframes = 512;

}  // namespace

std::string UbxSubframes::take(const UbxPayload& payload, satellites::Ephemerides& ephemerides) {
  const std::size_t count = payload.size() < kSubframeHead ? 0 : payload.u8(4);
  if (payload.size() < kSubframeHead + 4 * count || count == 0)
    return fmt::format("RXM-SFRBX: {} bytes cannot hold {} words", payload.size(), count);
  Subframe subframe{payload.u8(0), payload.u8(1), payload.u8(2), payload.u8(3) - kChannelZero, {}};
  for (std::size_t i = 0; i < count; ++i) subframe.words.push_back(payload.u32(kSubframeHead + 4 * i));
  if (moment_) {
    decode(subframe, ephemerides);
  } else if (undated_.size() < kMostUndatedSubframes) {
    undated_.push_back(std::move(subframe));
  }
  return {};
}

void UbxSubframes::set_moment(Stamp moment, satellites::Ephemerides& ephemerides) {
  moment_ = moment;
  for (const Subframe& subframe : std::exchange(undated_, {})) decode(subframe, ephemerides);
}

void UbxSubframes::decode(const Subframe& subframe, satellites::Ephemerides& ephemerides) {
  using satellites::GlonassStrings;
  using satellites::InavMessages;
  using satellites::LnavMessages;
  const std::span words(subframe.words);
  constexpr int kE5bI = 5;
  if (subframe.system == kUbxGps && subframe.signal == 0 && words.size() == 10) {
    const auto found = gps_.take(subframe.satellite, words.first<10>(), *moment_, ephemerides);
    ephemerides_ += found == LnavMessages::Found::ephemeris;
    wrong_parity_ += found == LnavMessages::Found::wrong_parity;
  } else if (subframe.system == kUbxGalileo && (subframe.signal <= 1 || subframe.signal == kE5bI) &&
             words.size() >= 8) {
    const auto found = galileo_.take(subframe.satellite, words.first<8>(), *moment_, ephemerides);
    ephemerides_ += found == InavMessages::Found::ephemeris;
    wrong_parity_ += found == InavMessages::Found::wrong_checksum;
  } else if (subframe.system == kUbxBeidou && subframe.signal <= 1 && words.size() == 10) {
    ephemerides_ +=
        satellites::is_geostationary_beidou(subframe.satellite)
            ? beidou_geostationary_.take(subframe.satellite, words.first<10>(), *moment_, ephemerides)
            : beidou_.take(subframe.satellite, words.first<10>(), *moment_, ephemerides);
  } else if (subframe.system == kUbxGlonass && subframe.satellite <= kLastGlonass && words.size() >= 4) {
    const auto found =
        glonass_.take(subframe.satellite, subframe.channel, words.first<4>(), *moment_, ephemerides);
    ephemerides_ += found == GlonassStrings::Found::ephemeris;
    wrong_parity_ += found == GlonassStrings::Found::wrong_checksum;
  }
}

}  // namespace waymark::formats
