/// GPX tracks, versions 1.0 and 1.1.
#pragma once

#include <waymark/core/drive/log_reader.hpp>

namespace waymark::formats {

/// Reader "gpx": streams gnss and truth from the points of tracks (`trkpt`). Points of routes (`rtept`) and
/// waypoints
/// (`wpt`) are no record of a drive: they are counted and noted. Namespaces are not looked at.
///
/// **Read**: lat, lon, `time` (ISO 8601, UTC), `ele` plus `geoidheight` where given, `hdop`, `fix` (none:
/// without a fix); `speed` (m/s) and `course` (degrees clockwise from north), as children (1.0) or anywhere
/// in extensions (1.1, e.g. Garmin's TrackPointExtension 2); negative ones, which telephones write for
/// "unknown", are none.
///
/// **Accuracy**: GPX has none: HDOP times `request.range_error_m` where both are given, else
/// `default_sigma_m`.
///
/// **Corrupt**: a point without lat, lon or time, a garbled number or date, a value out of range. Where the
/// XML is not well-formed the points before the place are used, and the place is a corrupt record.
///
/// **Hostile documents**: a document type declaration, nesting deeper than 64, a tag of more than 1 MiB and
/// more than 1000 different unknown names end the reading like malformed XML does; text is kept to 64
/// characters. Memory stays bounded.
///
/// @throws InputError for the odometry and sensor streams, a column map, companions; for another root element
/// than `gpx`
class GpxReader final : public LogReader {
 public:
  [[nodiscard]] std::unique_ptr<LogDecoder> open(const std::string& path,
                                                 const LogRequest& request) const override;
  [[nodiscard]] Recognition recognise(std::string_view head) const override;
};

}  // namespace waymark::formats
