/// Time of UBX epochs: converts time of week (iTOW) and dates to the GPS scale.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include <waymark/formats/logs/detail/ubx/ubx_messages.hpp>

namespace waymark::formats {

/// iTOW counts milliseconds up to this value.
inline constexpr std::uint32_t kItowWeekMs = 604'800'000;

/// Keeps the GPS week. All times are nanoseconds on the GPS scale.
class UbxTime {
 public:
  /// @param stated_week the week of the first epoch, for logs that do not state it; 0: none
  explicit UbxTime(int stated_week) : stated_week_(stated_week) {}

  /// Time of an epoch with a date. A date gives UTC to the nanosecond. If its seconds are not
  /// resolved (the receiver does not know the leap seconds yet), the seconds of iTOW are used,
  /// provided they differ by at most a minute.
  [[nodiscard]] std::int64_t from_date(const UbxDate& date, std::uint32_t itow_ms);
  /// Time of an epoch with a given week.
  [[nodiscard]] std::int64_t from_week(const UbxWeek& week, std::uint32_t itow_ms);
  /// Time of any other epoch. iTOW is placed in the week that brings it nearest to the last epoch,
  /// so it continues over the end of a week. Before the first epoch it is placed in the stated
  /// week. Empty while neither is known.
  [[nodiscard]] std::optional<std::int64_t> from_itow(std::uint32_t itow_ms);

  [[nodiscard]] std::size_t seconds_from_itow() const { return seconds_from_itow_; }
  [[nodiscard]] std::size_t disagreements() const { return disagreements_; }
  [[nodiscard]] std::size_t continued() const { return continued_; }
  [[nodiscard]] bool used_stated_week() const { return used_stated_week_; }

 private:
  [[nodiscard]] std::int64_t nearest(std::int64_t to, std::uint32_t itow_ms) const;

  int stated_week_ = 0;
  std::optional<std::int64_t> last_;
  std::size_t seconds_from_itow_ = 0;  ///< epochs with an unresolved date that differed from iTOW
  std::size_t disagreements_ = 0;      ///< epochs whose date and iTOW are different instants
  std::size_t continued_ = 0;          ///< epochs without a date or week of their own
  bool used_stated_week_ = false;
};

}  // namespace waymark::formats
