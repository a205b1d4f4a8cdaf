/// What a log of raw GNSS measurements holds.
#pragma once

#include <map>
#include <string>

#include <waymark/formats/logs/detail/common/line_decoder.hpp>
#include <waymark/formats/logs/detail/rinex/rinex_observations.hpp>
#include <waymark/tools/inspection/survey/running_statistics.hpp>

namespace waymark::inspection {

/// One satellite on its first frequency.
struct SatelliteSummary {
  std::size_t pseudoranges = 0;
  std::size_t dopplers = 0;
  std::size_t with_cn0 = 0;
  double cn0_sum_dbhz = 0;

  /// NaN without C/N0.
  [[nodiscard]] double mean_cn0_dbhz() const;
};

struct RawSummary {
  StampSeries stamps;                                    ///< of the epochs, UTC
  std::map<std::string, SatelliteSummary> satellites{};  ///< by "G05"
  std::size_t fewest = 0, most = 0;                      ///< satellites in an epoch
};

/// Reads a RINEX observation file without ephemerides.
class RawSurvey final : public formats::LineDecoder {
 public:
  explicit RawSurvey(const std::string& path);
  [[nodiscard]] const RawSummary& summary() const { return summary_; }

 protected:
  void take_line(std::string_view line, std::size_t number) override {
    observations_.take_line(line, number);
  }
  void end() override { observations_.finish(); }

 private:
  void take_epoch(const formats::satellites::RawEpoch& epoch);

  formats::RinexObservations observations_;
  RawSummary summary_;
};

}  // namespace waymark::inspection
