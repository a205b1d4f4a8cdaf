/// Fixes out of signals that come in several frames; private to the candump reader.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <waymark/core/drive/log_reader.hpp>
#include <waymark/formats/logs/detail/can/candump_signals.hpp>
#include <waymark/formats/logs/detail/common/position_stream.hpp>
#include <waymark/formats/logs/detail/common/quantity.hpp>
#include <waymark/formats/logs/detail/common/table_accuracy.hpp>

namespace waymark::formats {

/// Frames of one fix come within this time. Receivers send them in one burst (2 ms in the drive at hand).
inline constexpr std::int64_t kBurstNanoseconds = 100'000'000;

/// A quantity from a frame; NaN where the signal was outside the quantity's range.
struct SignalValue {
  std::size_t quantity = 0;
  double value = 0;
};

/// Makes fixes or truth. Whatever the order in which a receiver sends its frames: latitude and longitude give
/// a fix and its stamp (that of the later frame, where they come in two), every other quantity is taken from
/// the frame nearest in time, at most kBurstNanoseconds away, earlier or later. So a fix is held back until
/// the next position or the end of that time.
class FixAssembler {
 public:
  /// The references must outlive the assembler.
  /// @throws InputError for fixes without any accuracy
  FixAssembler(const std::vector<Quantity>& quantities, const std::vector<BoundSignal>& bound,
               const LogRequest& request, const std::string& path, LogData& data);

  /// What one frame holds.
  void take(Stamp stamp, std::size_t line, std::span<const SignalValue> values);
  /// Gives the last fix, and the notes.
  void finish();

 private:
  /// Place of a quantity among the stream's; kNowhere where no signal gives it.
  static constexpr std::size_t kNowhere = std::numeric_limits<std::size_t>::max();
  struct Given {
    double value = 0;
    Stamp stamp;
    std::size_t line = 0;
    bool there = false;
  };

  [[nodiscard]] std::size_t place_of(std::string_view name) const;
  void take_part(Given& part, const Given& given, std::string_view name, std::string_view other);
  void complain(std::size_t line, const std::string& what);
  void open();
  void close();
  void add_position();
  [[nodiscard]] double value(std::size_t place) const;
  [[nodiscard]] std::optional<double> optional_value(std::size_t place) const;
  [[nodiscard]] std::optional<double> optional_sigma(std::size_t place) const;

  const std::vector<Quantity>& quantities_;
  const std::vector<BoundSignal>& bound_;
  const std::string& path_;
  LogData& data_;
  PositionStream positions_;
  std::size_t latitude_, longitude_, height_, heading_, course_, course_accuracy_, speed_, speed_accuracy_,
      valid_;
  AccuracyQuantities accuracy_;
  std::size_t east_ = kNowhere, north_ = kNowhere, covariance_root_ = kNowhere;

  Given latitude_part_, longitude_part_;  ///< that wait for the other
  std::vector<Given> newest_;             ///< by quantity
  bool open_ = false;
  Given position_;               ///< of the open fix: stamp and line
  double position_deg_[2] = {};  ///< latitude, longitude
  std::vector<Given> nearest_;   ///< by quantity, to the open fix
};

}  // namespace waymark::formats
