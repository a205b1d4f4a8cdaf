#include <waymark/formats/logs/detail/nmea/nmea_sentence.hpp>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>
#include <cstring>

#include <fmt/format.h>

#include <waymark/formats/logs/detail/common/record_fields.hpp>
#include <waymark/formats/text/detail/characters.hpp>
#include <waymark/formats/text/detail/decimal.hpp>

namespace waymark::formats {
namespace {

constexpr std::size_t kShortestAddress = 3;
constexpr std::size_t kLongestAddress = 8;

/// Returns the exclusive or of all characters, eight at a time.
unsigned checksum_of(std::string_view text) {
  std::uint64_t sum = 0;
  while (text.size() >= sizeof sum) {
    std::uint64_t eight = 0;
    std::memcpy(&eight, text.data(), sizeof eight);
    sum ^= eight;
    text.remove_prefix(sizeof eight);
  }
  sum ^= sum >> 32U;
  sum ^= sum >> 16U;
  sum ^= sum >> 8U;
  auto folded = static_cast<unsigned>(sum & 0xFFU);
  for (const char c : text) folded ^= static_cast<unsigned char>(c);
  return folded;
}

/// Returns the length of the address at the beginning of a sentence; 0: there is none.
std::size_t address_length(std::string_view sentence) {
  const std::size_t longest = std::min(sentence.size(), kLongestAddress + 1);
  std::size_t length = 0;
  while (length < longest &&
         (is_digit(sentence[length]) || (sentence[length] >= 'A' && sentence[length] <= 'Z')))
    ++length;
  const bool ends = length < sentence.size() && (sentence[length] == ',' || sentence[length] == '*');
  return ends && length >= kShortestAddress && length <= kLongestAddress ? length : 0;
}

/// Reads a sentence from the text after its `$` up to the next `$` or the end of the line.
std::optional<NmeaSentence> sentence_of(std::string_view text) {
  const std::size_t address = address_length(text);
  if (address == 0) return std::nullopt;
  NmeaSentence sentence;
  sentence.address = text.substr(0, address);
  const std::size_t star = text.find('*', address);
  if (star == std::string_view::npos || text.size() - star < 3) {
    text = text.substr(0, star);
    const std::size_t last = text.find_last_not_of(" \t\r");
    text = text.substr(0, last + 1);
    if (!std::all_of(text.begin(), text.end(), [](char c) { return c >= ' ' && c <= '~'; }))
      return std::nullopt;
    sentence.fields = text.substr(address);
    return sentence;
  }
  const char* const digits = text.data() + star + 1;
  sentence.fields = text.substr(address, star - address);
  sentence.found = checksum_of(text.substr(0, star));
  const auto [end, error] = std::from_chars(digits, digits + 2, sentence.expected, 16);
  sentence.checksum = error == std::errc() && end == digits + 2 && sentence.found == sentence.expected
                          ? NmeaChecksum::right
                          : NmeaChecksum::wrong;
  return sentence;
}

/// Days since 1970-01-01; empty for a day that does not exist.
std::optional<std::int64_t> days_since_1970(std::optional<int> year, std::optional<int> month,
                                            std::optional<int> day) {
  if (!year || !month || !day || *month > 12 || *day > 31) return std::nullopt;
  const std::chrono::year_month_day date{std::chrono::year{*year},
                                         std::chrono::month{static_cast<unsigned>(*month)},
                                         std::chrono::day{static_cast<unsigned>(*day)}};
  if (!date.ok()) return std::nullopt;
  return std::chrono::sys_days{date}.time_since_epoch().count();
}

[[noreturn]] void fail(std::string_view field, std::string_view expected) {
  throw BadNmeaField{field, fmt::format("expected {}, got {}", expected, quote_field(field))};
}

}  // namespace

std::optional<NmeaSentence> next_nmea_sentence(std::string_view& rest) {
  while (true) {
    const std::size_t start = rest.find('$');
    if (start == std::string_view::npos) {
      rest = {};
      return std::nullopt;
    }
    rest.remove_prefix(start + 1);
    const std::size_t end = std::min(rest.find('$'), rest.size());
    const std::string_view text = rest.substr(0, end);
    rest.remove_prefix(end);
    if (const std::optional<NmeaSentence> sentence = sentence_of(text)) return sentence;
  }
}

NmeaFields::NmeaFields(std::string_view fields) {
  // `fields` begins with the comma after the address.
  while (!fields.empty() && count_ < kMost) {
    fields.remove_prefix(1);
    const std::size_t end = std::min(fields.find(','), fields.size());
    fields_[count_++] = fields.substr(0, end);
    fields.remove_prefix(end);
  }
}

std::optional<double> NmeaFields::number(std::size_t index, const char* name) const {
  const std::string_view field = (*this)[index];
  if (field.empty()) return std::nullopt;
  const char* const end = field.data() + field.size();
  const Decimal plain = read_plain_decimal(field.data(), end);
  if (plain.end == end) return plain.value;
  double value = 0;  // it has more digits than the fast function supports
  const auto [place, error] = std::from_chars(field.data(), end, value, std::chars_format::fixed);
  if (error != std::errc() || place != end || !std::isfinite(value))
    fail(field, std::string("a number for the ") + name);
  return value;
}

std::optional<std::int64_t> NmeaFields::time_of_day(std::size_t index) const {
  const std::string_view field = (*this)[index];
  if (field.empty()) return std::nullopt;
  const std::optional<int> whole = field_count(field.substr(0, 6));
  const bool pointed = field.size() > 6 && field[6] == '.';
  if (!whole || field.size() < 6 || (field.size() > 6 && !pointed)) fail(field, "a time hhmmss");
  const int hour = *whole / 10'000;
  const int minute = *whole / 100 % 100;
  const int second = *whole % 100;
  if (hour > 23 || minute > 59 || second > 60) fail(field, "a time of day hhmmss");
  std::int64_t nanoseconds = 0;
  std::int64_t unit = 100'000'000;
  for (std::size_t k = 7; k < field.size(); ++k, unit /= 10) {
    if (!is_digit(field[k])) fail(field, "a time hhmmss.sss");
    nanoseconds += unit * (field[k] - '0');
  }
  return (3600LL * hour + 60LL * minute + second) * 1'000'000'000 + nanoseconds;
}

std::optional<std::int64_t> NmeaFields::short_date(std::size_t index) const {
  const std::string_view field = (*this)[index];
  if (field.empty()) return std::nullopt;
  const std::optional<int> number = field.size() == 6 ? field_count(field) : std::nullopt;
  if (!number) fail(field, "a date ddmmyy");
  const int year = *number % 100;
  const std::optional<std::int64_t> days =
      days_since_1970(year < 80 ? 2000 + year : 1900 + year, *number / 100 % 100, *number / 10'000);
  if (!days) fail(field, "a date ddmmyy that exists");
  return days;
}

std::optional<std::int64_t> NmeaFields::long_date(std::size_t index) const {
  if ((*this)[index].empty() || (*this)[index + 1].empty() || (*this)[index + 2].empty()) return std::nullopt;
  const std::optional<int> year = field_count((*this)[index + 2]);
  if (!year || *year < 1980 || *year > 2200) fail((*this)[index + 2], "a year from 1980 to 2200");
  const std::optional<std::int64_t> days =
      days_since_1970(year, field_count((*this)[index + 1]), field_count((*this)[index]));
  if (!days) fail((*this)[index], "a day and a month that exist");
  return days;
}

std::optional<double> NmeaFields::angle(std::size_t index, bool is_latitude) const {
  const char* const name = is_latitude ? "latitude" : "longitude";
  const std::optional<double> value = number(index, name);
  if (!value) return std::nullopt;
  const double degrees = std::floor(*value / 100);
  const double minutes = *value - 100 * degrees;
  const double angle = degrees + minutes / 60;
  const double limit = is_latitude ? 90 : 180;
  // The comparisons fail for NaN.
  if (!(*value >= 0 && minutes < 60 && angle <= limit))
    fail((*this)[index],
         fmt::format("a {} from 0 to {} degrees as {}mm.mmm", name, limit, is_latitude ? "dd" : "ddd"));
  const std::string_view hemisphere = (*this)[index + 1];
  const std::string_view letters = is_latitude ? "NS" : "EW";
  if (hemisphere.size() != 1 || letters.find(hemisphere[0]) == std::string_view::npos)
    fail(hemisphere, is_latitude ? "N or S after the latitude" : "E or W after the longitude");
  return hemisphere[0] == letters[1] ? -angle : angle;
}

}  // namespace waymark::formats
