/// Assembles fixes from signals in several frames; private to the candump reader.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <waymark/core/drive/log_reader.hpp>
#include <waymark/formats/logs/detail/can/can_signals.hpp>
#include <waymark/formats/logs/detail/common/position_stream.hpp>
#include <waymark/formats/logs/detail/common/quantity.hpp>
#include <waymark/formats/logs/detail/common/table_accuracy.hpp>

namespace waymark::formats {

/// The frames of one fix arrive within this time. Receivers send them in one burst (2 ms in the
/// drive at hand).
inline constexpr std::int64_t kBurstNanoseconds = 100'000'000;

/// The value of a quantity in a frame; NaN if it was outside the range of the quantity.
struct SignalValue {
  std::size_t quantity = 0;
  double value = 0;
};

/// Assembles fixes or truth, in whatever order a receiver sends its frames. Latitude and longitude
/// make a fix and give its stamp. If they are in two frames, the later one gives the stamp. Every
/// other quantity comes from the frame nearest in time, earlier or later, at most kBurstNanoseconds
/// away. So a fix is held back until the next position, or until that time has passed.
class FixAssembler {
 public:
  /// The references must outlive the assembler.
  /// @throws InputError for fixes without any accuracy
  FixAssembler(const std::vector<Quantity>& quantities, const std::vector<BoundSignal>& bound,
               const LogRequest& request, const std::string& path, LogData& data);

  /// Takes the values of one frame.
  void take(Stamp stamp, std::size_t line, std::span<const SignalValue> values);
  /// Delivers the last fix and the notes.
  void finish();

 private:
  /// Place of a quantity in the stream; kNowhere if no signal gives it.
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
  [[nodiscard]] bool read_details(GeodeticFix& fix);
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
      valid_, quality_, hdop_, satellites_, correction_age_;
  std::string quality_code_;  ///< of table_quality()
  AccuracyQuantities accuracy_;
  std::size_t east_ = kNowhere, north_ = kNowhere, covariance_root_ = kNowhere;

  Given latitude_part_, longitude_part_;  ///< each waits for the other
  std::vector<Given> newest_;             ///< the newest value of each quantity
  bool open_ = false;
  Given position_;               ///< stamp and line of the open fix
  double position_deg_[2] = {};  ///< latitude, longitude
  std::vector<Given> nearest_;   ///< for each quantity, the value nearest to the open fix
};

}  // namespace waymark::formats
