/// The header of an RTKLIB solution. It defines the columns.
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>

#include <waymark/core/drive/stamp.hpp>
#include <waymark/formats/logs/detail/place/geocentric.hpp>

namespace waymark::formats {

/// The columns after the time.
enum class RtklibLayout {
  degrees,  ///< latitude(deg) longitude(deg) height(m)
  /// latitude(d'") longitude(d'") height(m): degrees, minutes and seconds are separate fields
  sexagesimal,
  ecef,     ///< x-ecef(m) y-ecef(m) z-ecef(m)
  baseline  ///< e-baseline(m) n-baseline(m) u-baseline(m), relative to `% ref pos`
};

/// The content of the `%` lines so far. Places are 0-based fields of a record whose time
/// takes two fields.
struct RtklibHeader {
  RtklibLayout layout = RtklibLayout::degrees;
  TimeScale scale = TimeScale::gps;
  int hours_ahead = 0;  ///< of `scale`: 9 for JST
  /// a line named the columns; false: RTKLIB's default order is assumed
  bool names_columns = false;
  bool above_geoid = false;  ///< height=WGS84/geodetic
  std::size_t fields = 0;    ///< fields of a record; 0: not known
  std::size_t quality = 5;   ///< place of Q
  std::size_t sigma = 7;     ///< place of the first of six standard deviations; 0: none
  std::size_t velocity = 0;  ///< place of the first of three velocities and six deviations; 0: none
  std::optional<GeodeticPlace> reference;

  /// Reads a line that begins with '%'. @return whether it names the columns
  bool take(std::string_view line);
};

}  // namespace waymark::formats
