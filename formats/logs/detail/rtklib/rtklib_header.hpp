/// The header of an RTKLIB solution: what its columns hold.
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>

#include <waymark/core/drive/stamp.hpp>
#include <waymark/formats/logs/detail/common/geocentric.hpp>

namespace waymark::formats {

/// What the columns after the time hold.
enum class RtklibLayout {
  degrees,      ///< latitude(deg) longitude(deg) height(m)
  sexagesimal,  ///< latitude(d'") longitude(d'") height(m): degrees, minutes and seconds in fields of their
                ///< own
  ecef,         ///< x-ecef(m) y-ecef(m) z-ecef(m)
  baseline      ///< e-baseline(m) n-baseline(m) u-baseline(m) from `% ref pos`
};

/// What the `%` lines have said so far. Places are 0-based fields of a record whose time takes two.
struct RtklibHeader {
  RtklibLayout layout = RtklibLayout::degrees;
  TimeScale scale = TimeScale::gps;
  int hours_ahead = 0;         ///< of `scale`: 9 for JST
  bool names_columns = false;  ///< whether a line named the columns; else RTKLIB's default order is assumed
  bool above_geoid = false;    ///< height=WGS84/geodetic
  std::size_t fields = 0;      ///< of a record; 0: not known
  std::size_t quality = 5;     ///< place of Q
  std::size_t sigma = 7;       ///< place of the first of six standard deviations; 0: there are none
  std::size_t velocity = 0;    ///< place of the first of three velocities and six deviations; 0: none
  std::optional<GeodeticPlace> reference;

  /// Takes a line that begins with '%'. @return whether it names the columns
  bool take(std::string_view line);
};

}  // namespace waymark::formats
