#include <iterator>

#include <fmt/format.h>

#include <waymark/formats/text/detail/xml_text.hpp>
#include <waymark/formats/trajectory/detail/map_places.hpp>

// GPX 1.1: https://www.topografix.com/GPX/1/1/ fixes the order of the elements.

namespace waymark::formats {
namespace {

/// Garmin's names of flags, which most programs draw.
std::string_view symbol(std::string_view status) {
  if (status == to_string(FixStatus::rejected)) return "Flag, Red";
  if (status == to_string(FixStatus::withheld)) return "Flag, Blue";
  return "Flag, Green";
}

}  // namespace

std::string trajectory_gpx(std::span<const TrajectoryPoint> points, std::span<const FixPoint> fixes,
                           std::string_view name, TimeScale scale) {
  const MapDates dates(points, fixes, scale);
  std::string out = fmt::format(
      R"(<?xml version="1.0" encoding="UTF-8"?>
<gpx version="1.1" creator="waymark" xmlns="http://www.topografix.com/GPX/1/1" xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance" xsi:schemaLocation="http://www.topografix.com/GPX/1/1 http://www.topografix.com/GPX/1/1/gpx.xsd">
<metadata><name>{0}</name></metadata>
)",
      xml_text(name));
  const auto end = std::back_inserter(out);
  const auto append_place = [&](std::string_view tag, const MapPlace& place, Stamp stamp) {
    fmt::format_to(end, R"(<{} lat="{:.9f}" lon="{:.9f}">)", tag, place.latitude_deg, place.longitude_deg);
    if (dates.known()) fmt::format_to(end, "<time>{}</time>", dates.text(stamp));
  };
  for (std::size_t i = 0; i < fixes.size(); ++i) {
    const FixPoint& fix = fixes[i];
    append_place("wpt", place_of("GPX", fixes, i), fix.stamp);
    fmt::format_to(end, "<name>fix {}</name><desc>{}</desc><sym>{}</sym><type>{}</type></wpt>\n", i + 1,
                   xml_text(verdict(fix)), symbol(fix.status), xml_text(fix.status));
  }
  if (!points.empty()) {
    fmt::format_to(end, "<trk><name>{}</name><trkseg>\n", xml_text(name));
    for (std::size_t i = 0; i < points.size(); ++i) {
      append_place("trkpt", place_of("GPX", points, i), points[i].stamp);
      out += "</trkpt>\n";
    }
    out += "</trkseg></trk>\n";
  }
  out += "</gpx>\n";
  return out;
}

}  // namespace waymark::formats
