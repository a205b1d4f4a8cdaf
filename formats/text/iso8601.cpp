#include <waymark/formats/text/iso8601.hpp>

#include <charconv>
#include <chrono>
#include <cstdint>
#include <string>

#include <fmt/format.h>

#include <waymark/formats/text/stamp_text.hpp>

namespace waymark::formats {
namespace {

constexpr std::int64_t kNanosecondsPerSecond = 1'000'000'000;

/// Takes fields of fixed width off a text. After the first mismatch it takes nothing more.
class Scanner {
 public:
  explicit Scanner(std::string_view text) : text_(text) {}

  [[nodiscard]] int digits(std::size_t count) {
    int value = 0;
    if (text_.size() < count) return fail();
    for (std::size_t i = 0; i < count; ++i) {
      if (text_[i] < '0' || text_[i] > '9') return fail();
      value = 10 * value + (text_[i] - '0');
    }
    text_.remove_prefix(count);
    return value;
  }
  void literal(std::string_view allowed) {
    if (text_.empty() || allowed.find(text_.front()) == std::string_view::npos) {
      fail();
    } else {
      text_.remove_prefix(1);
    }
  }
  /// Returns the fraction after a decimal point in nanoseconds; 0 if there is none.
  [[nodiscard]] std::int64_t fraction() {
    if (text_.empty() || (text_.front() != '.' && text_.front() != ',')) return 0;
    std::size_t end = 1;
    while (end < text_.size() && text_[end] >= '0' && text_[end] <= '9') ++end;
    if (end == 1) return fail();
    std::string number = "0.";
    number += text_.substr(1, end - 1);
    text_.remove_prefix(end);
    return stamp_from_decimal_seconds(number).value_or(Stamp{}).nanoseconds;
  }
  /// Offset of the zone from UTC in seconds.
  [[nodiscard]] std::int64_t zone() {
    if (text_.empty()) return 0;
    const char sign = text_.front();
    literal("Zz+-");
    if (sign != '+' && sign != '-') return 0;
    const int hours = digits(2);
    if (text_.starts_with(':')) literal(":");
    const int minutes = text_.empty() ? 0 : digits(2);
    if (hours > 14 || minutes > 59) return fail();
    return (sign == '-' ? -60 : 60) * (60 * hours + minutes);
  }
  [[nodiscard]] bool done() const { return good_ && text_.empty(); }

 private:
  int fail() {
    good_ = false;
    return 0;
  }
  std::string_view text_;
  bool good_ = true;
};

}  // namespace

std::optional<Stamp> stamp_from_iso8601(std::string_view text) {
  Scanner scanner(text);
  const int year = scanner.digits(4);
  scanner.literal("-");
  const int month = scanner.digits(2);
  scanner.literal("-");
  const int day = scanner.digits(2);
  scanner.literal("Tt ");
  const int hour = scanner.digits(2);
  scanner.literal(":");
  const int minute = scanner.digits(2);
  scanner.literal(":");
  const int second = scanner.digits(2);
  const std::int64_t nanoseconds = scanner.fraction();
  const std::int64_t zone = scanner.zone();
  if (!scanner.done() || hour > 23 || minute > 59 || second > 60) return std::nullopt;
  if (second == 60 && minute != 59) return std::nullopt;
  if (year < 1700 || year > 2250) return std::nullopt;  // what 64 bits of nanoseconds hold

  const std::chrono::year_month_day date{std::chrono::year{year},
                                         std::chrono::month{static_cast<unsigned>(month)},
                                         std::chrono::day{static_cast<unsigned>(day)}};
  if (!date.ok()) return std::nullopt;
  const std::int64_t days = std::chrono::sys_days{date}.time_since_epoch().count();
  const std::int64_t seconds = 86400 * days + 3600 * hour + 60 * minute + second - zone;
  return Stamp{seconds * kNanosecondsPerSecond + nanoseconds};
}

std::string iso8601_from_stamp(Stamp utc) {
  using std::chrono::days;
  const std::chrono::sys_time<std::chrono::nanoseconds> instant{std::chrono::nanoseconds(utc.nanoseconds)};
  const auto day = std::chrono::floor<days>(instant);
  const std::chrono::year_month_day date(day);
  const std::chrono::hh_mm_ss time(instant - day);
  std::string text = fmt::format("{:04}-{:02}-{:02}T{:02}:{:02}:{:02}", static_cast<int>(date.year()),
                                 static_cast<unsigned>(date.month()), static_cast<unsigned>(date.day()),
                                 time.hours().count(), time.minutes().count(), time.seconds().count());
  if (const auto fraction = time.subseconds().count(); fraction != 0) {
    text += fmt::format(".{:09}", fraction);
    text.erase(text.find_last_not_of('0') + 1);
  }
  return text + 'Z';
}

}  // namespace waymark::formats
