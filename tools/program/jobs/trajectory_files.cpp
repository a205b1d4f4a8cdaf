#include <waymark/tools/program/jobs/trajectory_files.hpp>

#include <algorithm>
#include <array>
#include <optional>
#include <span>

#include <waymark/core/base/error.hpp>
#include <waymark/formats/text/text_file.hpp>
#include <waymark/formats/trajectory/map_formats.hpp>
#include <waymark/formats/trajectory/ros_formats.hpp>
#include <waymark/formats/trajectory/trajectory.hpp>
#include <waymark/tools/drive/coordinates/projection.hpp>
#include <waymark/types_se2/stamped_pose.hpp>

namespace waymark::program {
namespace {

/// Returns the projection for maps; empty for a document whose frame is not known.
std::optional<drive::Projection> projection_of(const formats::GraphDocument& document) {
  if (!document.frame || document.frame->zone == 0) return std::nullopt;
  return std::optional<drive::Projection>(std::in_place, *document.frame);
}

std::vector<formats::FixPoint> fix_points(const formats::GraphDocument& document,
                                          const drive::Projection& projection) {
  std::vector<formats::FixPoint> points;
  for (const Fix& fix : document.fixes) {
    const GeodeticPoint place = projection.to_geodetic(fix.position);
    points.push_back({fix.stamp, place.latitude_deg, place.longitude_deg, std::string(to_string(fix.status)),
                      fix.reason, fix.source});
  }
  return points;
}

/// The known data of each vertex.
struct OfVertex {
  const Fix* fix = nullptr;
  const Eigen::MatrixXd* covariance = nullptr;
};

std::vector<OfVertex> known_of_vertices(const formats::GraphDocument& document) {
  std::vector<OfVertex> known(document.graph.vertex_count());
  for (const Fix& fix : document.fixes) {
    if (const auto v = document.graph.find(fix.vertex)) known[static_cast<std::size_t>(*v)].fix = &fix;
  }
  for (const formats::VertexCovariance& block : document.covariances)
    known[static_cast<std::size_t>(block.vertex)].covariance = &block.covariance;
  return known;
}

formats::TrajectoryPoint point_of(const StampedPose& pose, const OfVertex& known,
                                  const std::optional<drive::Projection>& projection, TimeScale scale) {
  formats::TrajectoryPoint point;
  point.stamp = pose.stamp;
  point.utc = formats::date_of(pose.stamp, scale);
  point.pose = pose.pose;
  if (projection) {
    const GeodeticPoint place = projection->to_geodetic(point.pose.head<2>());
    point.latitude_deg = place.latitude_deg;
    point.longitude_deg = place.longitude_deg;
  }
  if (known.covariance != nullptr) point.covariance = *known.covariance;
  if (known.fix != nullptr) {
    point.status = std::string(to_string(known.fix->status));
    point.reason = known.fix->reason;
  }
  return point;
}

std::vector<formats::TrajectoryPoint> points_of(const formats::GraphDocument& document,
                                                const std::optional<drive::Projection>& projection) {
  const std::vector<OfVertex> known = known_of_vertices(document);
  std::vector<formats::TrajectoryPoint> points;
  for (std::size_t v = 0; v < known.size(); ++v) {
    if (const auto pose = stamped_pose(document.graph, static_cast<VertexIndex>(v)))
      points.push_back(point_of(*pose, known[v], projection, document.time_scale));
  }
  return points;
}

/// The formats of a trajectory alone, by the ending of the file's name.
struct TrajectoryFormat {
  std::string_view ending;
  std::string (*text)(std::span<const formats::TrajectoryPoint>);
};
constexpr std::array kTrajectoryFormats{TrajectoryFormat{".bag", formats::trajectory_bag},
                                        TrajectoryFormat{".mcap", formats::trajectory_mcap},
                                        TrajectoryFormat{".tum", formats::trajectory_tum_unix},
                                        TrajectoryFormat{".kitti", formats::trajectory_kitti}};

const TrajectoryFormat* trajectory_format(const std::string& path) {
  const auto found =
      std::find_if(kTrajectoryFormats.begin(), kTrajectoryFormats.end(),
                   [&](const TrajectoryFormat& format) { return path.ends_with(format.ending); });
  return found == kTrajectoryFormats.end() ? nullptr : &*found;
}

}  // namespace

bool is_trajectory_file(const std::string& path) {
  return trajectory_format(path) != nullptr;
}

std::size_t write_trajectory_file(const formats::GraphDocument& document, const std::string& path) {
  std::vector<formats::TrajectoryPoint> points = points_of(document, projection_of(document));
  if (points.empty())
    throw InputError(path + ": the graph has no poses with stamps, so there is no trajectory to write");
  std::stable_sort(points.begin(), points.end(),
                   [](const auto& a, const auto& b) { return a.stamp < b.stamp; });
  formats::write_file_atomically(path, trajectory_format(path)->text(points));
  return points.size();
}

std::vector<std::string> write_trajectories(const formats::GraphDocument& document,
                                            const evaluation::ResultFolder& folder,
                                            const std::string& label) {
  const std::optional<drive::Projection> projection = projection_of(document);
  const std::vector<formats::TrajectoryPoint> points = points_of(document, projection);
  if (points.empty()) return {};
  std::vector<std::string> files;
  const auto write = [&](std::string_view form, const std::string& text) {
    files.push_back(folder.trajectory(label, form));
    formats::write_file_atomically(files.back(), text);
  };
  write("csv", formats::trajectory_csv(points));
  write("tum", formats::trajectory_tum(points));
  if (projection) {
    const std::vector<formats::FixPoint> fixes = fix_points(document, *projection);
    write("geojson", formats::trajectory_geojson(points, fixes, label));
    write("qml", formats::trajectory_qml());
    write("kml", formats::trajectory_kml(points, fixes, label, document.time_scale));
    write("gpx", formats::trajectory_gpx(points, fixes, label, document.time_scale));
  }
  return files;
}

}  // namespace waymark::program
