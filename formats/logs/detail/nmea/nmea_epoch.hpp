/// Combines the sentences of one NMEA epoch.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

#include <Eigen/Core>

#include <waymark/core/drive/sample.hpp>
#include <waymark/formats/logs/detail/nmea/nmea_sentence.hpp>

namespace waymark::formats {

/// The kinds of sentences that are read, of any talker.
enum class NmeaKind { other, rmc, gga, gns, gst, vtg, zda, gll, gsa };
/// @param address "GNRMC". Proprietary sentences ("P...") are `other`.
[[nodiscard]] NmeaKind nmea_kind(std::string_view address);

/// The accuracy from a GST sentence.
struct NmeaAccuracy {
  double north_m = 0;  ///< 1 sigma
  double east_m = 0;   ///< 1 sigma
  /// Correlation of the east and north errors, from the error ellipse; 0 if GST has none.
  double correlation = 0;
  bool has_ellipse = false;  ///< the correlation is given
  /// the ellipse was ignored, because its shape contradicts the sigmas
  bool ellipse_disagrees = false;
};

/// The sentences with one time of day. If a later sentence of the same kind repeats a field, it
/// replaces the field.
struct NmeaEpoch {
  std::optional<std::int64_t> time_of_day;  ///< UTC, ns since midnight
  std::optional<std::int64_t> day;          ///< days since 1970-01-01
  unsigned seen = 0;                        ///< bit (1 << kind) of every kind that came

  /// The position from the best sentence: GGA, then GNS, RMC, GLL.
  struct Position {
    double latitude_deg = 0;
    double longitude_deg = 0;
    NmeaKind kind = NmeaKind::other;  ///< other: none
    std::size_t decimals = 0;         ///< decimals of its minutes
    std::size_t line = 0;
  } position;
  std::optional<double> altitude_m;          ///< above mean sea level
  std::optional<double> geoid_separation_m;  ///< height of mean sea level above the ellipsoid
  std::optional<double> hdop;
  std::optional<double> satellites;  ///< used in the position
  std::optional<double> course_deg;  ///< clockwise from true north
  std::optional<double> speed_mps;
  std::optional<NmeaAccuracy> accuracy;
  std::optional<double> correction_age_s;  ///< GGA, GNS
  /// From the sentence that knows it best: GGA, then GNS, then the mode indicator of RMC or GLL.
  FixQuality quality = FixQuality::unknown;
  NmeaKind quality_from = NmeaKind::other;

  /// RMC or GLL status V, GGA quality 0, GNS mode N for all, mode indicator N
  bool without_fix = false;

  [[nodiscard]] bool has(NmeaKind kind) const { return (seen & (1U << static_cast<unsigned>(kind))) != 0; }
  /// Tells whether some sentence states a position, or states that there is none.
  [[nodiscard]] bool is_record() const {
    return has(NmeaKind::rmc) || has(NmeaKind::gga) || has(NmeaKind::gns) || has(NmeaKind::gll);
  }
};

/// Returns the time of day of a sentence. @throws BadNmeaField
[[nodiscard]] std::optional<std::int64_t> nmea_time(NmeaKind kind, const NmeaFields& fields);

/// Tells whether the epoch has a position from a sentence of this kind, and this sentence another one: that of
/// a second receiver, or of the next epoch if the times are cut off. @throws BadNmeaField
[[nodiscard]] bool places_elsewhere(NmeaKind kind, const NmeaFields& fields, const NmeaEpoch& epoch);

/// Adds a sentence of any kind but `other` to its epoch. A sentence with a bad field adds nothing.
/// @throws BadNmeaField
void add_to_epoch(NmeaKind kind, const NmeaFields& fields, std::size_t line, NmeaEpoch& epoch);

}  // namespace waymark::formats
