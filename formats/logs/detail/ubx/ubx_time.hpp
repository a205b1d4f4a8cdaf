/// Time of UBX epochs: time of week (iTOW) and dates onto the GPS scale.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include <waymark/formats/logs/detail/ubx/ubx_messages.hpp>

namespace waymark::formats {

/// iTOW counts milliseconds up to here.
inline constexpr std::uint32_t kItowWeekMs = 604'800'000;

/// Keeps the GPS week. All times are nanoseconds on the GPS scale.
class UbxTime {
 public:
  /// @param stated_week  the week of the log's first epoch for logs that do not tell; 0: none
  explicit UbxTime(int stated_week) : stated_week_(stated_week) {}

  /// Of an epoch with a date. What a date tells is a nanosecond of UTC; where its seconds are not resolved
  /// (the receiver does not know the leap seconds yet) those of iTOW are taken, if they differ by at most a
  /// minute.
  [[nodiscard]] std::int64_t from_date(const UbxDate& date, std::uint32_t itow_ms);
  /// Of an epoch whose week is given.
  [[nodiscard]] std::int64_t from_week(const UbxWeek& week, std::uint32_t itow_ms);
  /// Of any other epoch: iTOW in the week that brings it nearest to the last epoch placed (so it runs on over
  /// the end of a week), else in the stated week. Empty while neither is known.
  [[nodiscard]] std::optional<std::int64_t> from_itow(std::uint32_t itow_ms);

  [[nodiscard]] std::size_t seconds_from_itow() const { return seconds_from_itow_; }
  [[nodiscard]] std::size_t disagreements() const { return disagreements_; }
  [[nodiscard]] std::size_t continued() const { return continued_; }
  [[nodiscard]] bool used_stated_week() const { return used_stated_week_; }

 private:
  [[nodiscard]] std::int64_t nearest(std::int64_t to, std::uint32_t itow_ms) const;

  int stated_week_ = 0;
  std::optional<std::int64_t> last_;
  std::size_t seconds_from_itow_ = 0;  ///< epochs whose date was not resolved and differed
  std::size_t disagreements_ = 0;      ///< epochs whose date and iTOW are not of one instant
  std::size_t continued_ = 0;          ///< epochs without a date or week of their own
  bool used_stated_week_ = false;
};

}  // namespace waymark::formats
