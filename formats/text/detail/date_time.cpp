#include <waymark/formats/text/detail/date_time.hpp>

#include <algorithm>
#include <array>
#include <cctype>
#include <chrono>
#include <cstdint>
#include <string>
#include <utility>

#include <waymark/formats/text/detail/characters.hpp>
#include <waymark/formats/text/stamp_text.hpp>

namespace waymark::formats {
namespace {

constexpr std::int64_t kSecond = 1'000'000'000;
constexpr std::int64_t kDay = 86400 * kSecond;

/// Takes up to `most` digits off a text. @return empty if it does not begin with a digit
std::optional<int> take_digits(std::string_view& text, std::size_t most) {
  int value = 0;
  std::size_t count = 0;
  for (; count < most && count < text.size() && is_digit(text[count]); ++count)
    value = 10 * value + (text[count] - '0');
  if (count == 0) return std::nullopt;
  text.remove_prefix(count);
  return value;
}

/// "Jan", "january": 1. @return empty for other words
std::optional<int> month_of_word(std::string_view word) {
  constexpr std::string_view kMonths = "janfebmaraprmayjunjulaugsepoctnovdec";
  if (word.size() < 3) return std::nullopt;
  std::string begin;
  for (const char c : word.substr(0, 3))
    begin += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  const std::size_t at = kMonths.find(begin);
  if (at == std::string_view::npos || at % 3 != 0) return std::nullopt;
  return static_cast<int>(at / 3) + 1;
}

/// One of the three parts of a date.
struct DatePart {
  int value = 0;
  std::size_t digits = 0;
  bool is_month_name = false;
};

std::optional<DatePart> take_part(std::string_view& text) {
  const std::size_t before = text.size();
  if (const std::optional<int> number = take_digits(text, 4))
    return DatePart{*number, before - text.size(), false};
  std::size_t length = 0;
  while (length < text.size() && std::isalpha(static_cast<unsigned char>(text[length])) != 0) ++length;
  const std::optional<int> month = month_of_word(text.substr(0, length));
  if (!month) return std::nullopt;
  text.remove_prefix(length);
  return DatePart{*month, 0, true};
}

std::optional<Stamp> midnight(int year, int month, int day) {
  const std::chrono::year_month_day date{std::chrono::year{year},
                                         std::chrono::month{static_cast<unsigned>(month)},
                                         std::chrono::day{static_cast<unsigned>(day)}};
  if (year < 1700 || year > 2250 || !date.ok()) return std::nullopt;  // what 64 bits of nanoseconds hold
  return Stamp{std::chrono::sys_days{date}.time_since_epoch().count() * kDay};
}

/// Puts the parts in their places by the order.
std::optional<Stamp> date_of_parts(std::array<DatePart, 3> parts, DateOrder order) {
  if (parts[0].digits == 4) order = DateOrder::ymd;
  const auto [first, second, third] = parts;
  DatePart year = order == DateOrder::ymd ? first : third;
  DatePart month = order == DateOrder::mdy ? first : second;
  DatePart day = order == DateOrder::dmy ? first : order == DateOrder::mdy ? second : third;
  if (day.is_month_name) std::swap(day, month);  // "Jan 31 2024", "31 Jan 2024"
  if (year.is_month_name || day.is_month_name || day.digits > 2 || month.digits > 2) return std::nullopt;
  if (year.digits == 2) {
    year.value += year.value < 80 ? 2000 : 1900;
  } else if (year.digits != 4) {
    return std::nullopt;
  }
  return midnight(year.value, month.value, day.value);
}

/// "20240131", or "310124" in the order that is stated.
std::optional<Stamp> date_of_digits(std::string_view text, DateOrder order) {
  if (text.size() != 6 && text.size() != 8) return std::nullopt;
  const std::size_t year_digits = text.size() - 4;
  std::array<DatePart, 3> parts;
  for (std::size_t i = 0; i < 3; ++i) {
    const bool is_year = order == DateOrder::ymd ? i == 0 : i == 2;
    const std::size_t wanted = is_year ? year_digits : 2;
    const std::optional<int> number = take_digits(text, wanted);
    if (!number) return std::nullopt;
    parts[i] = {*number, wanted, false};
  }
  return date_of_parts(parts, order);
}

/// Takes "Z", "+01:00", "-0130" or "+01" off a text. @return seconds east of Greenwich; empty if it is none
std::optional<int> take_zone(std::string_view& text) {
  const char sign = text.front();
  text.remove_prefix(1);
  if (sign == 'Z' || sign == 'z') return 0;
  if (sign != '+' && sign != '-') return std::nullopt;
  const std::optional<int> hours = take_digits(text, 2);
  if (text.starts_with(':')) text.remove_prefix(1);
  const int minutes = take_digits(text, 2).value_or(0);
  if (!hours || *hours > 14 || minutes > 59) return std::nullopt;
  return (sign == '-' ? -60 : 60) * (60 * *hours + minutes);
}

/// Takes "AM" or "PM" off a text and corrects the hour. @return false if the hour is none of twelve
bool take_half_of_day(std::string_view& text, int& hour) {
  if (text.size() < 2 || (text[1] != 'M' && text[1] != 'm')) return true;
  const char half = static_cast<char>(std::toupper(static_cast<unsigned char>(text[0])));
  if (half != 'A' && half != 'P') return true;
  if (hour < 1 || hour > 12) return false;
  hour = hour % 12 + (half == 'P' ? 12 : 0);
  text = without_blanks(text.substr(2));
  return true;
}

/// Takes the decimals of a second off a text, in nanoseconds.
std::int64_t take_fraction(std::string_view& text) {
  if (text.size() < 2 || (text[0] != '.' && text[0] != ',') || !is_digit(text[1])) return 0;
  std::size_t end = 1;
  while (end < text.size() && is_digit(text[end])) ++end;
  const std::string number = "0." + std::string(text.substr(1, end - 1));
  text.remove_prefix(end);
  return stamp_from_decimal_seconds(number).value_or(Stamp{}).nanoseconds;
}

}  // namespace

std::optional<Stamp> date_from_text(std::string_view text, DateOrder order) {
  text = without_blanks(text);
  if (text.find_first_not_of("0123456789") == std::string_view::npos) return date_of_digits(text, order);
  std::array<DatePart, 3> parts;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::optional<DatePart> part = take_part(text);
    if (!part) return std::nullopt;
    parts[i] = *part;
    const std::size_t next = text.find_first_not_of("-/. ,");
    if (i < 2 && (next == 0 || next > 2)) return std::nullopt;
    if (i < 2) text.remove_prefix(next);
  }
  if (!text.empty() && text != ".") return std::nullopt;
  return date_of_parts(parts, order);
}

