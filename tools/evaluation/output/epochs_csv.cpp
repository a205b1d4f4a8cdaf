#include <waymark/tools/evaluation/output/epochs_csv.hpp>

#include <numbers>

#include <waymark/formats/text/detail/csv_text.hpp>

namespace waymark::evaluation {
namespace {

constexpr std::string_view kHeader =
    "stamp_ns,time_s,status,reason,sigma_east_m,sigma_north_m,"
    "gnss_east_m,gnss_north_m,fused_east_m,fused_north_m,"
    "gnss_along_m,gnss_cross_m,fused_along_m,fused_cross_m,heading_error_deg,speed_mps,"
    "covariance_xx_m2,covariance_xy_m2,covariance_yy_m2,nees,nu,"
    "fix_minus_fused_east_m,fix_minus_fused_north_m,heading_sigma_deg,quality,satellites,hdop,"
    "raw_latitude_deg,raw_longitude_deg,fused_latitude_deg,fused_longitude_deg\n";

void append_vector(std::string& out, const std::optional<Eigen::Vector2d>& vector) {
  for (Eigen::Index axis = 0; axis < 2; ++axis)
    formats::append_csv_number(out, vector ? std::optional<double>((*vector)[axis]) : std::nullopt);
}

void append_track(std::string& out, const std::optional<Eigen::Vector2d>& offset,
                  const std::optional<double>& direction_rad) {
  std::optional<Eigen::Vector2d> along_cross;
  if (offset && direction_rad) {
    const TrackOffset track = track_offset(*offset, *direction_rad);
    along_cross = {track.along_m, track.cross_m};
  }
  append_vector(out, along_cross);
}

void append_covariance(std::string& out, const std::optional<Eigen::Matrix2d>& covariance) {
  for (const auto& [row, column] : {std::pair(0, 0), std::pair(0, 1), std::pair(1, 1)})
    formats::append_csv_number(out,
                               covariance ? std::optional<double>((*covariance)(row, column)) : std::nullopt);
}

void append_told(std::string& out, const FixDetails& told) {
  out += ',';
  if (told.quality != FixQuality::unknown) formats::append_csv_text(out, to_string(told.quality));
  formats::append_csv_number(out,
                             told.satellites >= 0 ? std::optional<double>(told.satellites) : std::nullopt);
  formats::append_csv_number(out, told.hdop > 0 ? std::optional(told.hdop) : std::nullopt);
}

void append_place(std::string& out, const std::optional<GeodeticPoint>& place) {
  append_vector(
      out, place ? std::optional(Eigen::Vector2d(place->latitude_deg, place->longitude_deg)) : std::nullopt);
}

void append_epoch(std::string& out, const EpochResult& epoch, Stamp first) {
  out += std::to_string(epoch.stamp.nanoseconds);
  // A quotient is the double nearest to the decimal, 1.9. A product with 1e-9 would be
  // 1.9000000000000001.
  formats::append_csv_number(out, static_cast<double>(epoch.stamp.nanoseconds - first.nanoseconds) / 1e9);
  out += ',';
  formats::append_csv_text(out, epoch.status ? to_string(*epoch.status) : "");
  out += ',';
  formats::append_csv_text(out, epoch.reason);
  append_vector(out, epoch.fix_sigma_m);
  append_vector(out, epoch.gnss_offset_m);
  append_vector(out, epoch.fused_offset_m);
  append_track(out, epoch.gnss_offset_m, epoch.direction_rad);
  append_track(out, epoch.fused_offset_m, epoch.direction_rad);
  const auto& turned = epoch.heading_error_rad;
  formats::append_csv_number(out, turned ? std::optional(*turned * 180 / std::numbers::pi) : std::nullopt);
  formats::append_csv_number(out, epoch.speed_mps);
  append_covariance(out, epoch.position_covariance);
  formats::append_csv_number(out, epoch.nees);
  formats::append_csv_number(out, epoch.nu);
  append_vector(out, epoch.fix_residual_m);
  const auto& sigma = epoch.heading_sigma_rad;
  formats::append_csv_number(out, sigma ? std::optional(*sigma * 180 / std::numbers::pi) : std::nullopt);
  append_told(out, epoch.told);
  append_place(out, epoch.raw_place);
  append_place(out, epoch.fused_place);
  out += '\n';
}

}  // namespace

std::string epochs_csv(std::span<const EpochResult> epochs) {
  std::string out(kHeader);
  for (const EpochResult& epoch : epochs) append_epoch(out, epoch, epochs.front().stamp);
  return out;
}

}  // namespace waymark::evaluation
