#include <waymark/formats/logs/detail/rinex/rinex_fields.hpp>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>

#include <waymark/formats/logs/detail/common/gps_time.hpp>
#include <waymark/formats/logs/detail/common/record_fields.hpp>

namespace waymark::formats {

std::string_view rinex_field(std::string_view line, std::size_t begin, std::size_t width) {
  if (begin >= line.size()) return {};
  std::string_view field = line.substr(begin, width);
  const std::size_t first = field.find_first_not_of(' ');
  if (first == std::string_view::npos) return {};
  field.remove_prefix(first);
  return field.substr(0, field.find_last_not_of(' ') + 1);
}

std::string_view rinex_label(std::string_view line) {
  constexpr std::size_t kLabel = 60;
  return rinex_field(line, kLabel, 20);
}

std::optional<double> rinex_number(std::string_view line, std::size_t begin, std::size_t width) {
  const std::string_view field = rinex_field(line, begin, width);
  std::array<char, 32> text{};
  if (field.empty() || field.size() > text.size()) return std::nullopt;
  std::transform(field.begin(), field.end(), text.begin(),
                 [](char c) { return c == 'D' || c == 'd' ? 'E' : c; });
  return field_number({text.data(), field.size()});
}

std::optional<int> rinex_count(std::string_view line, std::size_t begin, std::size_t width) {
  return field_count(rinex_field(line, begin, width));
}

std::optional<Stamp> stamp_of(const RinexDate& date) {
  using namespace std::chrono;
  const int year = date.year >= 100 ? date.year : date.year + (date.year < 80 ? 2000 : 1900);
  const year_month_day day{std::chrono::year(year), month(static_cast<unsigned>(date.month)),
                           std::chrono::day(static_cast<unsigned>(date.day))};
  constexpr int kLastYear = 2200;
  if (year < 1980 || year > kLastYear || date.month < 1 || date.day < 1 || !day.ok()) return std::nullopt;
  if (date.hour < 0 || date.hour > 23 || date.minute < 0 || date.minute > 59) return std::nullopt;
  if (!(date.second >= 0 && date.second < 61)) return std::nullopt;
  const std::int64_t days = sys_days(day).time_since_epoch().count();
  const std::int64_t nanoseconds = days * kDayNanoseconds - kGpsEpochPosix +
                                   (date.hour * 60LL + date.minute) * 60 * kSecondNanoseconds +
                                   std::llround(date.second * 1e9);
  if (nanoseconds < 0) return std::nullopt;
  return Stamp{nanoseconds};
}

std::optional<satellites::SatelliteName> rinex_satellite(std::string_view field, char blank) {
  using satellites::System;
  if (field.size() < 3) return std::nullopt;
  const char letter = field[0] == ' ' ? blank : field[0];
  const std::optional<int> number = rinex_count(field, 1, 2);
  if (!number || *number == 0) return std::nullopt;
  switch (letter) {
    case 'G':
    case ' ':
    case 'M':
      return satellites::SatelliteName{System::gps, *number};
    case 'R':
      return satellites::SatelliteName{System::glonass, *number};
    case 'E':
      return satellites::SatelliteName{System::galileo, *number};
    case 'C':
      return satellites::SatelliteName{System::beidou, *number};
    case 'S':
      return satellites::SatelliteName{System::sbas, *number};
    default:
      return std::nullopt;
  }
}

std::optional<RinexVersion> rinex_version(std::string_view line) {
  if (rinex_label(line) != "RINEX VERSION / TYPE") return std::nullopt;
  const std::optional<double> version = rinex_number(line, 0, 9);
  if (!version || line.size() < 41) return std::nullopt;
  return RinexVersion{*version, line[20], line[40]};
}

}  // namespace waymark::formats
