/// Finds NMEA 0183 sentences in lines, `$GPRMC,124022.00,A,...*3B`, and reads their fields.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace waymark::formats {

/// State of the checksum of a sentence: the exclusive or of the characters between `$` and `*`.
enum class NmeaChecksum { right, wrong, none };

/// One sentence. The views point into its line.
struct NmeaSentence {
  std::string_view address;  ///< "GPRMC": talker and kind, or "P" and a proprietary name
  std::string_view fields;   ///< the text after the address, up to the `*`
  NmeaChecksum checksum = NmeaChecksum::none;
  unsigned found = 0;     ///< checksum of the characters
  unsigned expected = 0;  ///< the checksum that the sentence states
};

/// Takes the next sentence off `rest` and skips the text before its `$`. A `$` begins a sentence
/// only if an address of three to eight capitals and digits and a comma follow. Without a checksum
/// the sentence must consist of printable characters.
[[nodiscard]] std::optional<NmeaSentence> next_nmea_sentence(std::string_view& rest);

/// A field that violates the definition of its sentence.
struct BadNmeaField {
  std::string_view field;  ///< points into the line
  std::string what;        ///< "expected a number for the speed, got 'x'"
};

/// The fields of a sentence, numbered as in the standard: 1 is the first after the address.
class NmeaFields {
 public:
  explicit NmeaFields(std::string_view fields);

  /// Returns an empty field beyond the last one.
  [[nodiscard]] std::string_view operator[](std::size_t index) const {
    return index < count_ ? fields_[index] : fields_[0];
  }
  /// The functions below return nothing for an empty field. @throws BadNmeaField for a wrong one
  /// @param name for messages
  [[nodiscard]] std::optional<double> number(std::size_t index, const char* name) const;
  /// Reads hhmmss[.sss] as nanoseconds since midnight. Digits below a nanosecond are dropped;
  /// second 60 is accepted.
  [[nodiscard]] std::optional<std::int64_t> time_of_day(std::size_t index) const;
  /// Reads ddmmyy as days since 1970-01-01. Years 80 .. 99 are of the 20th century.
  [[nodiscard]] std::optional<std::int64_t> short_date(std::size_t index) const;
  /// Reads day, month and year (four digits, 1980 .. 2200) in three fields from `index` as days
  /// since 1970-01-01.
  [[nodiscard]] std::optional<std::int64_t> long_date(std::size_t index) const;
  /// Reads degrees from [d]ddmm.mmm, and the hemisphere from the next field.
  [[nodiscard]] std::optional<double> latitude(std::size_t index) const { return angle(index, true); }
  [[nodiscard]] std::optional<double> longitude(std::size_t index) const { return angle(index, false); }

 private:
  [[nodiscard]] std::optional<double> angle(std::size_t index, bool is_latitude) const;

  /// GNS has the most fields of the sentences that are read: 13
  static constexpr std::size_t kMost = 24;
  std::array<std::string_view, kMost> fields_;
  std::size_t count_ = 1;  ///< number 0 stays empty
};

/// Days from 1970-01-01 to the last day that a date of a log may name, 2200-12-31.
inline constexpr std::int64_t kLastNmeaDay = 84'370;

}  // namespace waymark::formats
