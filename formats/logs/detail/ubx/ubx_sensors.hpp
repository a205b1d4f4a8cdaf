/// Wheel ticks, speed, turning rates and accelerations of UBX logs (ESF-MEAS).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include <waymark/formats/logs/detail/ubx/ubx_frames.hpp>
#include <waymark/formats/logs/detail/ubx/ubx_messages.hpp>
#include <waymark/formats/logs/detail/ubx/ubx_time.hpp>

namespace waymark::formats {

/// A quantity of ESF-MEAS and its type number. The names are those of channels.hpp.
struct UbxChannel {
  const char* name;
  unsigned type;
  double unit;  ///< SI value of one step; 0: wheel ticks
};
inline constexpr std::array<UbxChannel, 12> kUbxChannels{{
    {"gyro_z", 5, 0.017453292519943295 / 4096},  // 2^-12 degree per second
    {"wheel_ticks_front_left", 6, 0},
    {"wheel_ticks_front_right", 7, 0},
    {"wheel_ticks_rear_left", 8, 0},
    {"wheel_ticks_rear_right", 9, 0},
    {"wheel_ticks", 10, 0},
    {"speed", 11, 1e-3},
    {"gyro_y", 13, 0.017453292519943295 / 4096},
    {"gyro_x", 14, 0.017453292519943295 / 4096},
    {"acceleration_x", 16, 1.0 / 1024},
    {"acceleration_y", 17, 1.0 / 1024},
    {"acceleration_z", 18, 1.0 / 1024},
}};

/// Turns a counter of 23 bits, which counts up in both directions, and its direction bit into a
/// running count.
class UbxTicks {
 public:
  /// @param field bits 0-22: counter, bit 23: backwards
  /// @return the count. It begins with the first value of the counter, falls while driving
  /// backwards, and does not wrap.
  [[nodiscard]] double count(std::uint32_t field);
  /// Returns how often the counter jumped back. It is then assumed to have restarted
  /// without a motion.
  [[nodiscard]] std::size_t restarts() const { return restarts_; }

 private:
  std::optional<std::uint32_t> last_;
  std::int64_t count_ = 0;
  std::size_t restarts_ = 0;
};

/// Places the clock of the sensors (milliseconds) on GNSS time.
///
/// Only the order of the messages relates the two clocks. If a message with a new iTOW arrives, the
/// newest sensor tag is about as old. The difference is the median of the last 33 such pairs. It
/// changes by 100 ppm at most, so that intervals between tags stay right to 1e-4. Its error is the
/// delay of navigation messages behind sensor messages: hundredths of a second with HNR-PVT, up to
/// half a second with NAV messages only. Sensor stamps are too early by this delay.
class UbxSensorClock {
 public:
  void sensor(std::int64_t tag_ms);
  void navigation(std::int64_t gps_ns);
  [[nodiscard]] bool ready() const { return meetings_ > 0; }
  /// Returns the GPS time of a tag, never before an earlier result. Call it in the order of
  /// tags, once ready.
  [[nodiscard]] std::int64_t gps_ns(std::int64_t tag_ms);
  /// Change from the first difference used to the last one, in ns.
  [[nodiscard]] std::int64_t drift_ns() const { return offset_ ? *offset_ - first_offset_ : 0; }
  [[nodiscard]] std::size_t jumps() const { return jumps_; }
  [[nodiscard]] std::size_t meetings() const { return meetings_; }
  /// Forgets all pairs after a restart of the sensor clock. The next difference is used as it is.
  void restart();

 private:
  static constexpr std::size_t kMeetings = 33;
  [[nodiscard]] std::int64_t median() const;

  std::optional<std::int64_t> fresh_tag_ms_;  ///< newest tag since the last navigation message
  std::optional<std::int64_t> newest_gps_;
  std::array<std::int64_t, kMeetings> differences_{};
  std::size_t kept_ = 0;
  std::int64_t median_ = 0;  ///< median of the kept differences
  std::size_t meetings_ = 0;
  std::optional<std::int64_t> offset_;
  std::int64_t first_offset_ = 0;
  std::int64_t last_tag_ms_ = 0;
  std::optional<std::int64_t> last_gps_;
  std::size_t jumps_ = 0;
};

/// Decodes the streams odometry and sensor. ubx.hpp has the rules.
class UbxSensorDecoder final : public UbxFrameDecoder {
 public:
  UbxSensorDecoder(std::string path, LogRequest request);

 protected:
  void take_frame(const UbxFrame& frame) override;
  void end() override;

 private:
  struct Row {
    std::int64_t tag_ms = 0;
    std::vector<double> values;
  };
  void take_time(std::uint16_t key, const UbxPayload& payload);
  void take_measurements(const UbxPayload& payload);
  void hold(std::int64_t tag_ms);
  void release(std::int64_t up_to_tag_ms);
  void release_all();

  UbxTime time_;
  UbxSensorClock clock_;
  std::array<int, 64> column_of_type_;  ///< -1: not asked for
  std::array<UbxTicks, 64> ticks_;
  std::vector<double> values_;             ///< values of the current message
  std::deque<Row> held_;                   ///< sorted by tag
  std::vector<std::vector<double>> pool_;  ///< row buffers for reuse
  std::optional<bool> calibrated_;         ///< which of the two tags of a message is read
  std::size_t other_clock_ = 0;
  std::size_t undated_ = 0;
};

}  // namespace waymark::formats
