/// One JSON object of a gpsd log. Only the members that the reader uses are kept.
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
  dgps_age,
  count
};

/// A line that is no JSON object.
struct BadGpsdLine {
  std::size_t column = 1;
  std::string what;
};

/// A member that violates the protocol.
struct BadGpsdMember {
  std::string what;
};

/// One object. Nested members (satellites, devices) are skipped.
struct GpsdReport {
  struct Member {
    double value = 0;
    bool given = false;
    std::string not_a_number;  ///< the text in its place
  };
  std::string kind;  ///< the member "class"
  std::string time;
  std::string device;
  std::string release;  ///< of VERSION
  std::array<Member, static_cast<std::size_t>(GpsdNumber::count)> numbers;

  [[nodiscard]] Member& at(GpsdNumber key) { return numbers[static_cast<std::size_t>(key)]; }
  /// Returns nothing if the member is missing or null. @throws BadGpsdMember if it is anything
  /// but a number
  [[nodiscard]] std::optional<double> number(GpsdNumber key) const;
  /// Replaces the members that the later report of the same epoch has.
  void update(const GpsdReport& later);
};

/// Returns the class at the beginning of a line, as gpsd writes it: `{"class":"SKY",...`. Empty if
/// the line begins otherwise.
[[nodiscard]] std::string_view gpsd_class(std::string_view line);

/// Reads one line. @throws BadGpsdLine
[[nodiscard]] GpsdReport read_gpsd_report(std::string_view line);

}  // namespace waymark::formats
