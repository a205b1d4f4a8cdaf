/// Solutions of RTKLIB: `.pos` files of rnx2rtkp, RTKPOST and rtkrcv.
#pragma once

#include <waymark/core/drive/log_reader.hpp>

namespace waymark::formats {

/// Reader "rtklib_pos": streams gnss and truth.
///
/// **Layout** is read from the header's line of column names: latitude, longitude and height (degrees, or
/// degrees, minutes and seconds), x/y/z-ecef, or e/n/u-baseline, which needs the reference position of the
/// `% ref pos` line. Fields are separated by blanks, tabs, `,` or `;`; the time is a date and a time of day,
/// or a GPS week and seconds of it. Without such a line RTKLIB's default is assumed: degrees, GPST; the notes
/// say so.
///
/// **Time**: GPST, UTC or JST, as the header says; converted to `request.time_scale`.
///
/// **Accuracy**: standard deviations (1 sigma, which `request.accuracy` overrides) and signed roots of
/// covariances, cov = r |r|; axes north, east, up for latitude and longitude, x, y, z for ECEF, east, north,
/// up for baselines. They come out as the covariance in east and north at the fix.
///
/// **Velocities**, where the solution has them, become speed and course with their sigmas.
///
/// **Height** is above the ellipsoid, or above the geoid where the header says "geodetic" (noted).
///
/// **Not corrupt**: comments, and records with Q = 0 (without a fix). **Corrupt**: another number of fields
/// than the header has, a garbled number or time, a position that is none, a covariance that is not positive
/// definite, no accuracy without a default sigma.
///
/// @throws InputError for the odometry stream, a column map, companions; for baselines without a reference.
class RtklibPosReader final : public LogReader {
 public:
  [[nodiscard]] std::unique_ptr<LogDecoder> open(const std::string& path,
                                                 const LogRequest& request) const override;
  [[nodiscard]] Recognition recognise(std::string_view head) const override;
};

}  // namespace waymark::formats
