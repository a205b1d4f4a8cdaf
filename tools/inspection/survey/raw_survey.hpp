/// What a log of raw GNSS measurements holds.
#pragma once

#include <map>
#include <string>

#include <waymark/formats/logs/detail/common/line_decoder.hpp>
#include <waymark/formats/logs/detail/rinex/rinex_observations.hpp>
#include <waymark/formats/logs/detail/ubx/ubx_frames.hpp>
#include <waymark/formats/logs/detail/ubx/ubx_subframes.hpp>
#include <waymark/formats/satellites/ephemerides.hpp>
#include <waymark/tools/inspection/survey/running_statistics.hpp>

namespace waymark::inspection {

/// One satellite on its first frequency.
struct SatelliteSummary {
  std::size_t pseudoranges = 0;
  std::size_t dopplers = 0;
  std::size_t with_cn0 = 0;
  double cn0_sum_dbhz = 0;
  std::size_t ephemerides = 0;  ///< in the log

  /// NaN without C/N0.
  [[nodiscard]] double mean_cn0_dbhz() const;
};

struct RawSummary {
  StampSeries stamps;                                    ///< of the epochs, UTC
  std::map<std::string, SatelliteSummary> satellites{};  ///< by "G05"
  std::size_t fewest = 0, most = 0;                      ///< satellites in an epoch
  bool holds_ephemerides = false;                        ///< logs of this kind may have them

  void add(const formats::satellites::RawEpoch& epoch);
  void add(const formats::satellites::Ephemerides& ephemerides);
  /// Returns how many satellites of each system were measured: "GPS 9, GLONASS 7".
  [[nodiscard]] std::string systems() const;
};

/// A decoder that makes such a summary.
class RawSummarySource {
 public:
  virtual ~RawSummarySource() = default;
  [[nodiscard]] const RawSummary& summary() const { return summary_; }

 protected:
  RawSummary summary_;
};

/// Reads a RINEX observation file without ephemerides.
class RinexSurvey final : public formats::LineDecoder, public RawSummarySource {
 public:
  explicit RinexSurvey(const std::string& path);

 protected:
  void take_line(std::string_view line, std::size_t number) override {
    observations_.take_line(line, number);
  }
  void end() override { observations_.finish(); }

 private:
  formats::RinexObservations observations_;
};

/// Reads the messages RXM-RAWX and RXM-SFRBX of a UBX log.
class UbxRawSurvey final : public formats::UbxFrameDecoder, public RawSummarySource {
 public:
  explicit UbxRawSurvey(const std::string& path) : UbxFrameDecoder(path, {}) {}

 protected:
  void take_frame(const formats::UbxFrame& frame) override;
  void end() override;

 private:
  formats::UbxSubframes subframes_;
  formats::satellites::Ephemerides ephemerides_;
};

}  // namespace waymark::inspection
