/// Positions of UBX logs: messages of one epoch brought together.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include <Eigen/Core>

#include <waymark/formats/logs/detail/common/position_stream.hpp>
#include <waymark/formats/logs/detail/ubx/ubx_frames.hpp>
#include <waymark/formats/logs/detail/ubx/ubx_messages.hpp>
#include <waymark/formats/logs/detail/ubx/ubx_time.hpp>

namespace waymark::formats {

/// What the messages of one navigation epoch said.
struct UbxEpoch {
  std::uint32_t itow_ms = 0;
  std::optional<UbxSolution> solution;  ///< NAV-PVT (or HNR-PVT)
  std::optional<UbxPlace> precise;      ///< NAV-HPPOSLLH
  std::optional<UbxPlace> plain;        ///< NAV-POSLLH
  std::optional<UbxMotion> velned;
  std::optional<Eigen::Matrix2d> covariance;
  std::optional<UbxFixState> state;  ///< NAV-SOL, NAV-STATUS
  std::optional<UbxDate> utc;        ///< NAV-TIMEUTC
  std::optional<UbxWeek> week;       ///< NAV-SOL, NAV-TIMEGPS
  std::size_t number = 0;            ///< of the frame that brought the position
  std::uint64_t byte = 0;            ///< of the first frame

  [[nodiscard]] bool has_position() const { return solution || precise || plain; }
};

/// Counts for the notes.
struct UbxFixCounts {
  std::size_t precise = 0;
  std::size_t solution = 0;
  std::size_t plain = 0;
  std::size_t covariance = 0;
  std::size_t bad_covariance = 0;
  std::size_t dead_reckoned = 0;
  std::size_t combined = 0;
  std::size_t carrier_float = 0;
  std::size_t carrier_fixed = 0;
  std::size_t stateless = 0;
  std::size_t repeated = 0;
};

/// Decoder of the streams gnss and truth. See ubx.hpp for the rules.
class UbxFixDecoder final : public UbxFrameDecoder {
 public:
  /// @param high_rate  reads HNR-PVT instead of the navigation epochs
  UbxFixDecoder(std::string path, LogRequest request, bool high_rate);

 protected:
  void take_frame(const UbxFrame& frame) override;
  void end() override;

 private:
  void take_navigation(std::uint16_t key, const UbxPayload& payload);
  void begin_epoch_for(std::uint16_t key, std::uint32_t itow_ms);
  void end_epoch();
  [[nodiscard]] std::optional<std::int64_t> time_of(const UbxEpoch& epoch);
  void add_sample(const UbxEpoch& epoch, const UbxPlace& place, Stamp stamp);
  [[nodiscard]] StatedAccuracy accuracy(const UbxEpoch& epoch, const UbxPlace& place);
  void count(const UbxEpoch& epoch);
  void note_positions();
  void note_time();

  bool high_rate_;
  PositionStream positions_;
  UbxTime time_;
  UbxFixCounts counts_;
  std::optional<UbxEpoch> epoch_;       ///< the one at hand
  std::optional<std::uint32_t> ended_;  ///< iTOW of the one before
};

}  // namespace waymark::formats
