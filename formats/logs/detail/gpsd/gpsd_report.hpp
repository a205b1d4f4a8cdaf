/// One JSON object of a gpsd log, of which only the members that are read are kept.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace waymark::formats {

/// The members that hold numbers.
enum class GpsdNumber {
  mode,
  status,
  lat,
  lon,
  alt_hae,
  alt,
  epx,
  epy,
  eph,
  track,
  epd,
  speed,
  eps,
  major,
  minor,
  orient,
  count
};

/// A line that is no JSON object.
struct BadGpsdLine {
  std::size_t column = 1;
  std::string what;
};

/// A member that does not hold what the protocol says.
struct BadGpsdMember {
  std::string what;
};

/// One object. Nested members (satellites, devices) are read over.
struct GpsdReport {
  struct Member {
    double value = 0;
    bool given = false;
    std::string not_a_number;  ///< what stands there instead
  };
  std::string kind;  ///< "class"
  std::string time;
  std::string device;
  std::string release;  ///< of VERSION
  std::array<Member, static_cast<std::size_t>(GpsdNumber::count)> numbers;

  [[nodiscard]] Member& at(GpsdNumber key) { return numbers[static_cast<std::size_t>(key)]; }
  /// Empty where it is not there, or null. @throws BadGpsdMember for anything but a number
  [[nodiscard]] std::optional<double> number(GpsdNumber key) const;
  /// Members that the later report of the same epoch has replace those that are here.
  void update(const GpsdReport& later);
};

/// The class that a line names first, as gpsd writes it: `{"class":"SKY",...`; empty where it does not.
[[nodiscard]] std::string_view gpsd_class(std::string_view line);

/// Reads one line. @throws BadGpsdLine
[[nodiscard]] GpsdReport read_gpsd_report(std::string_view line);

}  // namespace waymark::formats
