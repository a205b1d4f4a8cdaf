#include <waymark/tools/inspection/survey/raw_survey.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace waymark::inspection {

double SatelliteSummary::mean_cn0_dbhz() const {
  if (with_cn0 == 0) return std::numeric_limits<double>::quiet_NaN();
  return cn0_sum_dbhz / static_cast<double>(with_cn0);
}

RawSurvey::RawSurvey(const std::string& path)
    : LineDecoder(path, {}),
      observations_(path, {[this](const formats::satellites::RawEpoch& epoch) { take_epoch(epoch); },
                           [this](std::size_t line, std::size_t column, const std::string& what) {
                             ++data_.records;
                             corrupt(line, column, what);
                           }}) {}

void RawSurvey::take_epoch(const formats::satellites::RawEpoch& epoch) {
  data_.records += epoch.satellites.size();
  summary_.stamps.add(convert(epoch.moment, TimeScale::gps, TimeScale::utc), 0);
  const std::size_t count = epoch.satellites.size();
  summary_.fewest = summary_.stamps.count() == 1 ? count : std::min(summary_.fewest, count);
  summary_.most = std::max(summary_.most, count);
  for (const formats::satellites::RawMeasurement& measurement : epoch.satellites) {
    SatelliteSummary& satellite = summary_.satellites[to_string(measurement.satellite)];
    ++satellite.pseudoranges;
    satellite.dopplers += std::isnan(measurement.doppler_hz) ? 0 : 1;
    if (std::isnan(measurement.cn0_dbhz)) continue;
    ++satellite.with_cn0;
    satellite.cn0_sum_dbhz += measurement.cn0_dbhz;
  }
}

}  // namespace waymark::inspection
