/// The entries of a drive.yaml that state frames of positions in metres.
#pragma once

#include <optional>

#include <Eigen/Core>

#include <waymark/core/drive/log_reader.hpp>
#include <waymark/tools/drive/description/yaml_section.hpp>

namespace waymark::drive {

/// As stated: negative zones are in the south.
struct ZoneAndOrigin {
  std::optional<int> zone;
  std::optional<Eigen::Vector2d> origin;  ///< easting and northing of the zone, m
};

/// Reads `utm_zone` and `origin`.
[[nodiscard]] ZoneAndOrigin read_zone_and_origin(const YamlSection& frame);

/// Returns the frame; without an origin its metres are plain UTM coordinates. Empty without a zone.
[[nodiscard]] std::optional<Frame> frame_of(const ZoneAndOrigin& stated);

/// Reads the `frame` of one log: a zone with its origin, or `enu_origin`, latitude and longitude, with
/// `enu_height`. It takes the place of the drive's.
void read_log_frame(const YamlSection& log, LogRequest& request);

}  // namespace waymark::drive
