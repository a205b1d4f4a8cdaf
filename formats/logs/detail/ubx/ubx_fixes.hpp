/// Positions of UBX logs: combines the messages of one epoch.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string_view>

#include <Eigen/Core>

#include <waymark/formats/logs/detail/common/position_stream.hpp>
#include <waymark/formats/logs/detail/ubx/ubx_frames.hpp>
#include <waymark/formats/logs/detail/ubx/ubx_messages.hpp>
#include <waymark/formats/logs/detail/ubx/ubx_time.hpp>

namespace waymark::formats {

/// The messages of one navigation epoch.
struct UbxEpoch {
  std::uint32_t itow_ms = 0;
  std::optional<UbxSolution> solution;  ///< NAV-PVT (or HNR-PVT)
  std::optional<UbxPlace> precise;      ///< NAV-HPPOSLLH
  std::optional<UbxPlace> plain;        ///< NAV-POSLLH
  std::optional<UbxEcef> ecef;          ///< NAV-POSECEF, NAV-SOL
  std::optional<UbxMotion> velned;
  std::optional<UbxEcef> velecef;  ///< NAV-VELECEF, NAV-SOL
  std::optional<double> hdop;      ///< NAV-DOP
  std::optional<Eigen::Matrix2d> covariance;
  std::optional<UbxFixState> state;  ///< NAV-SOL, NAV-STATUS
  std::optional<UbxDate> utc;        ///< NAV-TIMEUTC
  std::optional<UbxWeek> week;       ///< NAV-SOL, NAV-TIMEGPS
  std::size_t number = 0;            ///< number of the frame with the position
  std::uint64_t byte = 0;            ///< place of the first frame

  [[nodiscard]] bool has_position() const { return solution || precise || plain || ecef; }
};

/// Counts for the notes.
struct UbxFixCounts {
  std::size_t precise = 0;
  std::size_t solution = 0;
  std::size_t plain = 0;
  std::size_t ecef = 0;
  std::size_t covariance = 0;
  std::size_t bad_covariance = 0;
  std::size_t dead_reckoned = 0;
  std::size_t combined = 0;
  std::size_t carrier_float = 0;
  std::size_t carrier_fixed = 0;
  std::size_t stateless = 0;
  std::size_t repeated = 0;
};

/// Decodes the streams gnss and truth. ubx.hpp has the rules.
class UbxFixDecoder final : public UbxFrameDecoder {
 public:
  /// @param high_rate read HNR-PVT in place of the navigation epochs
  UbxFixDecoder(std::string path, LogRequest request, bool high_rate);

 protected:
  void take_frame(const UbxFrame& frame) override;
  void take_strange(std::string_view bytes) override;
  void end() override;

 private:
  void take_navigation(std::uint16_t key, const UbxPayload& payload);
  void take_ecef(std::uint16_t key, const UbxPayload& payload);
  void begin_epoch_for(std::uint16_t key, std::uint32_t itow_ms);
  void end_epoch();
  [[nodiscard]] std::optional<std::int64_t> time_of(const UbxEpoch& epoch);
  void add_sample(const UbxEpoch& epoch, const UbxPlace& place, Stamp stamp);
  [[nodiscard]] StatedAccuracy accuracy(const UbxEpoch& epoch, const UbxPlace& place);
  void count(const UbxEpoch& epoch);
  void take_nmea();
  void note_positions();
  void note_time();

  bool high_rate_;
  /// NMEA sentences between the frames: they count in a log whose frames have no position
  std::unique_ptr<LogDecoder> nmea_;
  PositionStream positions_;
  UbxTime time_;
  UbxFixCounts counts_;
  std::optional<UbxEpoch> epoch_;       ///< the current one
  std::optional<std::uint32_t> ended_;  ///< iTOW of the previous one
};

}  // namespace waymark::formats
