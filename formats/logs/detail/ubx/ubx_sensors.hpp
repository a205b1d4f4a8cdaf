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

/// The quantities that ESF-MEAS holds, and under which type number; names as channels.hpp has them.
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

/// A running count out of a counter of 23 bits that counts up in both directions, and its direction bit.
class UbxTicks {
 public:
  /// @param field  bits 0-22: counter, bit 23: backwards
  /// @return the count: begins with the counter's first value, falls while driving backwards, does not wrap
  [[nodiscard]] double count(std::uint32_t field);
  /// How often the counter went back: it is taken to have begun anew, without a motion.
  [[nodiscard]] std::size_t restarts() const { return restarts_; }

 private:
  std::optional<std::uint32_t> last_;
  std::int64_t count_ = 0;
  std::size_t restarts_ = 0;
};

/// Places the sensors' clock (milliseconds) on GNSS time.
///
/// The two meet only in the order of the messages: when one with a new iTOW comes, the newest sensor tag is
/// about as old. The difference is the median of the last 33 such meetings, followed at 100 ppm at most, so
/// that intervals between tags stay right to 1e-4. It errs by what navigation messages lag behind sensor
/// messages: hundredths of a second where HNR-PVT comes, up to half a second with NAV messages alone; sensor
/// stamps then come out too early by that.
class UbxSensorClock {
 public:
  void sensor(std::int64_t tag_ms);
  void navigation(std::int64_t gps_ns);
  [[nodiscard]] bool ready() const { return meetings_ > 0; }
  /// GPS time of a tag; not before one given earlier. Call in the order of tags, once ready.
  [[nodiscard]] std::int64_t gps_ns(std::int64_t tag_ms);
  /// First difference used to the last one, ns.
  [[nodiscard]] std::int64_t drift_ns() const { return offset_ ? *offset_ - first_offset_ : 0; }
  [[nodiscard]] std::size_t jumps() const { return jumps_; }
  [[nodiscard]] std::size_t meetings() const { return meetings_; }
  /// Forgets the meetings (the sensors' clock began anew); the next difference is taken as it is.
  void restart();

 private:
  static constexpr std::size_t kMeetings = 33;
  [[nodiscard]] std::int64_t median() const;

  std::optional<std::int64_t> fresh_tag_ms_;  ///< newest tag since the last navigation message
  std::optional<std::int64_t> newest_gps_;
  std::array<std::int64_t, kMeetings> differences_{};
  std::size_t kept_ = 0;
  std::int64_t median_ = 0;  ///< of those kept
  std::size_t meetings_ = 0;
  std::optional<std::int64_t> offset_;
  std::int64_t first_offset_ = 0;
  std::int64_t last_tag_ms_ = 0;
  std::optional<std::int64_t> last_gps_;
  std::size_t jumps_ = 0;
};

/// Decoder of the streams odometry and sensor. See ubx.hpp for the rules.
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
  std::vector<double> values_;             ///< of the message at hand
  std::deque<Row> held_;                   ///< sorted by tag
  std::vector<std::vector<double>> pool_;  ///< row buffers to use again
  std::optional<bool> calibrated_;         ///< which of a message's tags is read
  std::size_t other_clock_ = 0;
  std::size_t undated_ = 0;
};

}  // namespace waymark::formats
