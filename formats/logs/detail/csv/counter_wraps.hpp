/// Follows a counter of 32 bits over its end: micros() and millis() of microcontrollers begin anew after 2^32.
#pragma once

#include <charconv>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include <waymark/formats/logs/detail/csv/csv_columns.hpp>

namespace waymark::formats {

/// The times of one column. A whole number that falls from the last sixteenth of 2^32 to the first one begins
/// the next round, and a rise by as much takes that back: rows around the end may be in disorder. Other falls are
/// left alone, such as that of a device that was started again.
class CounterWraps {
 public:
  /// @param times null, dates and seconds: nothing is followed
  explicit CounterWraps(const BoundColumn* times) {
    if (times == nullptr || times->form != UnitForm::number || times->time_power >= 0) return;
    tick_ns_ = 1'000'000'000;
    for (int power = times->time_power; power < 0; ++power) tick_ns_ /= 10;
  }

  /// Takes the field of each row of the table, also of rows that are not read: the end may be among them.
  void see(std::string_view field) {
    if (tick_ns_ == 0) return;
    std::uint64_t count = 0;
    const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), count);
    if (error != std::errc() || end != field.data() + field.size() || count >= kRound) return;
    constexpr std::uint64_t kNear = kRound / 16;
    const bool is_first = count < kNear;
    const bool is_last = count >= kRound - kNear;
    if (was_last_ && is_first && rounds_ < kMostRounds) {
      ++rounds_;
      ++falls_;
    } else if (was_first_ && is_last && rounds_ > 0) {
      --rounds_;
    }
    was_first_ = is_first;
    was_last_ = is_last;
  }
  /// Returns what to add to the time of the row that was seen last, ns.
  [[nodiscard]] std::int64_t added_ns() const {
    return rounds_ * static_cast<std::int64_t>(kRound) * tick_ns_;
  }
  [[nodiscard]] std::size_t falls() const { return falls_; }

 private:
  static constexpr std::uint64_t kRound = std::uint64_t{1} << 32U;
  static constexpr std::int64_t kMostRounds = 1000;  // of milliseconds: 136 years

  std::int64_t tick_ns_ = 0;  ///< 0: nothing is followed
  std::int64_t rounds_ = 0;
  std::size_t falls_ = 0;
  bool was_first_ = false;
  bool was_last_ = false;
};

}  // namespace waymark::formats
