#include <charconv>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <waymark/formats/trajectory/detail/map_places.hpp>

namespace waymark::formats {
namespace {

/// Returns a JSON string with its quotes. Bytes that are no UTF-8 are replaced, so that no text
/// makes the file unreadable.
std::string json_text(std::string_view text) {
  return nlohmann::json(std::string(text)).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

void append_number(std::string& out, double value) {
  char buffer[32];
  const auto result = std::to_chars(buffer, buffer + sizeof buffer, value);
  out.append(buffer, result.ptr);
}

void append_position(std::string& out, const MapPlace& place) {
  out += '[';
  append_number(out, place.longitude_deg);
  out += ',';
  append_number(out, place.latitude_deg);
  out += ']';
}

void append_line_string(std::string& out, std::span<const TrajectoryPoint> points, std::string_view name) {
  out += fmt::format(
      R"({{"type":"Feature","properties":{{"name":{},"kind":"fused","first_stamp_ns":{},"last_stamp_ns":{}}},)",
      json_text(name), points.front().stamp.nanoseconds, points.back().stamp.nanoseconds);
  out += R"("geometry":{"type":"LineString","coordinates":[)";
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (i > 0) out += ',';
    append_position(out, place_of("GeoJSON", points, i));
  }
  out += "]}}";
}

std::string_view marker_color(std::string_view status) {
  if (status == to_string(FixStatus::rejected)) return "#d62728";
  if (status == to_string(FixStatus::withheld)) return "#1f77b4";
  return {};
}

void append_fix(std::string& out, std::span<const FixPoint> fixes, std::size_t index) {
  const FixPoint& fix = fixes[index];
  out +=
      fmt::format(R"({{"type":"Feature","properties":{{"kind":"fix","stamp_ns":{},"status":{},"reason":{})",
                  fix.stamp.nanoseconds, json_text(fix.status), json_text(fix.reason));
  if (const std::string_view color = marker_color(fix.status); !color.empty())
    out += fmt::format(R"(,"marker-color":"{}")", color);
  out += R"(},"geometry":{"type":"Point","coordinates":)";
  append_position(out, place_of("GeoJSON", fixes, index));
  out += "}}";
}

}  // namespace

std::string trajectory_geojson(std::span<const TrajectoryPoint> points, std::span<const FixPoint> fixes,
                               std::string_view name) {
  std::string out = "{\"type\":\"FeatureCollection\",\"features\":[\n";
  bool first = true;
  if (points.size() > 1) {
    append_line_string(out, points, name);
    first = false;
  }
  for (std::size_t i = 0; i < fixes.size(); ++i) {
    if (!first) out += ",\n";
    first = false;
    append_fix(out, fixes, i);
  }
  out += "\n]}\n";
  return out;
}

}  // namespace waymark::formats
