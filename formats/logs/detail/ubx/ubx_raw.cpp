#include <waymark/formats/logs/detail/ubx/ubx_raw.hpp>

#include <algorithm>
#include <optional>

#include <fmt/format.h>

#include <waymark/formats/logs/detail/common/gps_time.hpp>

namespace waymark::formats {
namespace {

using satellites::SatelliteName;
using satellites::System;

constexpr std::size_t kRawHead = 16;
constexpr std::size_t kRawEach = 32;
constexpr double kWeek_s = 604'800;

/// The satellite of a signal of the first frequency. Receivers before F9 write 0 for every signal.
std::optional<SatelliteName> satellite_of(int system, int number, int signal) {
  constexpr int kSbasFrom = 100;
  if (number == 0) return std::nullopt;
  switch (system) {
    case kUbxGps:
      if (signal == 0) return SatelliteName{System::gps, number};
      break;
    case kUbxSbas:
      if (signal == 0 && number > kSbasFrom) return SatelliteName{System::sbas, number - kSbasFrom};
      break;
    case kUbxGalileo:  // E1-C, E1-B
      if (signal <= 1) return SatelliteName{System::galileo, number};
      break;
    case kUbxBeidou:  // B1I with the message D1 or D2
      if (signal <= 1) return SatelliteName{System::beidou, number};
      break;
    case kUbxGlonass:
      if (signal == 0 && number <= kLastGlonass) return SatelliteName{System::glonass, number};
      break;
    default:
      break;
  }
  return std::nullopt;
}

bool holds(const satellites::RawEpoch& epoch, const SatelliteName& name) {
  return std::any_of(epoch.satellites.begin(), epoch.satellites.end(),
                     [&](const satellites::RawMeasurement& other) { return other.satellite == name; });
}

}  // namespace

std::string rawx_error(const UbxPayload& payload) {
  if (payload.size() < kRawHead)
    return fmt::format("RXM-RAWX: {} bytes, but the message has at least {}", payload.size(), kRawHead);
  const std::size_t count = payload.u8(11);
  const std::size_t length = kRawHead + kRawEach * count;
  if (payload.size() != length)
    return fmt::format("RXM-RAWX: {} bytes, but {} measurements need {}", payload.size(), count, length);
  const double second = payload.f64(0);
  if (!(second >= 0 && second <= kWeek_s)) return "RXM-RAWX: the time of the week is outside 0 .. 604800 s";
  if (payload.u16(8) > kLastGpsWeek)
    return fmt::format("RXM-RAWX: week {} is outside 0 .. {}", payload.u16(8), kLastGpsWeek);
  return {};
}

UbxRawEpoch read_rxm_rawx(const UbxPayload& payload) {
  UbxRawEpoch result;
  result.epoch.moment = Stamp{payload.u16(8) * kGpsWeekNanoseconds}.later(payload.f64(0));
  for (std::size_t i = 0; i < payload.u8(11); ++i) {
    const std::size_t at = kRawHead + kRawEach * i;
    const bool is_valid = (payload.u8(at + 30) & 1U) != 0;  // trkStat: prValid
    const auto satellite = satellite_of(payload.u8(at + 20), payload.u8(at + 21), payload.u8(at + 22));
    const auto measurement = is_valid && satellite
                                 ? satellites::raw_measurement(*satellite, payload.f64(at),
                                                               payload.f32(at + 16), payload.u8(at + 26))
                                 : std::nullopt;
    if (measurement && !holds(result.epoch, *satellite))
      result.epoch.satellites.push_back(*measurement);
    else
      ++result.unused;
  }
  return result;
}

void UbxRawDecoder::take_frame(const UbxFrame& frame) {
  const UbxPayload payload(frame.payload);
  if (frame.key == ubx::kRxmRawx) {
    take_measurements(payload);
  } else if (frame.key == ubx::kRxmSfrbx && !rows_.has_navigation_files()) {
    const std::string error = subframes_.take(payload, rows_.ephemerides());
    if (error.empty()) return;
    ++data_.records;
    corrupt(byte(), error);
  }
}

void UbxRawDecoder::take_measurements(const UbxPayload& payload) {
  const std::string error = rawx_error(payload);
  if (!error.empty()) {
    ++data_.records;
    return corrupt(byte(), error);
  }
  if (payload.u16(8) == 0) {
    ++without_week_;
    return;
  }
  const UbxRawEpoch raw = read_rxm_rawx(payload);
  unused_ += raw.unused;
  subframes_.set_moment(raw.epoch.moment, rows_.ephemerides());
  rows_.take(raw.epoch);
}

void UbxRawDecoder::end() {
  rows_.finish();
  if (!rows_.has_navigation_files())
    note(fmt::format("{} ephemerides come from {} messages RXM-SFRBX", subframes_.ephemerides(),
                     count(ubx::kRxmSfrbx)));
  if (subframes_.wrong_parity() > 0)
    note(
        fmt::format("{} messages RXM-SFRBX have a wrong parity and are left out", subframes_.wrong_parity()));
  if (without_week_ > 0)
    note(fmt::format("{} messages RXM-RAWX come before the receiver knows the week and are left out",
                     without_week_));
  if (unused_ > 0)
    note(fmt::format(
        "{} measurements have no valid pseudorange of a first frequency, or are of another system", unused_));
  if (count(ubx::kRxmRawx) == 0)
    note("the log holds no message RXM-RAWX; enable it at the receiver (CFG-MSG, UBX-RXM-RAWX)");
}

}  // namespace waymark::formats
