#include <waymark/tools/drive/coordinates/frame_choice.hpp>

#include <cmath>
#include <cstdlib>

#include <waymark/core/base/error.hpp>
#include <waymark/tools/drive/coordinates/projection.hpp>
#include <waymark/tools/drive/sensors/place_columns.hpp>

namespace waymark::drive {
namespace {

/// Returns the first known place of a drive.
std::optional<GeodeticPoint> first_place(const DriveDescription& description, const DriveLogs& logs,
                                         std::span<const GeodeticFix> fixes) {
  if (!fixes.empty()) return GeodeticPoint{fixes.front().latitude_deg, fixes.front().longitude_deg};
  if (description.first_pose && description.first_pose->place) return description.first_pose->place;
  for (std::size_t i = 0; i < logs.sensors.size(); ++i) {
    if (!description.sensors[i].log) continue;
    if (const auto place =
            first_geodetic_place(description.sensors[i].log->request, logs.sensors[i].data.readings))
      return place;
    const std::vector<RoughPosition>& rough = logs.sensors[i].rough;
    if (!rough.empty()) return geodetic_from_ecef(rough[rough.size() / 2].ecef);
  }
  return std::nullopt;
}

}  // namespace

Frame frame_of(const DriveDescription& description, const DriveLogs& logs,
               std::span<const GeodeticFix> fixes) {
  if (const auto place = first_place(description, logs, fixes))
    return choose_frame(*place, description.utm_zone, description.utm_origin);
  if (!description.utm_zone) return {};
  const Eigen::Vector2d origin = description.utm_origin.value_or(Eigen::Vector2d::Zero());
  return {std::abs(*description.utm_zone), *description.utm_zone > 0, origin.x(), origin.y()};
}

std::optional<FirstPose> first_pose_in(const Frame& frame, const DriveDescription& description) {
  if (!description.first_pose) return std::nullopt;
  const StatedPose& stated = *description.first_pose;
  FirstPose pose{.position = stated.position_m,
                 .heading_rad = stated.heading_rad,
                 .sigma_m = stated.sigma_m,
                 .sigma_rad = stated.sigma_rad};
  if (frame.zone == 0) return pose;
  const Projection projection(frame);
  if (stated.place) pose.position = projection.to_grid(*stated.place).position;
  if (!pose.position || !pose.heading_rad) return pose;
  const GridPoint grid = projection.to_grid(projection.to_geodetic(*pose.position));
  pose.heading_rad = grid_heading_from_true(*pose.heading_rad, grid.convergence_rad);
  return pose;
}

}  // namespace waymark::drive