std::optional<Stamp> time_of_day_from_text(std::string_view text) {
  text = without_blanks(text);
  const std::size_t digits = text.find_first_not_of("0123456789");
  const bool packed = std::min(digits, text.size()) == 6;
  std::optional<int> hour = take_digits(text, 2);
  if (!hour) return std::nullopt;
  std::optional<int> minute;
  int second = 0;
  if (!packed) {
    if (!text.starts_with(':')) return std::nullopt;
    text.remove_prefix(1);
  }
  minute = take_digits(text, 2);
  if (packed || text.starts_with(':')) {
    if (!packed) text.remove_prefix(1);
    const std::optional<int> given = take_digits(text, 2);
    if (!given) return std::nullopt;
    second = *given;
  }
  const std::int64_t fraction = take_fraction(text);
  text = without_blanks(text);
  if (!minute || !take_half_of_day(text, *hour)) return std::nullopt;
  std::optional<int> zone = 0;
  if (!text.empty()) zone = take_zone(text);
  if (!zone || !text.empty() || *hour > 23 || *minute > 59 || second > 60) return std::nullopt;
  return Stamp{(3600 * *hour + 60 * *minute + second - *zone) * kSecond + fraction};
}

std::optional<Stamp> date_time_from_text(std::string_view text, DateOrder order) {
  text = without_blanks(text);
  // The time begins after the last separator that is followed by a digit and, later, a colon or digits only.
  const std::size_t colon = text.find(':');
  std::size_t cut = text.substr(0, colon).find_last_of(" T_t,");
  if (cut == std::string_view::npos || cut + 1 >= text.size() || !is_digit(text[cut + 1]))
    return std::nullopt;
  const std::optional<Stamp> time = time_of_day_from_text(text.substr(cut + 1));
  while (cut > 0 && (text[cut - 1] == ' ' || text[cut - 1] == ',')) --cut;
  const std::optional<Stamp> date = date_from_text(text.substr(0, cut), order);
  if (!time || !date) return std::nullopt;
  return Stamp{date->nanoseconds + time->nanoseconds};
}

}  // namespace waymark::formats
