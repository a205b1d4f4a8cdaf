/// Solutions of RTKLIB: the `.pos` files of rnx2rtkp, RTKPOST and rtkrcv.
#pragma once

#include <waymark/core/drive/log_reader.hpp>

namespace waymark::formats {

/// Reader "rtklib_pos": reads the streams gnss and truth.
///
/// **Layout** comes from the header line with the column names. Positions are latitude, longitude
/// and height (degrees, or degrees, minutes and seconds), x/y/z-ecef, or e/n/u-baseline; the last
/// needs the reference position of the `% ref pos` line. Blanks, tabs, `,` or `;` separate fields.
/// The time is a date and a time of day, or a GPS week and its seconds. Without such a header line
/// RTKLIB's default is assumed (degrees, GPST), and the notes say so.
///
/// **Time** is GPST, UTC or JST, as the header states; it is converted to `request.time_scale`.
///
/// **Accuracy** is standard deviations (1 sigma, which `request.accuracy` overrides) and signed
/// roots of covariances, cov = r |r|. Their axes are north, east, up for latitude and longitude, x,
/// y, z for ECEF, and east, north, up for baselines. They are converted to the covariance in east
/// and north at the fix.
///
/// **Velocities**, if the solution has them, become speed and course with their sigmas.
///
/// **Height** is above the ellipsoid, or above the geoid if the header says "geodetic" (a
/// note says so).
///
/// **Not corrupt**: comments, and records with Q = 0 (no fix). **Corrupt**: another number of
/// fields than the header has, a garbled number or time, an impossible position, a covariance that
/// is not positive definite, no accuracy without a default sigma.
///
/// @throws InputError for the odometry stream, a column map, companions, and baselines without
/// a reference.
class RtklibPosReader final : public LogReader {
 public:
  [[nodiscard]] std::unique_ptr<LogDecoder> open(const std::string& path,
                                                 const LogRequest& request) const override;
  [[nodiscard]] Recognition recognise(std::string_view head) const override;
};

}  // namespace waymark::formats
