#include <waymark/tools/inspection/survey/raw_survey.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>

#include <waymark/formats/logs/detail/ubx/ubx_raw.hpp>

namespace waymark::inspection {
namespace {

/// Returns the name of the system that a letter of RINEX stands for.
std::string_view system_of(char letter) {
  switch (letter) {
    case 'G':
      return "GPS";
    case 'R':
      return "GLONASS";
    case 'E':
      return "Galileo";
    case 'C':
      return "BeiDou";
    default:
      return "SBAS";
  }
}

}  // namespace

double SatelliteSummary::mean_cn0_dbhz() const {
  if (with_cn0 == 0) return std::numeric_limits<double>::quiet_NaN();
  return cn0_sum_dbhz / static_cast<double>(with_cn0);
}

void RawSummary::add(const formats::satellites::RawEpoch& epoch) {
  stamps.add(convert(epoch.moment, TimeScale::gps, TimeScale::utc), 0);
  const std::size_t count = epoch.satellites.size();
  fewest = stamps.count() == 1 ? count : std::min(fewest, count);
  most = std::max(most, count);
  for (const formats::satellites::RawMeasurement& measurement : epoch.satellites) {
    SatelliteSummary& satellite = satellites[to_string(measurement.satellite)];
    ++satellite.pseudoranges;
    satellite.dopplers += std::isnan(measurement.doppler_hz) ? 0 : 1;
    if (std::isnan(measurement.cn0_dbhz)) continue;
    ++satellite.with_cn0;
    satellite.cn0_sum_dbhz += measurement.cn0_dbhz;
  }
}

void RawSummary::add(const formats::satellites::Ephemerides& ephemerides) {
  holds_ephemerides = true;
  for (const auto& [name, count] : ephemerides.counts()) satellites[to_string(name)].ephemerides += count;
}

std::string RawSummary::systems() const {
  std::string text;
  for (const char letter : {'G', 'R', 'E', 'C', 'S'}) {
    const auto count = std::count_if(satellites.begin(), satellites.end(), [&](const auto& satellite) {
      return satellite.first.front() == letter && satellite.second.pseudoranges > 0;
    });
    if (count == 0) continue;
    text += (text.empty() ? "" : ", ") + std::string(system_of(letter)) + " " + std::to_string(count);
  }
  return text;
}

RinexSurvey::RinexSurvey(const std::string& path)
    : LineDecoder(path, {}),
      observations_(path, {[this](const formats::satellites::RawEpoch& epoch) {
                             data_.records += epoch.satellites.size();
                             summary_.add(epoch);
                           },
                           [this](std::size_t line, std::size_t column, const std::string& what) {
                             ++data_.records;
                             corrupt(line, column, what);
                           }}) {}

void UbxRawSurvey::take_frame(const formats::UbxFrame& frame) {
  const formats::UbxPayload payload(frame.payload);
  std::string error;
  if (frame.key == formats::ubx::kRxmRawx) {
    error = formats::rawx_error(payload);
    constexpr std::size_t kWeekField = 8;
    const bool knows_week = error.empty() && payload.u16(kWeekField) > 0;  // not yet after a cold start
    if (knows_week) {
      const formats::UbxRawEpoch raw = formats::read_rxm_rawx(payload);
      data_.records += raw.epoch.satellites.size();
      summary_.add(raw.epoch);
      subframes_.set_moment(raw.epoch.moment, ephemerides_);
    }
  } else if (frame.key == formats::ubx::kRxmSfrbx) {
    error = subframes_.take(payload, ephemerides_);
  }
  if (error.empty()) return;
  ++data_.records;
  corrupt(byte(), error);
}

void UbxRawSurvey::end() {
  summary_.add(ephemerides_);
}

}  // namespace waymark::inspection
