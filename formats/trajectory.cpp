#include <waymark/formats/trajectory.hpp>

#include <charconv>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <waymark/core/error.hpp>
#include <waymark/formats/stamp_text.hpp>
#include <waymark/formats/text_builder.hpp>

namespace waymark {
namespace {

[[noreturn]] void throw_bad_point(std::string_view format, std::string_view what, std::size_t index,
                                  Stamp stamp, std::string_view problem) {
  throw OutputError(
      fmt::format("{}: {} {} at {} s: {}", format, what, index + 1, decimal_seconds(stamp), problem));
}

void append_number(std::string& out, double value) {
  char buffer[32];
  const auto result = std::to_chars(buffer, buffer + sizeof buffer, value);
  out.append(buffer, result.ptr);
}

void check_finite(std::string_view format, std::size_t index, const TrajectoryPoint& point) {
  if (!point.pose.allFinite()) throw_bad_point(format, "pose", index, point.stamp, "not finite");
}

/// A field as RFC 4180 wants it: quoted where it holds a separator, a quote or a line end.
void append_csv_text(std::string& out, std::string_view text) {
  if (text.find_first_of(",\"\r\n") == std::string_view::npos) {
    out += text;
    return;
  }
  out += '"';
  for (const char c : text) {
    if (c == '"') out += '"';
    out += c;
  }
  out += '"';
}

void append_csv_optional(std::string& out, const std::optional<double>& value) {
  out += ',';
  if (value && std::isfinite(*value)) append_number(out, *value);
}

void append_csv_point(std::string& out, const TrajectoryPoint& point) {
  out += std::to_string(point.stamp.nanoseconds);
  for (const double value : point.pose) {
    out += ',';
    append_number(out, value);
  }
  append_csv_optional(out, point.latitude_deg);
  append_csv_optional(out, point.longitude_deg);
  for (Eigen::Index axis = 0; axis < 3; ++axis)
    append_csv_optional(out, point.sigma ? std::optional<double>((*point.sigma)[axis]) : std::nullopt);
  out += ',';
  append_csv_text(out, point.status);
  out += ',';
  append_csv_text(out, point.reason);
  out += '\n';
}

/// A JSON string with its quotes; bytes that are no UTF-8 are replaced, a reason must not make the file
/// unreadable.
std::string json_text(std::string_view text) {
  return nlohmann::json(std::string(text)).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

void append_position(std::string& out, double longitude_deg, double latitude_deg) {
  out += '[';
  append_number(out, longitude_deg);
  out += ',';
  append_number(out, latitude_deg);
  out += ']';
}

void append_line_string(std::string& out, std::span<const TrajectoryPoint> points, std::string_view name) {
  out += fmt::format(
      R"({{"type":"Feature","properties":{{"name":{},"kind":"fused","first_stamp_ns":{},"last_stamp_ns":{}}},)",
      json_text(name), points.front().stamp.nanoseconds, points.back().stamp.nanoseconds);
  out += R"("geometry":{"type":"LineString","coordinates":[)";
  for (std::size_t i = 0; i < points.size(); ++i) {
    const TrajectoryPoint& point = points[i];
    if (!point.latitude_deg || !point.longitude_deg)
      throw_bad_point("GeoJSON", "pose", i, point.stamp, "no latitude and longitude");
    if (!std::isfinite(*point.latitude_deg) || !std::isfinite(*point.longitude_deg))
      throw_bad_point("GeoJSON", "pose", i, point.stamp, "latitude or longitude not finite");
    if (i > 0) out += ',';
    append_position(out, *point.longitude_deg, *point.latitude_deg);
  }
  out += "]}}";
}

std::string_view marker_color(std::string_view status) {
  if (status == to_string(FixStatus::rejected)) return "#d62728";
  if (status == to_string(FixStatus::withheld)) return "#1f77b4";
  return {};
}

void append_fix(std::string& out, std::size_t index, const FixPoint& fix) {
  if (!std::isfinite(fix.latitude_deg) || !std::isfinite(fix.longitude_deg))
    throw_bad_point("GeoJSON", "fix", index, fix.stamp, "latitude or longitude not finite");
  out +=
      fmt::format(R"({{"type":"Feature","properties":{{"kind":"fix","stamp_ns":{},"status":{},"reason":{})",
                  fix.stamp.nanoseconds, json_text(fix.status), json_text(fix.reason));
  if (const std::string_view color = marker_color(fix.status); !color.empty())
    out += fmt::format(R"(,"marker-color":"{}")", color);
  out += R"(},"geometry":{"type":"Point","coordinates":)";
  append_position(out, fix.longitude_deg, fix.latitude_deg);
  out += "}}";
}

}  // namespace

std::string trajectory_csv(std::span<const TrajectoryPoint> points) {
  std::string out =
      "stamp_ns,x_m,y_m,heading_rad,latitude_deg,longitude_deg,"
      "sigma_x_m,sigma_y_m,sigma_heading_rad,status,reason\n";
  for (std::size_t i = 0; i < points.size(); ++i) {
    check_finite("CSV", i, points[i]);
    append_csv_point(out, points[i]);
  }
  return out;
}

std::string trajectory_tum(std::span<const TrajectoryPoint> points) {
  return collect_text([points](const TextSink& sink) {
    TextBuilder out(sink);
    out.word("# t x y z qx qy qz qw").end_line();
    for (std::size_t i = 0; i < points.size(); ++i) {
      check_finite("TUM", i, points[i]);
      const Eigen::Vector3d& pose = points[i].pose;
      out.word(decimal_seconds(points[i].stamp)).number(pose.x()).number(pose.y()).number(0);
      out.number(0).number(0).number(std::sin(0.5 * pose.z())).number(std::cos(0.5 * pose.z())).end_line();
    }
    out.finish();
  });
}

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
    append_fix(out, i, fixes[i]);
  }
  out += "\n]}\n";
  return out;
}

}  // namespace waymark
