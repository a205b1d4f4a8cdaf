/// NMEA 0183 sentences: `$GPRMC,124022.00,A,...*3B`. What a line holds of them, and what their fields say.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace waymark::formats {

/// How a sentence stands with its checksum, the exclusive or of the characters between `$` and `*`.
enum class NmeaChecksum { right, wrong, none };

/// One sentence. The views point into its line.
struct NmeaSentence {
  std::string_view address;  ///< "GPRMC": talker and kind, or "P" and a maker's own
  std::string_view fields;   ///< what follows the address, up to the `*`
  NmeaChecksum checksum = NmeaChecksum::none;
  unsigned found = 0;     ///< checksum of the characters
  unsigned expected = 0;  ///< the one that the sentence states
};

/// Takes the next sentence off `rest`; what stands before its `$` is passed over. A `$` that no address of
/// three to eight capitals and digits and no comma follows is no sentence, and neither is one without a
/// checksum that holds anything but printable characters.
[[nodiscard]] std::optional<NmeaSentence> next_nmea_sentence(std::string_view& rest);

/// A field that does not hold what the sentence's definition says.
struct BadNmeaField {
  std::string_view field;  ///< points into the line
  std::string what;        ///< "expected a number for the speed, got 'x'"
};

/// The fields of a sentence, numbered as in the standard: 1 is the first after the address.
class NmeaFields {
 public:
  explicit NmeaFields(std::string_view fields);

  /// Empty beyond the last one.
  [[nodiscard]] std::string_view operator[](std::size_t index) const {
    return index < count_ ? fields_[index] : fields_[0];
  }
  /// The readers below give nothing for an empty field. @throws BadNmeaField for a wrong one. @param name
  /// for messages
  [[nodiscard]] std::optional<double> number(std::size_t index, const char* name) const;
  /// hhmmss[.sss] as nanoseconds since midnight, digits below a nanosecond dropped; second 60 is tolerated.
  [[nodiscard]] std::optional<std::int64_t> time_of_day(std::size_t index) const;
  /// Days since 1970-01-01 of ddmmyy; years 80 .. 99 are of the 20th century.
  [[nodiscard]] std::optional<std::int64_t> short_date(std::size_t index) const;
  /// Days since 1970-01-01 of the fields day, month and year (four digits, 1980 .. 2200) from `index` on.
  [[nodiscard]] std::optional<std::int64_t> long_date(std::size_t index) const;
  /// Degrees from [d]ddmm.mmm and its hemisphere in the next field.
  [[nodiscard]] std::optional<double> latitude(std::size_t index) const { return angle(index, true); }
  [[nodiscard]] std::optional<double> longitude(std::size_t index) const { return angle(index, false); }

 private:
  [[nodiscard]] std::optional<double> angle(std::size_t index, bool is_latitude) const;

  static constexpr std::size_t kMost = 24;  ///< of the sentences that are read GNS has most: 13
  std::array<std::string_view, kMost> fields_;
  std::size_t count_ = 1;  ///< number 0 stays empty
};

/// Days between 1970-01-01 and the last day that a date of a log may name, 2200-12-31.
inline constexpr std::int64_t kLastNmeaDay = 84'370;

}  // namespace waymark::formats
