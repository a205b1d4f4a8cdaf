/// GPX tracks, versions 1.0 and 1.1.
#pragma once

#include <waymark/core/drive/log_reader.hpp>

namespace waymark::formats {

/// Reader "gpx": reads the streams gnss and truth from the points of tracks (`trkpt`). Points of
/// routes (`rtept`) and waypoints (`wpt`) do not record a drive, so they are only counted in a
/// note. Namespaces are ignored.
///
/// **Members**: lat, lon, `time` (ISO 8601, UTC), `ele` plus `geoidheight` if given, `hdop`, `fix`
/// (none: without a fix), `speed` (m/s) and `course` (degrees clockwise from north). The last two
/// may be children (1.0) or anywhere in extensions (1.1, e.g. Garmin's TrackPointExtension 2).
/// Telephones write negative ones for "unknown"; these are ignored.
///
/// **Accuracy**: GPX has none. It is HDOP times `request.range_error_m` if both are given, or else
/// `default_sigma_m`.
///
/// **Corrupt**: a point without lat, lon or time, a garbled number or date, a value out of range.
/// If the XML is not well-formed, the points before the error are used, and the error is a
/// corrupt record.
///
/// **Hostile documents**: a document type declaration, nesting deeper than 64, a tag above 1 MiB
/// and more than 1000 different unknown names end the reading like malformed XML. Text is cut after
/// 64 characters. Memory stays bounded.
///
/// @throws InputError for the odometry and sensor streams, a column map, companions, and a root
/// element other than `gpx`
class GpxReader final : public LogReader {
 public:
  [[nodiscard]] std::unique_ptr<LogDecoder> open(const std::string& path,
                                                 const LogRequest& request) const override;
  [[nodiscard]] Recognition recognise(std::string_view head) const override;
};

}  // namespace waymark::formats
