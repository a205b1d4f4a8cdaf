#include <waymark/formats/trajectory/trajectory.hpp>

#include <cmath>

#include <fmt/format.h>

#include <waymark/core/base/error.hpp>
#include <waymark/formats/text/detail/csv_text.hpp>
#include <waymark/formats/text/detail/text_builder.hpp>
#include <waymark/formats/text/iso8601.hpp>
#include <waymark/formats/text/stamp_text.hpp>

namespace waymark::formats {
namespace {

void check_finite(std::string_view format, std::size_t index, const TrajectoryPoint& point) {
  if (point.pose.allFinite()) return;
  throw OutputError(
      fmt::format("{}: pose {} at {} s: not finite", format, index + 1, decimal_seconds(point.stamp)));
}

void append_csv_point(std::string& out, const TrajectoryPoint& point) {
  out += std::to_string(point.stamp.nanoseconds);
  for (const double value : point.pose) append_csv_number(out, value);
  append_csv_number(out, point.latitude_deg);
  append_csv_number(out, point.longitude_deg);
  for (Eigen::Index axis = 0; axis < 3; ++axis)
    append_csv_number(
        out, point.covariance ? std::optional(std::sqrt((*point.covariance)(axis, axis))) : std::nullopt);
  out += ',';
  append_csv_text(out, point.status);
  out += ',';
  append_csv_text(out, point.reason);
  out += ',';
  if (point.utc) out += decimal_seconds(*point.utc);
  out += ',';
  if (point.utc) out += iso8601_from_stamp(*point.utc);
  out += '\n';
}

template <typename StampOf>
std::string tum_text(std::span<const TrajectoryPoint> points, StampOf stamp_of_point) {
  return collect_text([&](const TextSink& sink) {
    TextBuilder out(sink);
    out.word("# t x y z qx qy qz qw").end_line();
    for (std::size_t i = 0; i < points.size(); ++i) {
      check_finite("TUM", i, points[i]);
      const Eigen::Vector3d& pose = points[i].pose;
      out.word(decimal_seconds(stamp_of_point(points[i]))).number(pose.x()).number(pose.y()).number(0);
      out.number(0).number(0).number(std::sin(0.5 * pose.z())).number(std::cos(0.5 * pose.z())).end_line();
    }
    out.finish();
  });
}

}  // namespace

std::string trajectory_csv(std::span<const TrajectoryPoint> points) {
  std::string out =
      "stamp_ns,x_m,y_m,heading_rad,latitude_deg,longitude_deg,"
      "sigma_x_m,sigma_y_m,sigma_heading_rad,status,reason,unix_s,utc\n";
  for (std::size_t i = 0; i < points.size(); ++i) {
    check_finite("CSV", i, points[i]);
    append_csv_point(out, points[i]);
  }
  return out;
}

std::string trajectory_tum(std::span<const TrajectoryPoint> points) {
  return tum_text(points, [](const TrajectoryPoint& point) { return point.stamp; });
}

std::string trajectory_tum_unix(std::span<const TrajectoryPoint> points) {
  return tum_text(points, [](const TrajectoryPoint& point) { return point.utc.value_or(point.stamp); });
}

std::string trajectory_kitti(std::span<const TrajectoryPoint> points) {
  return collect_text([points](const TextSink& sink) {
    TextBuilder out(sink);
    for (std::size_t i = 0; i < points.size(); ++i) {
      check_finite("KITTI", i, points[i]);
      const Eigen::Vector3d& pose = points[i].pose;
      const double c = std::cos(pose.z());
      const double s = std::sin(pose.z());
      out.number(c).number(-s).number(0).number(pose.x());
      out.number(s).number(c).number(0).number(pose.y());
      out.number(0).number(0).number(1).number(0).end_line();
    }
    out.finish();
  });
}

}  // namespace waymark::formats
